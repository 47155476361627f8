#include "visibility/important_blocks.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr std::int32_t kCellsASide = 4;
/// How far beyond a block what is important counts as near [voxels]: twice as far as points may be off.
constexpr std::int32_t kMargin = 1;

bool any_important(const ImportanceCellsView& cells, const std::int32_t (&first)[3],
                   const std::int32_t (&last)[3]) {
  for (std::int32_t k = first[2]; k <= last[2]; ++k)
    for (std::int32_t j = first[1]; j <= last[1]; ++j) {
      const std::uint8_t* row =
          cells.levels + std::int64_t{k} * cells.stride_k + std::int64_t{j} * cells.stride_j;
      for (std::int32_t i = first[0]; i <= last[0]; ++i)
        if (row[i] != 0) return true;
    }
  return false;
}

}  // namespace

ImportantBlocks::ImportantBlocks(const ImportanceCellsView& cells) : side_(kCellsASide << cells.shift) {
  for (int a = 0; a < 3; ++a) count_[a] = cells.last[a] / kCellsASide + 1;
  near_.resize(static_cast<std::size_t>(count_[0]) * static_cast<std::size_t>(count_[1]) *
               static_cast<std::size_t>(count_[2]));
  parallel_for(std::int64_t{count_[1]} * count_[2], 4, [&](std::int64_t row) {
    const std::int32_t at[3] = {0, static_cast<std::int32_t>(row % count_[1]),
                                static_cast<std::int32_t>(row / count_[1])};
    for (std::int32_t i = 0; i < count_[0]; ++i) {
      std::int32_t first[3], last[3];
      for (int a = 0; a < 3; ++a) {
        const std::int32_t begin = (a == 0 ? i : at[a]) * side_;
        first[a] = std::max(begin - kMargin, 0) >> cells.shift;
        last[a] = std::min((begin + side_ + kMargin) >> cells.shift, cells.last[a]);
      }
      near_[static_cast<std::size_t>(row * count_[0] + i)] = any_important(cells, first, last);
    }
  });
}

Interval<float> ImportantBlocks::part_of(Vec3f origin_index, Vec3f direction_index, float t_near,
                                         float t_far) const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::int32_t at[3], step[3];
  double next[3], every[3];
  for (int a = 0; a < 3; ++a) {
    const double o = origin_index[a], d = direction_index[a];
    at[a] = std::clamp(static_cast<std::int32_t>(std::floor((o + d * t_near) / side_)), 0, count_[a] - 1);
    step[a] = d < 0 ? -1 : 1;
    next[a] = d == 0 ? kInfinity : ((at[a] + (d > 0 ? 1 : 0)) * double(side_) - o) / d;
    every[a] = d == 0 ? kInfinity : side_ / std::abs(d);
  }
  double begin = kInfinity, end = -kInfinity;
  for (double t = t_near; t <= t_far;) {
    const int axis = next[0] < next[1] ? (next[0] < next[2] ? 0 : 2) : (next[1] < next[2] ? 1 : 2);
    if (near_[static_cast<std::size_t>((std::int64_t{at[2]} * count_[1] + at[1]) * count_[0] + at[0])]) {
      begin = std::min(begin, t);
      end = std::max(end, next[axis]);
    }
    t = std::max(t, next[axis]);
    next[axis] += every[axis];
    at[axis] += step[axis];
    // The outermost blocks reach to the end of the volume, and half a voxel before its first centre.
    if (at[axis] < 0 || at[axis] >= count_[axis]) {
      at[axis] -= step[axis];
      next[axis] = kInfinity;
      if (next[0] == kInfinity && next[1] == kInfinity && next[2] == kInfinity) {
        if (near_[static_cast<std::size_t>((std::int64_t{at[2]} * count_[1] + at[1]) * count_[0] + at[0])]) {
          begin = std::min(begin, t);
          end = t_far;
        }
        break;
      }
    }
  }
  if (!(begin <= end)) return {1, 0};
  // Rounding to float.
  const auto slack =
      static_cast<float>(1e-5 * (1 + std::abs(begin) + std::abs(std::min<double>(end, t_far))));
  return {static_cast<float>(begin) - slack, static_cast<float>(std::min<double>(end, t_far)) + slack};
}

}  // namespace voxlume
