#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/moments.h"
#include "tracked_medium.h"

namespace voxlume {
namespace {

using test::kGlobal;
using test::make_volume;
using test::mu_t_function;
using test::TrackedMedium;

constexpr int kFlights = 200000;
constexpr int kChiSquareTests = 12;

/// Voxels a cell, and whether the flights are fine.
class FreeFlight : public testing::TestWithParam<std::tuple<int, bool>> {
 protected:
  static int cell_voxels() { return std::get<0>(GetParam()); }
  static bool fine() { return std::get<1>(GetParam()); }

  /// Flies along +x from the voxel centre (0,1,1); `depth(t)` is the optical depth of [0,t].
  template <class Depth>
  void expect_histogram(const TrackedMedium& tracked, double t_far, Depth&& depth) {
    constexpr int kBins = 64;
    std::vector<double> observed(kBins + 1), expected(kBins + 1);
    TrackingCounters counters;
    for (int n = 0; n < kFlights; ++n) {
      Rng rng(71, 0, 0, static_cast<std::uint32_t>(n));
      const Collision c = sample_free_flight(tracked.medium,
                                             {.ray = to_index_ray(tracked.medium.grid, {0, 1, 1}, {1, 0, 0}),
                                              .t_near = 0,
                                              .t_far = static_cast<float>(t_far),
                                              .fine = fine()},
                                             rng, counters);
      const int bin = c.real ? std::min(static_cast<int>(c.t_mm / t_far * kBins), kBins - 1) : kBins;
      observed[static_cast<std::size_t>(bin)] += 1;
      if (!c.real) continue;
      ASSERT_NEAR(c.p_index.x, c.t_mm / tracked.volume.spacing_mm[0], 1e-3);
      ASSERT_EQ(c.value, sample_trilinear(tracked.medium.grid, c.p_index));
    }
    for (int b = 0; b < kBins; ++b)
      expected[static_cast<std::size_t>(b)] =
          kFlights * (std::exp(-depth(t_far * b / kBins)) - std::exp(-depth(t_far * (b + 1) / kBins)));
    expected[kBins] = kFlights * std::exp(-depth(t_far));
    const test::ChiSquareResult result = test::chi_square(observed, expected);
    EXPECT_GT(result.p, test::significance(kChiSquareTests)) << result.statistic << " of " << result.degrees;
    EXPECT_EQ(counters.majorant_violations, 0u);
  }
};

TEST_P(FreeFlight, HistogramOfALinearField) {
  const TrackedMedium tracked(make_volume<std::uint8_t>({17, 3, 3}, [](auto i, auto, auto) { return i; }),
                              mu_t_function({{0, 0}, {16, 0.4}}), cell_voxels());
  expect_histogram(tracked, 16, [](double t) { return t * t / 80; });
}

TEST_P(FreeFlight, HistogramOfAnOscillatingField) {
  const double spacing = 1.0 / 1024;
  const TrackedMedium tracked(make_volume<float>({1025, 3, 3},
                                                 [&](auto i, auto, auto) {
                                                   const double t = i * spacing;
                                                   return 4 * t * t + 3 * (0.5 + 0.5 * std::sin(20 * t));
                                                 },
                                                 {{spacing, 1, 1}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}),
                              test::identity_function(10),
                              cell_voxels() == kGlobal ? kGlobal : cell_voxels() * 16);
  expect_histogram(tracked, 1,
                   [](double t) { return 4 * t * t * t / 3 + 1.5 * t + 1.5 * (1 - std::cos(20 * t)) / 20; });
}

TEST_P(FreeFlight, TwoLayerSlabByKolmogorovSmirnov) {
  // The data rises linearly; the function steps at 7.3: 0.05/mm before x = 7.3 mm, 0.4/mm behind it.
  const TrackedMedium tracked(make_volume<float>({17, 3, 3}, [](auto i, auto, auto) { return i; }),
                              mu_t_function({{0, 0.05}, {7.3, 0.05}, {7.3, 0.4}, {16, 0.4}}), cell_voxels());
  std::vector<double> distances;
  TrackingCounters counters;
  for (int n = 0; n < kFlights; ++n) {
    Rng rng(72, 0, 0, static_cast<std::uint32_t>(n));
    const TrackRay ray{.ray = {{0, 1, 1}, {1, 0, 0}}, .t_near = 0, .t_far = 16, .fine = fine()};
    const Collision c = sample_free_flight(tracked.medium, ray, rng, counters);
    if (c.real) distances.push_back(c.t_mm);
  }
  std::sort(distances.begin(), distances.end());
  double largest = 0;
  for (std::size_t i = 0; i < distances.size(); ++i) {
    const double t = distances[i];
    const double cdf = 1 - std::exp(-(0.05 * std::min(t, 7.3) + 0.4 * std::max(0.0, t - 7.3)));
    largest = std::max({largest, std::abs(cdf - static_cast<double>(i) / kFlights),
                        std::abs(cdf - static_cast<double>(i + 1) / kFlights)});
  }
  // P(sqrt(n) D > 1.9495) is 0.001.
  EXPECT_LT(largest * std::sqrt(double{kFlights}), 1.9495);
  EXPECT_EQ(counters.majorant_violations, 0u);
}
INSTANTIATE_TEST_SUITE_P(CellSizes, FreeFlight,
                         testing::Combine(testing::Values(1, 4, kGlobal), testing::Bool()));

TEST(FreeFlights, FineOnesFollowTheirThreshold) {
  // A ramp under one majorant: how far a flight gets depends on its threshold and on chance, less when fine.
  const TrackedMedium tracked(make_volume<float>({17, 3, 3}, [](auto i, auto, auto) { return i; }),
                              mu_t_function({{0, 0}, {16, 4}}), kGlobal);
  const auto spread_mm2 = [&](bool fine) {
    test::Moments spread;
    TrackingCounters counters;
    for (std::uint32_t n = 0; n < 4000; ++n) {
      TrackRay ray{.ray = {{0, 1, 1}, {1, 0, 0}}, .t_near = 0, .t_far = 16, .fine = fine};
      ray.u_collision = static_cast<float>(n) / 4000;
      Rng a(75, 0, 0, n), b(76, 0, 0, n);
      const float difference = sample_free_flight(tracked.medium, ray, a, counters).t_mm -
                               sample_free_flight(tracked.medium, ray, b, counters).t_mm;
      spread.add(0.5 * difference * difference);
    }
    return spread.mean();
  };
  EXPECT_LT(spread_mm2(true), 0.8 * spread_mm2(false));
}

TEST(FreeFlights, CarryTheOpticalDepthThroughEmptyCells) {
  // Visible before x = 2 and after x = 14, nothing between: the far part's distribution is that of one
  // medium.
  const TrackedMedium tracked(
      make_volume<std::uint8_t>({17, 3, 3}, [](auto i, auto, auto) { return i <= 2 || i >= 14 ? 1 : 0; }),
      mu_t_function({{0.999, 0}, {0.999, 0.5}, {2, 0.5}}), 2);
  std::vector<double> observed(9), expected(9);
  TrackingCounters counters;
  for (int n = 0; n < kFlights; ++n) {
    Rng rng(73, 0, 0, static_cast<std::uint32_t>(n));
    const Collision c = sample_free_flight(tracked.medium, {{{0, 1, 1}, {1, 0, 0}}, 0, 16}, rng, counters);
    ASSERT_TRUE(!c.real || c.t_mm < 2.002f || c.t_mm > 13.998f);
    const double visible = c.t_mm < 8 ? c.t_mm : c.t_mm - 12.0;
    observed[static_cast<std::size_t>(c.real ? std::clamp(visible * 2, 0.0, 7.0) : 8)] += 1;
  }
  // The step at 0.999 lies a thousandth of a voxel outside the ends.
  for (std::size_t b = 0; b < 8; ++b)
    expected[b] =
        kFlights * (std::exp(-0.25 * static_cast<double>(b)) - std::exp(-0.25 * static_cast<double>(b + 1)));
  expected[8] = kFlights * std::exp(-2.0);
  EXPECT_GT(test::chi_square(observed, expected).p, 1e-3);
}

TEST(FreeFlights, CoverTheOpticalDepthsOfTheExponential) {
  EXPECT_EQ(sample_optical_depth(0.0f), 0.0f);
  EXPECT_NEAR(sample_optical_depth(0.5f), 0.6931472, 1e-6);
  EXPECT_NEAR(sample_optical_depth(1 - 0x1p-24f), 24 * 0.6931472, 1e-4);
}

}  // namespace
}  // namespace voxlume
