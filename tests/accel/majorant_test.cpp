#include <gtest/gtest.h>

#include "accel/majorant_grid.h"
#include "grid/sample.h"
#include "support/transfers.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::make_volume;
using test::mu_t_function;
using test::noise_volume;
using test::Size3;

constexpr int kHuge = 1 << 20;
constexpr int kCellSizes[] = {1, 2, 3, 4, 8, 16, kHuge};

float majorant_at(const MajorantView& view, Vec3f p_index) {
  std::int64_t at[3];
  for (int a = 0; a < 3; ++a)
    at[a] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(p_index[a] / view.cell_voxels)), 0,
                                     view.cells[a] - 1);
  return view.mu_maj[(at[2] * view.cells[1] + at[1]) * view.cells[0] + at[0]];
}

void expect_bounds(const GridView& grid, const Volume& volume, const TransferFunction& function,
                   const MajorantView& view, int draws) {
  Rng rng(41, 0, 0, 0);
  for (int n = 0; n < draws; ++n) {
    const Vec3f p = test::random_point(volume, rng);
    const float mu_t = classify_mu_t(function.view(), sample_trilinear(grid, p));
    ASSERT_LE(mu_t, majorant_at(view, p)) << "at " << p.x << " " << p.y << " " << p.z;
  }
}

/// Noise, blobs and flat parts with a hard edge: what scanners give.
template <class T>
Volume mixed_volume(Size3 size, double lower, double upper) {
  Rng rng(42, 0, 0, 0);
  return make_volume<T>(size, [&](auto i, auto j, auto k) {
    const double wave = 0.5 + 0.5 * std::sin(0.7 * i + std::cos(0.3 * j)) * std::cos(0.5 * k);
    const double share = i < size[0] / 3 ? 0.2 : j < size[1] / 3 ? wave : static_cast<double>(rng.next());
    return lower + (upper - lower) * share;
  });
}

template <class T>
class Majorant : public testing::Test {};
using VoxelTypes = testing::Types<std::uint8_t, std::int16_t, std::uint16_t, std::uint32_t, float, double>;
TYPED_TEST_SUITE(Majorant, VoxelTypes);

TYPED_TEST(Majorant, BoundsEveryPoint) {
  const double lower = std::is_signed_v<TypeParam> ? -1000 : 0, upper = sizeof(TypeParam) > 1 ? 3000 : 255;
  const Volume volume = mixed_volume<TypeParam>({33, 26, 21}, lower, upper);
  const GridView grid = make_grid_view(volume);
  Rng rng(43, 0, 0, 0);
  for (const int cell_voxels : kCellSizes) {
    MajorantGrid majorants(grid, cell_voxels);
    for (const int segments : {3, 40}) {
      const TransferFunction function(mu_t_function(test::random_curve(lower, upper, 5, segments, rng)));
      majorants.update(function);
      expect_bounds(grid, volume, function, majorants.view(), cell_voxels == 4 ? 1000000 : 50000);
    }
    CurvePoints drawn = test::random_curve(lower, upper, 0.99, 20, rng);
    for (auto& [value, opacity] : drawn) opacity = std::min(opacity, 1.0);  // its spikes go higher
    const TransferFunction opacities(test::opacity_function(drawn, 0.7));
    majorants.update(opacities);
    expect_bounds(grid, volume, opacities, majorants.view(), cell_voxels == 4 ? 1000000 : 50000);
  }
}

TYPED_TEST(Majorant, IsTheSupremumOverTheCellsVoxels) {
  const Volume volume = noise_volume<TypeParam>({14, 9, 7}, 10, 200, 44);
  const CurvePoints points{{0, 0}, {50, 1}, {90, 0.2}, {180, 3}, {256, 0}};
  for (const int c : kCellSizes) {
    MajorantGrid majorants(make_grid_view(volume), c);
    majorants.update(TransferFunction(mu_t_function(points)));
    const MajorantView view = majorants.view();
    std::size_t cell = 0;
    for (int k = 0; k < view.cells[2]; ++k)
      for (int j = 0; j < view.cells[1]; ++j)
        for (int i = 0; i < view.cells[0]; ++i, ++cell) {
          float lower = 1e30f, upper = -1e30f;
          for (std::int64_t z = std::int64_t{k} * c; z <= std::min<std::int64_t>((k + 1) * c, 6); ++z)
            for (std::int64_t y = std::int64_t{j} * c; y <= std::min<std::int64_t>((j + 1) * c, 8); ++y)
              for (std::int64_t x = std::int64_t{i} * c; x <= std::min<std::int64_t>((i + 1) * c, 13); ++x) {
                lower = std::min(lower, test::voxel_at<TypeParam>(volume, x, y, z));
                upper = std::max(upper, test::voxel_at<TypeParam>(volume, x, y, z));
              }
          const double supremum = test::curve_maximum(points, lower, upper);
          ASSERT_GE(view.mu_maj[cell], supremum);
          ASSERT_LE(view.mu_maj[cell], supremum * (1 + 1.5e-4));
        }
  }
}

float minimum_at(const MajorantView& view, Vec3f p_index) {
  MajorantView minima = view;
  minima.mu_maj = view.mu_min;
  return majorant_at(minima, p_index);
}

TYPED_TEST(Majorant, MinimaHoldEveryLookUpAndAreExact) {
  const double lower = std::is_signed_v<TypeParam> ? -1000 : 0, upper = sizeof(TypeParam) > 1 ? 3000 : 255;
  const Volume volume = mixed_volume<TypeParam>({33, 26, 21}, lower, upper);
  const GridView grid = make_grid_view(volume);
  Rng rng(45, 0, 0, 0);
  for (const int cell_voxels : kCellSizes) {
    CurvePoints points = test::random_curve(lower, upper, 5, 30, rng);
    for (auto& point : points) point.second += 0.1;
    const TransferFunction function(mu_t_function(points));
    MajorantGrid majorants(grid, cell_voxels, CellMinima::kKept);
    majorants.update(function);
    const MajorantView view = majorants.view();
    Rng place(46, 0, 0, 0);
    for (int n = 0; n < 100000; ++n) {
      const Vec3f p = test::random_point(volume, place);
      const float mu_t = classify_mu_t(function.view(), sample_trilinear(grid, p));
      ASSERT_GE(mu_t, minimum_at(view, p)) << "at " << p.x << " " << p.y << " " << p.z;
    }
    const ValueRangeGrid ranges = build_value_ranges(grid, cell_voxels);
    for (std::size_t i = 0; i < ranges.ranges.size(); ++i)
      ASSERT_NEAR(view.mu_min[i], test::curve_minimum(points, ranges.ranges[i].lower, ranges.ranges[i].upper),
                  1e-4);
  }
}

TEST(Majorants, MinimaAreZeroWhereVoxelsAreNaNOrOverflow) {
  const auto volume_with = [](float odd) {
    return make_volume<float>(
        {17, 5, 5}, [&](auto i, auto j, auto k) { return i == 6 && j == 2 && k == 2 ? odd : 1.0f; });
  };
  for (const float odd : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
                          -std::numeric_limits<float>::infinity(), 3e38f}) {
    const Volume volume = volume_with(odd);
    MajorantGrid majorants(make_grid_view(volume), 4, CellMinima::kKept);
    majorants.update(TransferFunction(mu_t_function({{0, 0.5}})));
    const MajorantView view = majorants.view();
    ASSERT_EQ(view.cells[0], 4);
    for (int cell = 0; cell < 4; ++cell) EXPECT_EQ(view.mu_min[cell], cell == 1 ? 0.0f : 0.5f) << odd;
  }
  MajorantGrid none(make_grid_view(volume_with(1)), 4);
  EXPECT_EQ(none.view().mu_min, nullptr);
}

TEST(Majorants, SeeASpikeBetweenTwoVoxelValues) {
  const Volume volume =
      make_volume<std::uint8_t>({9, 9, 9}, [](auto i, auto j, auto k) { return (i + j + k) % 2 * 100; });
  const TransferFunction function(mu_t_function({{49.9, 0}, {50, 7}, {50.1, 0}}));
  for (const int c : kCellSizes) {
    MajorantGrid majorants(make_grid_view(volume), c);
    majorants.update(function);
    const MajorantView view = majorants.view();
    for (int n = 0; n < view.cells[0] * view.cells[1] * view.cells[2]; ++n)
      EXPECT_FLOAT_EQ(view.mu_maj[n], 7 * 1.0001f);
  }
}

TEST(Majorants, UpdateEqualsBuildingAnew) {
  const Volume volume = noise_volume<std::int16_t>({30, 20, 25}, -1000, 2000, 45);
  const GridView grid = make_grid_view(volume);
  Rng rng(46, 0, 0, 0);
  MajorantGrid updated(grid, 4);
  for (int n = 0; n < 5; ++n) {
    const TransferFunction function(mu_t_function(test::random_curve(-1000, 2000, 5, 20, rng)));
    updated.update(function);
    MajorantGrid fresh(grid, 4);
    fresh.update(function);
    const std::ptrdiff_t count = updated.view().cells[0] * updated.view().cells[1] * updated.view().cells[2];
    EXPECT_TRUE(std::equal(fresh.view().mu_maj, fresh.view().mu_maj + count, updated.view().mu_maj));
  }
}

TEST(Majorants, NothingVisibleIsZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Volume volume = make_volume<float>({9, 5, 5}, [&](auto i, auto, auto) { return i < 5 ? nan : 3.0f; });
  MajorantGrid majorants(make_grid_view(volume), 4);
  majorants.update(TransferFunction(mu_t_function({{0, 1}})));
  ASSERT_EQ(majorants.view().cells[0], 2);
  EXPECT_EQ(majorants.view().mu_maj[0], 0.0f);  // NaN alone
  EXPECT_FLOAT_EQ(majorants.view().mu_maj[1], 1.0001f);
  majorants.update(TransferFunction(mu_t_function({{4, 0}, {5, 1}})));
  EXPECT_EQ(majorants.view().mu_maj[1], 0.0f);
}

TEST(Majorants, NonFiniteVoxelsKeepTheBound) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  Rng voxel_rng(47, 0, 0, 0);
  const Volume volume = make_volume<float>({17, 17, 17}, [&](auto, auto, auto) {
    const float u = voxel_rng.next();
    return u < 0.05f   ? inf
           : u < 0.1f  ? -inf
           : u < 0.15f ? nan
           : u < 0.2f  ? 3e38f
           : u < 0.25f ? -3e38f
                       : u * 100;
  });
  const GridView grid = make_grid_view(volume);
  Rng rng(48, 0, 0, 0);
  const TransferFunction function(mu_t_function(test::random_curve(-10, 110, 5, 20, rng)));
  for (const int c : {1, 4}) {
    MajorantGrid majorants(grid, c);
    majorants.update(function);
    expect_bounds(grid, volume, function, majorants.view(), 200000);
  }
}

TEST(Majorants, SizesAndDefaults) {
  const Volume volume = noise_volume<std::uint8_t>({33, 5, 1}, 49);
  const GridView grid = make_grid_view(volume);
  const MajorantGrid majorants(grid, 8);
  EXPECT_EQ(majorants.view().cells[0], 4);
  EXPECT_EQ(majorants.view().cells[1], 1);
  EXPECT_EQ(majorants.view().cells[2], 1);
  EXPECT_EQ(default_macrocell_voxels(grid), 4);
  GridView large = grid;
  large.size[0] = large.size[1] = 2048;
  large.size[2] = 2048;
  EXPECT_EQ(default_macrocell_voxels(large), 8);
}

}  // namespace
}  // namespace voxlume
