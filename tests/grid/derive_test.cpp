#include "grid/derive.h"

#include <gtest/gtest.h>

#include "base/parallel.h"
#include "grid/sample.h"
#include "support/volumes.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::noise_volume;
using test::Placement;
using test::Size3;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

float at(const Volume& volume, std::int64_t i, std::int64_t j, std::int64_t k) {
  return test::voxel_at<float>(volume, i, j, k);
}

void expect_same_place(const Volume& derived, const Volume& source) {
  EXPECT_EQ(derived.type, VoxelType::kF32);
  EXPECT_EQ(derived.size, source.size);
  EXPECT_EQ(derived.spacing_mm, source.spacing_mm);
  EXPECT_EQ(derived.origin_mm, source.origin_mm);
  EXPECT_EQ(derived.direction, source.direction);
}

template <class Visit>
void each_voxel(const Volume& volume, Visit&& visit) {
  for (std::int64_t k = 0; k < volume.size[2]; ++k)
    for (std::int64_t j = 0; j < volume.size[1]; ++j)
      for (std::int64_t i = 0; i < volume.size[0]; ++i) visit(i, j, k);
}

template <class T>
class GradientMagnitude : public testing::Test {};
using VoxelTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                                  std::int32_t, float, double>;
TYPED_TEST_SUITE(GradientMagnitude, VoxelTypes);

TYPED_TEST(GradientMagnitude, IsTheLengthOfTheSampledGradient) {
  for (const Placement& place : test::placements())
    for (const Size3& size : {Size3{13, 9, 7}, Size3{1, 1, 1}, Size3{6, 1, 5}}) {
      const Volume volume = noise_volume<TypeParam>(size, 3, place);
      const Volume magnitude = gradient_magnitude(volume);
      expect_same_place(magnitude, volume);
      const GridView grid = make_grid_view(volume);
      const float most = std::is_floating_point_v<TypeParam>
                             ? 2000.0f
                             : static_cast<float>(std::numeric_limits<TypeParam>::max());
      each_voxel(volume, [&](auto i, auto j, auto k) {
        const float expected = length(sample_gradient(grid, Vec3f(i, j, k)));
        ASSERT_NEAR(at(magnitude, i, j, k), expected, 4e-6 * (expected + most));
      });
    }
}

TEST(GradientMagnitudeOf, ARampIsItsSlope) {
  const Placement place = test::placements()[3];
  const Volume volume = make_volume<float>(
      {9, 8, 7},
      [&](auto i, auto j, auto k) {
        return 3 * i * place.spacing_mm[0] - 4 * j * place.spacing_mm[1] + 12 * k * place.spacing_mm[2];
      },
      place);
  const Volume magnitude = gradient_magnitude(volume);
  for (std::int64_t k = 1; k < 6; ++k)
    for (std::int64_t j = 1; j < 7; ++j)
      for (std::int64_t i = 1; i < 8; ++i) ASSERT_NEAR(at(magnitude, i, j, k), 13, 1e-4);
  EXPECT_NEAR(at(magnitude, 0, 4, 3), std::hypot(1.5, 4.0, 12.0), 1e-4);  // continued beyond the border
}

TEST(GradientMagnitudeOf, NaNSpreadsToItsNeighbours) {
  const Volume volume = make_volume<float>(
      {5, 5, 5}, [](auto i, auto j, auto k) { return i == 2 && j == 2 && k == 2 ? kNaN : 1; });
  const Volume magnitude = gradient_magnitude(volume);
  EXPECT_TRUE(std::isnan(at(magnitude, 1, 2, 2)));
  EXPECT_TRUE(std::isnan(at(magnitude, 2, 2, 3)));
  EXPECT_EQ(at(magnitude, 1, 1, 2), 0);
}

/// Total and standard deviation [mm] along each axis of what a single voxel is smoothed to.
struct Spread {
  double total = 0, deviation_mm[3] = {0, 0, 0};
};
Spread spread_of_a_voxel(Size3 size, double sigma_mm, const Placement& place) {
  const Volume volume = make_volume<std::int16_t>(
      size,
      [&](auto i, auto j, auto k) {
        return i == size[0] / 2 && j == size[1] / 2 && k == size[2] / 2 ? 1000 : 0;
      },
      place);
  const Volume out = smoothed(volume, sigma_mm);
  expect_same_place(out, volume);
  Spread spread;
  each_voxel(out, [&](auto i, auto j, auto k) {
    const double w = at(out, i, j, k) / 1000;
    const std::int64_t p[3] = {i, j, k};
    spread.total += w;
    for (int a = 0; a < 3; ++a)
      spread.deviation_mm[a] += w * std::pow((p[a] - size[a] / 2) * place.spacing_mm[a], 2);
  });
  for (double& d : spread.deviation_mm) d = std::sqrt(d);
  return spread;
}

TEST(Smoothed, AVoxelSpreadsBySigma) {
  Placement place;
  place.spacing_mm = {0.8, 1.3, 2.5};
  for (const double sigma_mm : {0.5, 1.0, 2.3}) {
    const Spread spread = spread_of_a_voxel({41, 31, 25}, sigma_mm, place);
    EXPECT_NEAR(spread.total, 1, 1e-4);
    for (const double d : spread.deviation_mm) EXPECT_NEAR(d, sigma_mm, 0.003 * sigma_mm);
  }
  const Spread slice = spread_of_a_voxel({41, 31, 1}, 1.5, place);
  EXPECT_NEAR(slice.total, 1, 1e-4);
  EXPECT_NEAR(slice.deviation_mm[0], 1.5, 0.005);
  EXPECT_EQ(slice.deviation_mm[2], 0);
}

TEST(Smoothed, AnEdgeBecomesTheErrorFunction) {
  for (const double sigma : {3.0, 6.0, 12.0}) {
    const Volume volume =
        make_volume<std::uint8_t>({101, 5, 1}, [](auto i, auto, auto) { return i < 50 ? 0 : 200; });
    const Volume out = smoothed(volume, sigma);
    for (std::int64_t i = 0; i < 101; ++i) {
      const double expected = 100 * (1 + std::erf((i - 49.5) / (sigma * std::sqrt(2.0))));
      // Beyond the border the border's voxel goes on, as the step does.
      ASSERT_NEAR(at(out, i, 2, 0), expected, 1.2) << sigma << " " << i;
    }
  }
}

TEST(Smoothed, AConstantStays) {
  for (const Size3& size : {Size3{1, 1, 1}, Size3{20, 1, 3}, Size3{9, 30, 2}, Size3{12, 11, 10}})
    for (const double sigma_mm : {0.0, 0.2, 2.0, 40.0}) {
      const Volume out =
          smoothed(make_volume<std::int32_t>(size, [](auto, auto, auto) { return -1024; }), sigma_mm);
      each_voxel(out, [&](auto i, auto j, auto k) { ASSERT_NEAR(at(out, i, j, k), -1024, 0.01); });
    }
}

TEST(Smoothed, VoxelsThatAreNotFiniteCountAsTheSmallest) {
  const auto value = [](auto i, auto j, auto k) {
    return static_cast<float>(10 + (i * 3 + j * 5 + k * 7) % 11);
  };
  const auto holes = [](auto i, auto j, auto k) { return (i + 2 * j + 3 * k) % 9 == 4; };
  const Volume damaged = make_volume<double>({12, 11, 10}, [&](auto i, auto j, auto k) {
    return holes(i, j, k) ? (i % 2 ? double{kNaN} : std::numeric_limits<double>::infinity()) : value(i, j, k);
  });
  const Volume filled = make_volume<double>(
      {12, 11, 10}, [&](auto i, auto j, auto k) { return holes(i, j, k) ? 10 : value(i, j, k); });
  const Volume a = smoothed(damaged, 1.2), b = smoothed(filled, 1.2);
  each_voxel(a, [&](auto i, auto j, auto k) { ASSERT_EQ(at(a, i, j, k), at(b, i, j, k)); });
  const Volume none = smoothed(make_volume<float>({5, 5, 5}, [](auto, auto, auto) { return kNaN; }), 1);
  EXPECT_EQ(at(none, 2, 2, 2), 0);
}

TEST(Smoothed, RefusesASigmaThatIsNone) {
  const Volume volume = noise_volume<std::uint8_t>({4, 4, 4}, 1);
  for (const double sigma : {-1.0, double{kNaN}, std::numeric_limits<double>::infinity()}) {
    try {
      smoothed(volume, sigma);
      ADD_FAILURE() << sigma;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
    }
  }
}

TEST(SignedDistance, OfABallIsWithinHalfAVoxel) {
  const double radius_mm = 14;
  for (const std::array<double, 3>& spacing : {std::array{1.0, 1.0, 1.0}, std::array{0.7, 0.7, 2.5}}) {
    Placement place;
    place.spacing_mm = spacing;
    const Size3 size{static_cast<int>(38 / spacing[0]), static_cast<int>(38 / spacing[1]),
                     static_cast<int>(38 / spacing[2])};
    const auto depth = [&](auto i, auto j, auto k) {
      return radius_mm - std::hypot(i * spacing[0] - 18.6, j * spacing[1] - 18.3, k * spacing[2] - 18.9);
    };
    const Volume labels = make_volume<std::uint16_t>(
        size, [&](auto i, auto j, auto k) { return depth(i, j, k) < 0 ? 7
                                                   : i % 2            ? 300
                                                                      : 4000; }, place);
    const Volume distance = signed_distance(labels, std::array{300.0f, 4000.0f, 11.0f});
    expect_same_place(distance, labels);
    const double half = 0.5 * std::max({spacing[0], spacing[1], spacing[2]});
    each_voxel(labels, [&](auto i, auto j, auto k) {
      const double expected = depth(i, j, k);
      ASSERT_NEAR(at(distance, i, j, k), expected, half + 1e-3);
      ASSERT_EQ(at(distance, i, j, k) > 0, expected >= 0);
    });
  }
}

TEST(SignedDistance, OfASlabIsExact) {
  Placement place = test::placements()[3];
  for (int axis = 0; axis < 3; ++axis) {
    const Volume labels = make_volume<std::int8_t>(
        {12, 11, 10},
        [&](auto i, auto j, auto k) {
          const std::int64_t p[3] = {i, j, k};
          return p[axis] < 4 ? -5 : 2;
        },
        place);
    const Volume distance = signed_distance(labels, std::array{-5.0f});
    each_voxel(labels, [&](auto i, auto j, auto k) {
      const std::int64_t p[3] = {i, j, k};
      ASSERT_NEAR(at(distance, i, j, k), (3.5 - p[axis]) * place.spacing_mm[axis], 1e-4);
    });
  }
}

/// The least distance to a voxel of the other side, by looking at all.
TEST(SignedDistance, OfNoiseIsThatToTheNearestVoxelLessHalfOfOne) {
  Placement place;
  place.spacing_mm = {0.9, 1.4, 0.6};
  for (const Size3& size : {Size3{11, 9, 10}, Size3{15, 12, 1}, Size3{1, 1, 20}}) {
    Rng rng(5, 0, 0, 0);
    const Volume labels = make_volume<float>(
        size, [&](auto, auto, auto) { return rng.next() < 0.96f ? 1 : 2; }, place);
    const Volume distance = signed_distance(labels, std::array{2.0f});
    each_voxel(labels, [&](auto i, auto j, auto k) {
      double nearest = 1e9;
      each_voxel(labels, [&](auto x, auto y, auto z) {
        if (at(labels, x, y, z) != at(labels, i, j, k))
          nearest = std::min(nearest, std::hypot((x - i) * 0.9, (y - j) * 1.4, (z - k) * 0.6));
      });
      const double found = std::abs(at(distance, i, j, k));
      ASSERT_LE(found, nearest - 0.5 * std::min(0.6, nearest) + 1e-4);
      ASSERT_GE(found, nearest - 0.7 - 1e-4);
      ASSERT_EQ(at(distance, i, j, k) > 0, at(labels, i, j, k) == 2);
    });
  }
}

TEST(SignedDistance, WithoutABoundaryIsAConstant) {
  const Volume labels = make_volume<std::uint8_t>({5, 4, 3}, [](auto, auto, auto) { return 3; });
  const Volume full = signed_distance(labels, std::array{3.0f}), empty = signed_distance(labels, {});
  each_voxel(labels, [&](auto i, auto j, auto k) {
    ASSERT_EQ(at(full, i, j, k), kNoBoundary_mm);
    ASSERT_EQ(at(empty, i, j, k), -kNoBoundary_mm);
  });
}

TEST(Derived, DoNotDependOnTheThreads) {
  const Volume volume = noise_volume<std::int16_t>({31, 22, 17}, 0, 3, 8);
  const auto same = [&](auto derive) {
    Volume out[2];
    for (int n = 0; n < 2; ++n) {
      const ThreadLimit limit(1 + 4 * n);
      out[n] = derive();
    }
    each_voxel(volume, [&](auto i, auto j, auto k) { ASSERT_EQ(at(out[0], i, j, k), at(out[1], i, j, k)); });
  };
  same([&] { return gradient_magnitude(volume); });
  same([&] { return smoothed(volume, 1.7); });
  same([&] { return smoothed(volume, 4.0); });
  same([&] { return signed_distance(volume, std::array{0.0f}); });
}

TEST(Derived, TellHowMuchIsDone) {
  const Volume volume =
      make_volume<std::int16_t>({40, 40, 40}, [](auto i, auto, auto) { return i < 20 ? 0 : 1; });
  struct Ended {};
  const auto check = [](auto derive) {
    std::vector<double> told;
    derive([&](double share) { told.push_back(share); });
    ASSERT_GE(told.size(), 2u);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LE(told.back(), 1);
    // What is thrown reaches the caller.
    EXPECT_THROW(derive([](double) { throw Ended(); }), Ended);
  };
  check([&](const Progress& progress) { gradient_magnitude(volume, progress); });
  check([&](const Progress& progress) { smoothed(volume, 1, progress); });
  check([&](const Progress& progress) { smoothed(volume, 4, progress); });
  check([&](const Progress& progress) { signed_distance(volume, std::array{1.0f}, progress); });
}

TEST(Derived, RefuseMoreThanTheMachineHas) {
  Volume volume;
  volume.size = {1 << 20, 1 << 20, 1 << 10};
  volume.type = VoxelType::kU8;
  const auto refused = [](auto derive) {
    try {
      derive();
    } catch (const Error& error) {
      return error.code() == ErrorCode::kOutOfMemory;
    }
    return false;
  };
  EXPECT_TRUE(refused([&] { gradient_magnitude(volume); }));
  EXPECT_TRUE(refused([&] { smoothed(volume, 1); }));
  EXPECT_TRUE(refused([&] { signed_distance(volume, std::array{1.0f}); }));
}

}  // namespace
}  // namespace voxlume
