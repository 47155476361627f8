#include "grid/sample.h"

#include <gtest/gtest.h>

#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::noise_volume;
using test::Size3;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
const Size3 kSizes[] = {{3, 5, 7}, {1, 1, 1}, {6, 5, 1}, {1, 4, 9}, {8, 1, 3}, {2, 2, 2}};

template <class T>
double largest_magnitude(const Volume& volume) {
  double largest = 0;
  for (std::int64_t n = 0; n < static_cast<std::int64_t>(volume.voxel_count()); ++n)
    largest = std::max(largest, std::abs(static_cast<double>(static_cast<const T*>(volume.voxels.get())[n])));
  return largest;
}

template <class T>
class Sample : public testing::Test {};
using VoxelTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                                  std::int32_t, float, double>;
TYPED_TEST_SUITE(Sample, VoxelTypes);

TYPED_TEST(Sample, TrilinearEqualsTheWeightedSum) {
  for (const Size3& size : kSizes) {
    const Volume volume = noise_volume<TypeParam>(size, 11);
    const GridView grid = make_grid_view(volume);
    // Three nested steps of y0 + f (y1 - y0), in each of which |y1 - y0| may be twice the largest value.
    const double rounding = 8 * largest_magnitude<TypeParam>(volume) * std::numeric_limits<float>::epsilon();
    Rng rng(5, 0, 0, 0);
    for (int n = 0; n < 20000; ++n) {
      Vec3f p = test::random_point(volume, rng);
      if (n % 4 == 0) p = p * 3.0f - Vec3f(2);  // far outside
      ASSERT_NEAR(sample_trilinear(grid, p), test::reference_trilinear<TypeParam>(volume, Vec3d(p)), rounding)
          << p.x << " " << p.y << " " << p.z;
    }
  }
}

TYPED_TEST(Sample, CentresGiveTheVoxel) {
  for (const Size3& size : kSizes) {
    const Volume volume = noise_volume<TypeParam>(size, 12);
    const GridView grid = make_grid_view(volume);
    // The last voxel is reached as the upper end of its pair, where y0 + (y1 - y0) may round.
    const double rounding = sizeof(TypeParam) <= 2 ? 0 : 8 * 1.2e-7 * largest_magnitude<TypeParam>(volume);
    for (std::int64_t k = 0; k < size[2]; ++k)
      for (std::int64_t j = 0; j < size[1]; ++j)
        for (std::int64_t i = 0; i < size[0]; ++i) {
          const Vec3f p(static_cast<float>(i), static_cast<float>(j), static_cast<float>(k));
          const float voxel = test::voxel_at<TypeParam>(volume, i, j, k);
          EXPECT_NEAR(sample_trilinear(grid, p), voxel, rounding);
          EXPECT_EQ(sample_nearest(grid, p), voxel);
        }
  }
}

TYPED_TEST(Sample, NearestInventsNothingAndRoundsRight) {
  for (const Size3& size : kSizes) {
    const Volume volume = noise_volume<TypeParam>(size, 13);
    const GridView grid = make_grid_view(volume);
    Rng rng(6, 0, 0, 0);
    for (int n = 0; n < 20000; ++n) {
      Vec3f p = test::random_point(volume, rng);
      if (n % 4 == 0) p = p * 3.0f - Vec3f(2);
      std::int64_t at[3];
      bool tie = false;
      for (int a = 0; a < 3; ++a) {
        const double up = static_cast<double>(p[a]) + 0.5;
        tie |= std::abs(up - std::round(up)) < 1e-6;
        at[a] = std::clamp<std::int64_t>(static_cast<std::int64_t>(std::floor(up)), 0, size[a] - 1);
      }
      if (tie) continue;
      ASSERT_EQ(sample_nearest(grid, p), test::voxel_at<TypeParam>(volume, at[0], at[1], at[2]))
          << p.x << " " << p.y << " " << p.z;
    }
  }
}

TEST(Sample, NearestAtTiesAndBorders) {
  const Volume volume = make_volume<std::uint16_t>({4, 1, 1}, [](auto i, auto, auto) { return 10 * i; });
  const GridView grid = make_grid_view(volume);
  const auto at = [&](float x) { return sample_nearest(grid, Vec3f(x, 0, 0)); };
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(at(i + 0.49f), 10.0f * i);
    EXPECT_EQ(at(i + 0.51f), 10.0f * (i + 1));
    EXPECT_TRUE(at(i + 0.5f) == 10.0f * i || at(i + 0.5f) == 10.0f * (i + 1));
  }
  EXPECT_EQ(at(-0.5f), 0.0f);
  EXPECT_EQ(at(-100.0f), 0.0f);
  EXPECT_EQ(at(3.5f), 30.0f);
  EXPECT_EQ(at(1e9f), 30.0f);
}

TEST(Sample, OutsideContinuesTheBorder) {
  const Volume volume = noise_volume<float>({4, 3, 5}, 14);
  const GridView grid = make_grid_view(volume);
  EXPECT_EQ(sample_trilinear(grid, {-7, 1, 2}), test::voxel_at<float>(volume, 0, 1, 2));
  EXPECT_EQ(sample_trilinear(grid, {-0.5f, -0.5f, -0.5f}), test::voxel_at<float>(volume, 0, 0, 0));
  EXPECT_FLOAT_EQ(sample_trilinear(grid, {3.5f, 2.5f, 4.5f}), test::voxel_at<float>(volume, 3, 2, 4));
  EXPECT_FLOAT_EQ(sample_trilinear(grid, {2, 1e9f, -1e9f}), test::voxel_at<float>(volume, 2, 2, 0));
}

TEST(Sample, LinearFieldsAreExact) {
  const auto field = [](auto i, auto j, auto k) { return 24 * i - 40 * j + 8 * k + 16; };
  const Volume i16 = make_volume<std::int16_t>({9, 6, 7}, field), f64 = make_volume<double>({9, 6, 7}, field);
  const GridView a = make_grid_view(i16), b = make_grid_view(f64);
  // On eighths of a voxel no operation rounds.
  for (int n = 0; n < 8 * 40 * 48; ++n) {
    const Vec3f p(static_cast<float>(n % 65) / 8, static_cast<float>(n / 7 % 41) / 8,
                  static_cast<float>(n / 11 % 49) / 8);
    ASSERT_EQ(sample_trilinear(a, p), field(p.x, p.y, p.z));
    ASSERT_EQ(sample_trilinear(b, p), field(p.x, p.y, p.z));
  }
}

TEST(Sample, NaNVoxelsSpoilWhatTheyTouch) {
  Volume volume = make_volume<float>(
      {5, 5, 5}, [](auto i, auto j, auto k) { return i == 2 && j == 2 && k == 2 ? kNaN : 1.0f; });
  const GridView grid = make_grid_view(volume);
  Rng rng(8, 0, 0, 0);
  for (int n = 0; n < 20000; ++n) {
    const Vec3f p = test::random_point(volume, rng);
    const float reach = std::max({std::abs(p.x - 2), std::abs(p.y - 2), std::abs(p.z - 2)});
    const float v = sample_trilinear(grid, p);
    if (reach < 1 && reach > 0) {
      ASSERT_TRUE(std::isnan(v));
    } else if (reach > 1) {
      ASSERT_EQ(v, 1.0f);
    }
  }
}

class Gradient : public testing::TestWithParam<int> {};

TEST_P(Gradient, LinearFieldIsExactInLps) {
  const test::Placement placement = test::placements()[static_cast<std::size_t>(GetParam())];
  const Vec3d slope(3.0, -1.5, 0.75);  // per mm, LPS
  Volume volume = make_volume<float>(
      {12, 14, 10}, [](auto, auto, auto) { return 0; }, placement);
  const Affined world = world_from_index(volume);
  const Vec3d origin(placement.origin_mm[0], placement.origin_mm[1], placement.origin_mm[2]);
  volume = make_volume<float>(
      volume.size, [&](auto i, auto j, auto k) { return dot(slope, world.point(Vec3d(i, j, k)) - origin); },
      placement);
  const GridView grid = make_grid_view(volume);
  Rng rng(9, 0, 0, 0);
  for (int n = 0; n < 5000; ++n) {
    Vec3f p;
    for (int a = 0; a < 3; ++a) p[a] = 1 + rng.next() * static_cast<float>(volume.size[a] - 3);
    const Vec3f gradient = sample_gradient(grid, p);
    // Data of up to 150 units, to 8 roundings, over a base of at least 0.8 mm.
    for (int a = 0; a < 3; ++a) ASSERT_NEAR(gradient[a], slope[a], 150 * 8 * 1.2e-7 / 0.8);
  }
}
INSTANTIATE_TEST_SUITE_P(Placements, Gradient, testing::Range(0, 4));

TEST(Gradient, OfASliceLiesInItsPlane) {
  const Volume volume = make_volume<std::int16_t>({8, 8, 1}, [](auto i, auto, auto) { return 10 * i; },
                                                  {{2, 2, 5}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}});
  const Vec3f gradient = sample_gradient(make_grid_view(volume), {3.3f, 4.2f, 0.1f});
  EXPECT_NEAR(gradient.x, 5.0f, 1e-4);
  EXPECT_EQ(gradient.y, 0.0f);
  EXPECT_EQ(gradient.z, 0.0f);
}

TEST(Gradient, IsTheCentralDifferenceOverOneSmallestSpacing) {
  const Volume volume = noise_volume<std::uint8_t>({7, 6, 8}, 15, test::placements()[3]);
  const GridView grid = make_grid_view(volume);
  const Affined index = world_from_index(volume).inverse();
  Rng rng(10, 0, 0, 0);
  for (int n = 0; n < 2000; ++n) {
    const Vec3f p = test::random_point(volume, rng);
    Vec3d expected(0);  // sum over the axes of (derivative along the axis) * (the axis' direction)
    for (int a = 0; a < 3; ++a) {
      Vec3d axis;
      for (int row = 0; row < 3; ++row) axis[row] = volume.direction[3 * row + a];
      const Vec3d step = index.vector(axis * 0.957);
      const double derivative = (test::reference_trilinear<std::uint8_t>(volume, Vec3d(p) + step) -
                                 test::reference_trilinear<std::uint8_t>(volume, Vec3d(p) - step)) /
                                (2 * 0.957);
      expected = expected + axis * derivative;
    }
    const Vec3f gradient = sample_gradient(grid, p);
    for (int a = 0; a < 3; ++a) ASSERT_NEAR(gradient[a], expected[a], 255 * 16 * 1.2e-7 / 0.957);
  }
}

}  // namespace
}  // namespace voxlume
