#include "accel/hierarchy.h"

#include <gtest/gtest.h>

#include "accel/majorant_grid.h"
#include "hierarchy_words.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::each_cell;
using test::expect_bounds;
using test::level_of;
using test::majorant_of;
using test::make_volume;
using test::mixed_volume;
using test::mu_t_function;
using test::word_at;

/// The block of `level` around a cell, cut to the grid.
struct BlockCells {
  std::int32_t lower[3], upper[3];
  BlockCells(const HierarchyView& view, int level, std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::int32_t at[3] = {i, j, k};
    for (int a = 0; a < 3; ++a) {
      lower[a] = at[a] >> level << level;
      upper[a] = std::min(lower[a] + (1 << level), view.count[a]);
    }
  }
  template <class Visit>
  void each(Visit&& visit) const {
    for (std::int32_t k = lower[2]; k < upper[2]; ++k)
      for (std::int32_t j = lower[1]; j < upper[1]; ++j)
        for (std::int32_t i = lower[0]; i < upper[0]; ++i) visit(i, j, k);
  }
};

/// The majorants of single cells, and so of every block, from the uniform grid.
struct FinestMajorants {
  FinestMajorants(const GridView& grid, int cell_voxels, const TransferFunction& function)
      : majorants(grid, cell_voxels) {
    majorants.update(function);
    view = majorants.view();
  }
  float at(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return view.mu_maj[(std::int64_t{k} * view.cells[1] + j) * view.cells[0] + i];
  }
  MajorantGrid majorants;
  MajorantView view;
};

void expect_consistent(const HierarchyView& view, const FinestMajorants& finest, int max_level) {
  each_cell(view, [&](std::int32_t i, std::int32_t j, std::int32_t k) {
    const std::uint32_t word = word_at(view, i, j, k);
    ASSERT_LE(level_of(word), max_level);
    const BlockCells block(view, level_of(word), i, j, k);
    if (i != block.lower[0] || j != block.lower[1] || k != block.lower[2]) return;
    float greatest = 0;
    block.each([&](std::int32_t x, std::int32_t y, std::int32_t z) {
      ASSERT_EQ(word_at(view, x, y, z), word) << "cells of one block differ";
      greatest = std::max(greatest, finest.at(x, y, z));
    });
    ASSERT_EQ(word, make_word(greatest, level_of(word)));
    ASSERT_GE(majorant_of(word), greatest);
    ASSERT_LE(majorant_of(word), greatest * (1 + 1e-6f));
  });
  const auto clamped = [&](std::int32_t x, int a) { return std::clamp(x, 0, view.count[a] - 1); };
  for (std::int32_t k = -1; k <= view.count[2]; ++k)
    for (std::int32_t j = -1; j <= view.count[1]; ++j)
      for (std::int32_t i = -1; i <= view.count[0]; ++i) {
        const std::uint32_t inside = word_at(view, clamped(i, 0), clamped(j, 1), clamped(k, 2));
        if (clamped(i, 0) == i && clamped(j, 1) == j && clamped(k, 2) == k) continue;
        ASSERT_EQ(word_at(view, i, j, k), inside & ~kLevelMask) << "of the ring";
      }
}

template <class T>
class Hierarchy : public testing::Test {};
using VoxelTypes = testing::Types<std::uint8_t, std::int16_t, std::uint16_t, std::uint32_t, float, double>;
TYPED_TEST_SUITE(Hierarchy, VoxelTypes);

TYPED_TEST(Hierarchy, BoundsEveryPointAtEveryLevel) {
  const double lower = std::is_signed_v<TypeParam> ? -1000 : 0, upper = sizeof(TypeParam) > 1 ? 3000 : 255;
  const Volume volume = mixed_volume<TypeParam>({75, 66, 70}, lower, upper);
  const GridView grid = make_grid_view(volume);
  Rng rng(63, 0, 0, 0);
  for (const int cell_voxels : {1, 2, 3}) {
    MajorantHierarchy hierarchy(grid, cell_voxels);
    for (const int segments : {3, 40}) {
      CurvePoints curve = test::random_curve(lower, upper, 5, segments, rng);
      curve.front().second = 0;
      const TransferFunction function(mu_t_function(curve));
      hierarchy.update(function);
      expect_bounds(volume, function, hierarchy.view(), 200000);
      expect_consistent(hierarchy.view(), FinestMajorants(grid, cell_voxels, function), 6);
    }
  }
}

TEST(Hierarchies, HaveBlocksOfEveryLevel) {
  const Volume volume = mixed_volume<std::int16_t>({200, 130, 70}, 0, 1000);
  MajorantHierarchy hierarchy(make_grid_view(volume), 1);
  hierarchy.update(TransferFunction(mu_t_function({{100, 0}, {1000, 3}})));
  std::array<int, 8> count{};
  each_cell(hierarchy.view(),
            [&](auto i, auto j, auto k) { ++count[level_of(word_at(hierarchy.view(), i, j, k))]; });
  for (int level = 0; level <= 6; ++level) EXPECT_GT(count[level], 0) << "level " << level;
  EXPECT_EQ(count[7], 0);
}

TEST(Hierarchies, AnyCostsKeepThemConsistent) {
  const Volume volume = mixed_volume<std::int16_t>({33, 26, 41}, 0, 1000);
  const GridView grid = make_grid_view(volume);
  const TransferFunction function(mu_t_function({{100, 0}, {1000, 3}}));
  const FinestMajorants finest(grid, 1, function);
  for (const float lookup : {0.0f, 0.1f, 1.0f, 10.0f, 1000.0f, 1e30f})
    for (int max_level = 0; max_level <= 6; ++max_level) {
      MajorantHierarchy hierarchy(grid, 1, {lookup, max_level});
      hierarchy.update(function);
      expect_consistent(hierarchy.view(), finest, max_level);
    }
}

TEST(Hierarchies, CostsDecide) {
  const Volume volume = mixed_volume<std::int16_t>({64, 64, 64}, 0, 1000);
  const GridView grid = make_grid_view(volume);
  const TransferFunction function(mu_t_function({{-1, 3}, {100, 1}, {1000, 3}}));
  MajorantHierarchy free_lookups(grid, 1, {0, 6}), dear_lookups(grid, 1, {1e6f, 6});
  free_lookups.update(function);
  dear_lookups.update(function);
  const FinestMajorants finest(grid, 1, function);
  each_cell(free_lookups.view(), [&](auto i, auto j, auto k) {
    ASSERT_EQ(level_of(word_at(free_lookups.view(), i, j, k)), 6);
    // Dear look-ups join nothing but cells of (nearly) one majorant.
    const std::uint32_t word = word_at(dear_lookups.view(), i, j, k);
    ASSERT_NEAR(majorant_of(word), finest.at(i, j, k), 1e-5);
  });
}

/// The join rule worked out anew, top-down and in double precision.
class ReferenceJoin {
 public:
  ReferenceJoin(const HierarchyView& view, const FinestMajorants& finest, double lookup_cost, double chord_mm)
      : view_(view), finest_(finest), lookup_cost_(lookup_cost), chord_mm_(chord_mm) {}

  struct Result {
    double mu_maj, cost;
    bool joined;
    double margin;  ///< how far from a tie, relative
  };
  Result block(int level, std::int32_t i, std::int32_t j, std::int32_t k) const {
    const auto whole = [&](double mu_maj) {
      return 1 + lookup_cost_ * mu_maj * chord_mm_ * static_cast<double>(1 << level);
    };
    if (level == 0) {
      const bool inside = i < view_.count[0] && j < view_.count[1] && k < view_.count[2];
      const double mu_maj = inside ? static_cast<double>(finest_.at(i, j, k)) : 0;
      return {mu_maj, whole(mu_maj), true, 1};
    }
    double mu_maj = 0, parts = 0;
    for (int p = 0; p < 8; ++p) {
      const Result part = block(level - 1, 2 * i + (p & 1), 2 * j + (p >> 1 & 1), 2 * k + (p >> 2));
      mu_maj = std::max(mu_maj, part.mu_maj);
      parts += part.cost / 4;
    }
    const bool joined = whole(mu_maj) <= parts;
    return {mu_maj, joined ? whole(mu_maj) : parts, joined, std::abs(whole(mu_maj) / parts - 1)};
  }
  /// The level of a cell's largest joined block, or -1 where a tie is too close to tell.
  int level_of_cell(int max_level, std::int32_t i, std::int32_t j, std::int32_t k) const {
    for (int level = max_level; level > 0; --level) {
      const Result result = block(level, i >> level, j >> level, k >> level);
      if (result.margin < 1e-5) return -1;
      if (result.joined) return level;
    }
    return 0;
  }

 private:
  const HierarchyView& view_;
  const FinestMajorants& finest_;
  double lookup_cost_, chord_mm_;
};

TEST(Hierarchies, BlocksAreJoinedWhereThatIsCheaper) {
  const Volume volume = mixed_volume<std::int16_t>({70, 20, 30}, 0, 1000);
  const GridView grid = make_grid_view(volume);
  const TransferFunction function(mu_t_function({{100, 0}, {400, 0.05}, {1000, 3}}));
  for (const float lookup : {0.5f, 2.5f, 8.0f}) {
    MajorantHierarchy hierarchy(grid, 1, {lookup, 6});
    hierarchy.update(function);
    const HierarchyView view = hierarchy.view();
    const FinestMajorants finest(grid, 1, function);
    const ReferenceJoin reference(view, finest, static_cast<double>(lookup), 2.0 / 3);
    Rng rng(64, 0, 0, 0);
    int told = 0;
    for (int n = 0; n < 150; ++n) {
      const auto i = static_cast<std::int32_t>(70 * rng.next() * 0.98f),
                 j = static_cast<std::int32_t>(19 * rng.next()),
                 k = static_cast<std::int32_t>(29 * rng.next());
      const int level = reference.level_of_cell(6, i, j, k);
      if (level < 0) continue;
      ++told;
      ASSERT_EQ(level_of(word_at(view, i, j, k)), level) << i << " " << j << " " << k << " at " << lookup;
    }
    EXPECT_GT(told, 100);
  }
}

TEST(Hierarchies, EmptyVolumesAreOneBlock) {
  const Volume volume = test::noise_volume<std::int16_t>({70, 33, 5}, 0, 100, 66);
  MajorantHierarchy hierarchy(make_grid_view(volume), 1);
  hierarchy.update(TransferFunction(mu_t_function({{200, 0}, {300, 1}})));
  each_cell(hierarchy.view(),
            [&](auto i, auto j, auto k) { ASSERT_EQ(word_at(hierarchy.view(), i, j, k), 6u); });
}

TEST(Hierarchies, SeeASpikeBetweenTwoVoxelValues) {
  const Volume volume =
      make_volume<std::uint8_t>({9, 9, 9}, [](auto i, auto j, auto k) { return (i + j + k) % 2 * 100; });
  const TransferFunction function(mu_t_function({{49.9, 0}, {50, 7}, {50.1, 0}}));
  for (const int c : {1, 2, 5}) {
    MajorantHierarchy hierarchy(make_grid_view(volume), c);
    hierarchy.update(function);
    each_cell(hierarchy.view(), [&](auto i, auto j, auto k) {
      ASSERT_FLOAT_EQ(majorant_of(word_at(hierarchy.view(), i, j, k)), 7 * 1.0001f);
    });
  }
}

TEST(Hierarchies, NonFiniteVoxelsKeepTheBound) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Rng voxel_rng(67, 0, 0, 0);
  const Volume volume = make_volume<float>({17, 17, 17}, [&](auto i, auto, auto) {
    const float u = voxel_rng.next();
    return i < 5       ? nan
           : u < 0.05f ? inf
           : u < 0.1f  ? -inf
           : u < 0.15f ? nan
           : u < 0.2f  ? 3e38f
           : u < 0.25f ? -3e38f
                       : u * 100;
  });
  Rng rng(68, 0, 0, 0);
  for (const int c : {1, 4}) {
    MajorantHierarchy hierarchy(make_grid_view(volume), c);
    for (int n = 0; n < 3; ++n) {
      const TransferFunction function(mu_t_function(test::random_curve(-10, 110, 5, 20, rng)));
      hierarchy.update(function);
      expect_bounds(volume, function, hierarchy.view(), 100000);
      EXPECT_EQ(majorant_of(word_at(hierarchy.view(), 0, 0, 0)), 0.0f) << "NaN alone";
    }
  }
}

TEST(Words, AreTheNextMajorantAbove) {
  Rng rng(69, 0, 0, 0);
  for (int n = 0; n < 100000; ++n) {
    const float mu_maj = std::pow(10.0f, 40 * rng.next() - 35);
    const int level = n % 7;
    const std::uint32_t word = make_word(mu_maj, level);
    ASSERT_EQ(level_of(word), level);
    ASSERT_GE(majorant_of(word), mu_maj);
    ASSERT_LE(majorant_of(word), std::max(mu_maj * 1.000001f, 1e-36f));
  }
  EXPECT_EQ(make_word(0, 6), 6u);
}

TEST(Hierarchies, DefaultCells) {
  GridView grid;
  const auto cells = [&](std::int32_t edge) {
    for (std::int32_t& n : grid.size) n = edge;
    return default_hierarchy_voxels(grid);
  };
  EXPECT_EQ(cells(1), 2);
  EXPECT_EQ(cells(256), 2);
  EXPECT_EQ(cells(257), 4);
  EXPECT_EQ(cells(1024), 4);
  EXPECT_EQ(cells(1025), 8);
}

}  // namespace
}  // namespace voxlume
