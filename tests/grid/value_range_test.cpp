#include "grid/value_range.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "grid/sample.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::noise_volume;
using test::Size3;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// The cell of a point, by the documented border rule.
std::size_t cell_of(const ValueRangeGrid& ranges, Vec3f p_index) {
  std::int64_t at[3];
  for (int a = 0; a < 3; ++a)
    at[a] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(p_index[a] / ranges.cell_voxels)),
                                     0, ranges.cells[a] - 1);
  return static_cast<std::size_t>((at[2] * ranges.cells[1] + at[1]) * ranges.cells[0] + at[0]);
}

template <class T>
class ValueRanges : public testing::Test {
 protected:
  void expect_hold(const Volume& volume, int cell_voxels, int draws) {
    const GridView grid = make_grid_view(volume);
    const ValueRangeGrid ranges = build_value_ranges(grid, cell_voxels);
    Rng rng(3, 0, 0, static_cast<std::uint32_t>(cell_voxels));
    for (int n = 0; n < draws; ++n) {
      Vec3f p = test::random_point(volume, rng);
      // At the last voxel y0 + (y1 - y0) may round to beyond y1.
      for (int a = 0; a < 3; ++a)
        if (n % 4 == 0 && (n >> (2 + a) & 1)) p[a] = static_cast<float>(volume.size[a] - 1);
      const ValueRange& range = ranges.ranges[cell_of(ranges, p)];
      const float v = sample_trilinear(grid, p);
      ASSERT_TRUE(range.lower <= v && v <= range.upper)
          << v << " at " << p.x << " " << p.y << " " << p.z << " not in [" << range.lower << ", "
          << range.upper << "]";
    }
  }

  void expect_tight(const Volume& volume, int cell_voxels) {
    const ValueRangeGrid ranges = build_value_ranges(make_grid_view(volume), cell_voxels);
    std::size_t cell = 0;
    for (int k = 0; k < ranges.cells[2]; ++k)
      for (int j = 0; j < ranges.cells[1]; ++j)
        for (int i = 0; i < ranges.cells[0]; ++i, ++cell) {
          const std::int64_t first[3] = {std::int64_t{i} * cell_voxels, std::int64_t{j} * cell_voxels,
                                         std::int64_t{k} * cell_voxels};
          float lower = 1e30f, upper = -1e30f;
          for (std::int64_t z = first[2]; z <= std::min(first[2] + cell_voxels, volume.size[2] - 1); ++z)
            for (std::int64_t y = first[1]; y <= std::min(first[1] + cell_voxels, volume.size[1] - 1); ++y)
              for (std::int64_t x = first[0]; x <= std::min(first[0] + cell_voxels, volume.size[0] - 1);
                   ++x) {
                lower = std::min(lower, test::voxel_at<T>(volume, x, y, z));
                upper = std::max(upper, test::voxel_at<T>(volume, x, y, z));
              }
          const double slack = 16 * 1.2e-7 * std::max(std::abs(lower), std::abs(upper));
          ASSERT_LE(ranges.ranges[cell].lower, lower);
          ASSERT_GE(ranges.ranges[cell].upper, upper);
          ASSERT_GE(ranges.ranges[cell].lower, lower - slack);
          ASSERT_LE(ranges.ranges[cell].upper, upper + slack);
        }
    EXPECT_EQ(cell, ranges.ranges.size());
  }
};
using VoxelTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                                  std::int32_t, float, double>;
TYPED_TEST_SUITE(ValueRanges, VoxelTypes);

TYPED_TEST(ValueRanges, HoldEveryInterpolatedValue) {
  this->expect_hold(noise_volume<TypeParam>({37, 22, 19}, 21), 4, 1000000);
  for (const int c : {1, 2, 3, 8, 16, 1000})
    this->expect_hold(noise_volume<TypeParam>({17, 12, 9}, 22), c, 50000);
  for (std::uint64_t seed = 0; seed < 100; ++seed)
    this->expect_hold(noise_volume<TypeParam>({2, 2, 2}, seed), 4, 100);
}

TYPED_TEST(ValueRanges, AreAttained) {
  for (const Size3& size : {Size3{17, 12, 9}, Size3{1, 1, 1}, Size3{5, 9, 1}, Size3{3, 5, 7}})
    for (const int c : {1, 2, 3, 4, 8, 1000}) this->expect_tight(noise_volume<TypeParam>(size, 23), c);
}

TEST(ValueRanges, CoverTheDomainWithCells) {
  const Volume volume = noise_volume<std::uint8_t>({9, 8, 1}, 24);
  const ValueRangeGrid ranges = build_value_ranges(make_grid_view(volume), 4);
  // Between 9, 8 and 1 voxel centres lie 8, 7 and 0 spacings.
  EXPECT_EQ(ranges.cells[0], 2);
  EXPECT_EQ(ranges.cells[1], 2);
  EXPECT_EQ(ranges.cells[2], 1);
  EXPECT_EQ(ranges.ranges.size(), 4u);
}

TEST(ValueRanges, HugeCellIsOneCell) {
  const Volume volume = noise_volume<std::int16_t>({9, 8, 7}, 25);
  const ValueRangeGrid ranges = build_value_ranges(make_grid_view(volume), std::numeric_limits<int>::max());
  EXPECT_EQ(ranges.ranges.size(), 1u);
}

TEST(ValueRanges, NaNIsNotCounted) {
  const Volume volume = test::make_volume<float>({9, 9, 9}, [](auto i, auto j, auto k) {
    return (i + j + k) % 3 == 0 ? kNaN : i < 5 ? -2.0f : 7.0f;
  });
  const ValueRangeGrid ranges = build_value_ranges(make_grid_view(volume), 4);
  ASSERT_EQ(ranges.ranges.size(), 8u);
  EXPECT_EQ(ranges.ranges[0].lower, -2.0f);
  EXPECT_EQ(ranges.ranges[0].upper, -2.0f);
  EXPECT_NEAR(ranges.ranges[1].lower, -2.0f, 1e-5);
  EXPECT_NEAR(ranges.ranges[1].upper, 7.0f, 1e-5);
}

TEST(ValueRanges, CellWithoutAValueIsEmpty) {
  const Volume volume = test::make_volume<double>({4, 4, 4}, [](auto, auto, auto) { return kNaN; });
  const ValueRangeGrid ranges = build_value_ranges(make_grid_view(volume), 4);
  ASSERT_EQ(ranges.ranges.size(), 1u);
  EXPECT_TRUE(ranges.ranges[0].empty());
}

TEST(ValueRanges, AreTheSameForAnyThreadCount) {
  const Volume volume = noise_volume<std::uint16_t>({40, 33, 29}, 26);
  const GridView grid = make_grid_view(volume);
  const auto build = [&](int threads) {
    const ThreadLimit limit(threads);
    return build_value_ranges(grid, 3);
  };
  const ValueRangeGrid one = build(1), five = build(5);
  ASSERT_EQ(one.ranges.size(), five.ranges.size());
  for (std::size_t i = 0; i < one.ranges.size(); ++i) {
    ASSERT_EQ(one.ranges[i].lower, five.ranges[i].lower);
    ASSERT_EQ(one.ranges[i].upper, five.ranges[i].upper);
  }
}

}  // namespace
}  // namespace voxlume
