// A new transfer function for a hierarchy that has had others.
#include <gtest/gtest.h>

#include "base/parallel.h"
#include "hierarchy_words.h"

namespace voxlume {
namespace {

using test::all_words;
using test::expect_bounds;
using test::make_volume;
using test::mixed_volume;
using test::mu_t_function;
using test::Size3;

/// Every cube of 8^3 voxels has a few values of its own.
Volume banded_volume(Size3 size) {
  return make_volume<std::int16_t>(size, [&](auto i, auto j, auto k) {
    const auto cube = static_cast<std::uint32_t>(i / 8 + 37 * (j / 8) + 1009 * (k / 8));
    return static_cast<double>(cube * 2654435761u % 997) + 3 * ((i + j + k) % 2);
  });
}

/// Moves one of a function's points, now and then something else.
TransferDescription edited(TransferDescription d, Rng& rng) {
  const auto at = static_cast<std::size_t>(rng.next() * d.points.size());
  const float kind = rng.next();
  if (kind < 0.1f) {
    d.density_scale *= 1.5;
  } else if (kind < 0.2f) {
    d.points[at].color = Color{{rng.next(), 0.5f, 0.5f}};
  } else if (kind < 0.3f) {
    d.density_scale = 0;
  } else if (kind < 0.4f) {
    d = mu_t_function(test::random_curve(0, 1000, 5, 9, rng));
  } else {
    d.points[at].mu_t_per_mm = kind < 0.6f ? 0.0 : 5.0 * static_cast<double>(rng.next());
    if (kind > 0.8f) d.points[at].mu_t_per_mm = 1e-3;
  }
  if (d.density_scale == 0 && rng.next() < 0.5f) d.density_scale = 1;
  return d;
}

TEST(HierarchyUpdate, OfAPartEqualsOneOfAll) {
  Rng rng(65, 0, 0, 0);
  struct Case {
    Volume volume;
    int cell_voxels;
    HierarchyCosts costs;
  };
  const auto mixed = [](Size3 size) { return mixed_volume<std::int16_t>(size, 0, 1000); };
  for (const Case& c :
       {Case{mixed({131, 70, 40}), 1, {2.5f, 6}}, Case{mixed({131, 70, 40}), 2, {2.5f, 6}},
        Case{mixed({66, 66, 66}), 1, {0.1f, 4}}, Case{mixed({40, 30, 20}), 1, {2.5f, 2}},
        Case{mixed({1, 1, 1}), 1, {2.5f, 6}}, Case{mixed({3, 5, 7}), 1, {2.5f, 6}},
        Case{mixed({90, 1, 20}), 1, {2.5f, 6}}, Case{banded_volume({131, 70, 40}), 1, {2.5f, 6}},
        Case{banded_volume({131, 70, 40}), 1, {0.3f, 6}}, Case{banded_volume({80, 80, 80}), 1, {0.05f, 6}},
        Case{banded_volume({80, 80, 80}), 2, {0.02f, 6}}}) {
    const GridView grid = make_grid_view(c.volume);
    MajorantHierarchy updated(grid, c.cell_voxels, c.costs);
    TransferDescription description =
        mu_t_function({{0, 0}, {200, 0}, {250, 1}, {350, 0}, {600, 0.01}, {1000, 3}});
    for (int n = 0; n < 40; ++n) {
      const TransferFunction function(description);
      updated.update(function);
      MajorantHierarchy fresh(grid, c.cell_voxels, c.costs);
      fresh.update(function);
      ASSERT_EQ(all_words(updated.view()), all_words(fresh.view())) << "after edit " << n;
      if (n % 5 == 0) expect_bounds(c.volume, function, updated.view(), 20000);
      description = edited(description, rng);
    }
  }
}

TEST(HierarchyUpdate, IsTheSameForAnyNumberOfThreads) {
  const Volume volume = mixed_volume<std::uint8_t>({131, 70, 80}, 0, 255);
  const TransferFunction function(mu_t_function({{20, 0}, {255, 3}}));
  std::vector<std::uint32_t> words[2];
  for (const int threads : {1, 4}) {
    const ThreadLimit limit(threads);
    MajorantHierarchy hierarchy(make_grid_view(volume), 1);
    hierarchy.update(function);
    words[threads > 1] = all_words(hierarchy.view());
  }
  EXPECT_EQ(words[0], words[1]);
}

}  // namespace
}  // namespace voxlume
