#include <gtest/gtest.h>

#include "base/parallel.h"
#include "grid/volume_statistics.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::noise_volume;

constexpr double kFractions[] = {0, 0.001, 0.01, 0.25, 0.5, 0.75, 0.99, 0.999, 1};

template <class T>
std::vector<double> finite_sorted(const Volume& volume) {
  const auto* voxels = static_cast<const T*>(volume.voxels.get());
  std::vector<double> out;
  for (std::size_t n = 0; n < volume.voxel_count(); ++n)
    if (std::isfinite(static_cast<double>(voxels[n]))) out.push_back(static_cast<double>(voxels[n]));
  std::sort(out.begin(), out.end());
  return out;
}

/// The smallest value that at least `fraction` of all do not exceed.
double percentile_of(const std::vector<double>& sorted, double fraction) {
  const auto rank = static_cast<std::size_t>(std::ceil(fraction * static_cast<double>(sorted.size())));
  return sorted[rank > 0 ? rank - 1 : 0];
}

template <class T>
class Statistics : public testing::Test {};
using VoxelTypes = testing::Types<std::uint8_t, std::int8_t, std::uint16_t, std::int16_t, std::uint32_t,
                                  std::int32_t, float, double>;
TYPED_TEST_SUITE(Statistics, VoxelTypes);

TYPED_TEST(Statistics, AgreeWithSorting) {
  const Volume volume = noise_volume<TypeParam>({31, 23, 17}, 31);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const std::vector<double> sorted = finite_sorted<TypeParam>(volume);
  EXPECT_EQ(statistics.lower, static_cast<float>(sorted.front()));
  EXPECT_EQ(statistics.upper, static_cast<float>(sorted.back()));
  EXPECT_EQ(statistics.nonfinite_voxels, 0u);
  const double bin = sizeof(TypeParam) <= 2 ? 0 : (sorted.back() - sorted.front()) / 65535;
  const double rounding = sizeof(TypeParam) <= 2 ? 0 : 1.2e-7 * std::max(-sorted.front(), sorted.back());
  for (const double fraction : kFractions)
    EXPECT_NEAR(statistics.percentile(fraction), percentile_of(sorted, fraction), bin + rounding) << fraction;
  std::uint64_t total = 0;
  for (std::size_t n = 0; n < statistics.histogram.size(); ++n) {
    total += statistics.histogram[n].second;
    if (n > 0) {
      EXPECT_LT(statistics.histogram[n - 1].first, statistics.histogram[n].first);
    }
  }
  EXPECT_EQ(total, volume.voxel_count());
}

TYPED_TEST(Statistics, TellHowFarTheyAre) {
  const Volume volume = noise_volume<TypeParam>({5, 4, 17}, 31);
  std::vector<double> shares;  // told of by one thread at a time
  compute_statistics(make_grid_view(volume), [&](double share) { shares.push_back(share); });
  ASSERT_EQ(shares.size(), sizeof(TypeParam) <= 2 ? 17u : 34u);
  for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]);
  EXPECT_EQ(shares.back(), 1);
}

TYPED_TEST(Statistics, OneValue) {
  const Volume volume = make_volume<TypeParam>({4, 3, 1}, [](auto, auto, auto) { return 7; });
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  EXPECT_EQ(statistics.lower, 7.0f);
  EXPECT_EQ(statistics.upper, 7.0f);
  EXPECT_EQ(statistics.percentile(0), 7.0f);
  EXPECT_EQ(statistics.percentile(1), 7.0f);
  EXPECT_EQ(statistics.gradient_p999, 1.0f);
}

TYPED_TEST(Statistics, GradientPercentileAgreesWithSorting) {
  for (const test::Placement& placement : test::placements()) {
    const Volume volume = noise_volume<TypeParam>({21, 18, 16}, 32, placement);
    const auto* voxels = static_cast<const TypeParam*>(volume.voxels.get());
    const auto at = [&](std::int64_t i, std::int64_t j, std::int64_t k) {
      return static_cast<double>(voxels[(k * 18 + j) * 21 + i]);
    };
    std::vector<double> magnitudes;
    for (std::int64_t k = 0; k < 16; ++k)
      for (std::int64_t j = 0; j < 18; ++j)
        for (std::int64_t i = 0; i < 21; ++i) {
          const double along[3] = {
              at(std::min<std::int64_t>(i + 1, 20), j, k) - at(std::max<std::int64_t>(i - 1, 0), j, k),
              at(i, std::min<std::int64_t>(j + 1, 17), k) - at(i, std::max<std::int64_t>(j - 1, 0), k),
              at(i, j, std::min<std::int64_t>(k + 1, 15)) - at(i, j, std::max<std::int64_t>(k - 1, 0))};
          double squares = 0;
          for (int a = 0; a < 3; ++a) squares += std::pow(along[a] / (2 * placement.spacing_mm[a]), 2);
          if (squares > 0) magnitudes.push_back(std::sqrt(squares));
        }
    std::sort(magnitudes.begin(), magnitudes.end());
    const double expected = percentile_of(magnitudes, 0.999);
    // Bins are at most 1/128 of their lower end wide and answer with their middle.
    EXPECT_NEAR(compute_statistics(make_grid_view(volume)).gradient_p999 / expected, 1, 1.0 / 256 + 1e-5);
  }
}

TEST(Statistics, PaddingDoesNotChangeTheGradientScale) {
  const auto ball = [](std::int64_t n) {
    return make_volume<std::uint8_t>({n, n, n}, [n](auto i, auto j, auto k) {
      const auto d = [n](std::int64_t x) {
        return static_cast<double>(x) - 0.5 * static_cast<double>(n - 1);
      };
      return std::max(0.0, 200 - 20 * std::hypot(d(i), d(j), d(k)));
    });
  };
  const float scale = compute_statistics(make_grid_view(ball(24))).gradient_p999;
  EXPECT_EQ(compute_statistics(make_grid_view(ball(160))).gradient_p999, scale);
  EXPECT_GT(scale, 1.0f);
}

TEST(Statistics, NonFiniteVoxelsAreCountedAndLeftOut) {
  const float inf = std::numeric_limits<float>::infinity();
  const Volume volume = make_volume<float>({10, 10, 10}, [&](auto i, auto j, auto k) {
    if (i == 0) return j == 0 ? inf : j == 1 ? -inf : std::numeric_limits<float>::quiet_NaN();
    return static_cast<float>(j + k);
  });
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  EXPECT_EQ(statistics.nonfinite_voxels, 100u);
  EXPECT_EQ(statistics.lower, 0.0f);
  EXPECT_EQ(statistics.upper, 18.0f);
  EXPECT_NEAR(statistics.percentile(0.5), 9.0f, 18.0 / 65535);
  EXPECT_TRUE(std::isfinite(statistics.gradient_p999));
}

TEST(Statistics, NothingFinite) {
  const Volume volume = make_volume<double>(
      {2, 3, 4}, [](auto, auto, auto) { return std::numeric_limits<double>::quiet_NaN(); });
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  EXPECT_EQ(statistics.nonfinite_voxels, 24u);
  EXPECT_EQ(statistics.lower, 0.0f);
  EXPECT_EQ(statistics.upper, 0.0f);
  EXPECT_EQ(statistics.percentile(0.5), 0.0f);
}

TEST(Statistics, ExtremeRangesStayInBounds) {
  for (const auto& [a, b] : {std::pair{0.0, 5e-324}, std::pair{-1.7e308, 1.7e308},
                             std::pair{1.0, 1.0 + 2.3e-16}, std::pair{-3e38, 3e38}, std::pair{0.0, 1e-310}}) {
    const Volume volume = make_volume<double>({4, 4, 4}, [&](auto i, auto, auto) { return i % 2 ? a : b; });
    const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
    std::uint64_t total = 0;
    for (const auto& bin : statistics.histogram) total += bin.second;
    EXPECT_EQ(total, 64u) << a << " " << b;
  }
}

TEST(Statistics, AreTheSameForAnyThreadCount) {
  const Volume volume = noise_volume<float>({40, 30, 37}, 33);
  const GridView grid = make_grid_view(volume);
  const auto compute = [&](int threads) {
    const ThreadLimit limit(threads);
    return compute_statistics(grid);
  };
  const VolumeStatistics one = compute(1);
  for (const int threads : {2, 3, 8}) {
    const VolumeStatistics other = compute(threads);
    EXPECT_EQ(one.lower, other.lower);
    EXPECT_EQ(one.upper, other.upper);
    EXPECT_EQ(one.gradient_p999, other.gradient_p999);
    EXPECT_EQ(one.histogram, other.histogram);
  }
}

}  // namespace
}  // namespace voxlume
