#pragma once
#include <gtest/gtest.h>

#include <bit>

#include "accel/hierarchy.h"
#include "grid/sample.h"
#include "support/transfers.h"
#include "support/volumes.h"

namespace voxlume::test {

/// The words of a hierarchy, the ring around the grid included.
inline std::vector<std::uint32_t> all_words(const HierarchyView& view) {
  const std::uint32_t* first = view.words - view.stride_k - view.stride_j - 1;
  return {first, first + std::ptrdiff_t{view.stride_k} * (view.count[2] + 2)};
}

inline std::uint32_t word_at(const HierarchyView& view, std::int32_t i, std::int32_t j, std::int32_t k) {
  return view.words[std::ptrdiff_t{k} * view.stride_k + std::ptrdiff_t{j} * view.stride_j + i];
}

inline int level_of(std::uint32_t word) { return static_cast<int>(word & kLevelMask); }
inline float majorant_of(std::uint32_t word) { return std::bit_cast<float>(word & ~kLevelMask); }

template <class Visit>
void each_cell(const HierarchyView& view, Visit&& visit) {
  for (std::int32_t k = 0; k < view.count[2]; ++k)
    for (std::int32_t j = 0; j < view.count[1]; ++j)
      for (std::int32_t i = 0; i < view.count[0]; ++i) visit(i, j, k);
}

/// Empty space, flat regions, slopes and noise: what makes blocks of every level.
template <class T>
Volume mixed_volume(Size3 size, double lower, double upper) {
  Rng rng(61, 0, 0, 0);
  return make_volume<T>(size, [&](auto i, auto j, auto k) {
    const double x = static_cast<double>(i) / size[0], y = static_cast<double>(j) / size[1],
                 z = static_cast<double>(k) / size[2];
    const double noise = static_cast<double>(rng.next());
    const double share = x < 0.5           ? 0.05
                         : y < 0.3         ? 0.5 + 0.5 * std::sin(20 * z)
                         : z < 0.4         ? noise
                         : noise < 0.001   ? 1.0
                         : x + y + z < 2.0 ? 0.3
                                           : 0.7;
    return lower + (upper - lower) * share;
  });
}

/// No look-up of `draws` random points is above the majorant of its cell.
inline void expect_bounds(const Volume& volume, const TransferFunction& function, const HierarchyView& view,
                          int draws) {
  const GridView grid = make_grid_view(volume);
  Rng rng(62, 0, 0, 0);
  for (int n = 0; n < draws; ++n) {
    const Vec3f p = test::random_point(volume, rng);
    std::int32_t at[3];
    for (int a = 0; a < 3; ++a) at[a] = static_cast<std::int32_t>(std::floor(p[a] / view.cell_voxels));
    ASSERT_LE(classify_mu_t(function.view(), sample_trilinear(grid, p)),
              majorant_of(word_at(view, at[0], at[1], at[2])))
        << "at " << p.x << " " << p.y << " " << p.z;
  }
}

}  // namespace voxlume::test
