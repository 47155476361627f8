// Residual ratio tracking, unbiased ray marching and decomposition tracking against closed forms and
// quadrature.
#include "tracking/estimators.h"

#include <gtest/gtest.h>

#include <functional>

#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"
#include "tracked_medium.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::kGlobal;
using test::make_volume;
using test::mu_t_function;
using test::TrackedMedium;

constexpr int kSamples = 60000;
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

test::Moments transmittances(TransmittanceEstimator choice, const TrackedMedium& tracked, const TrackRay& ray,
                             int samples, TrackingCounters& counters) {
  test::Moments moments;
  for (int n = 0; n < samples; ++n) {
    Rng rng(91, 0, 0, static_cast<std::uint32_t>(n));
    moments.add(estimate_transmittance(TrackerChoice{choice}, tracked.medium, ray, rng, counters));
  }
  return moments;
}

/// The estimators and the free flights' survival against a known transmittance, at |z| < 4.
void expect_transmittance(const TrackedMedium& tracked, const TrackRay& ray, double expected,
                          int samples = kSamples) {
  TrackingCounters counters;
  for (const auto choice : {TransmittanceEstimator::kResidual, TransmittanceEstimator::kMarching}) {
    const test::Moments m = transmittances(choice, tracked, ray, samples, counters);
    EXPECT_LT(std::abs(m.z(expected, 1e-5 * expected)), 4)
        << (choice == TransmittanceEstimator::kResidual ? "residual " : "marching ") << m.mean() << " +- "
        << m.standard_error() << " expected " << expected;
  }
  test::Moments survived;
  for (int n = 0; n < samples; ++n) {
    Rng rng(92, 0, 0, static_cast<std::uint32_t>(n));
    const Collision c = sample_free_flight_decomposed(tracked.medium, ray, rng, counters);
    ASSERT_TRUE(!c.real || (c.t_mm >= ray.t_near && c.t_mm <= ray.t_far));
    survived.add(c.real ? 0 : 1);
  }
  EXPECT_LT(std::abs(survived.z(expected, 1e-5 * expected)), 4)
      << survived.mean() << " expected " << expected;
  EXPECT_EQ(counters.majorant_violations, 0u);
}

class Estimators : public testing::TestWithParam<std::tuple<int, CellMinima>> {
 protected:
  TrackedMedium medium(Volume volume, const CurvePoints& points) const {
    return {std::move(volume), mu_t_function(points), std::get<0>(GetParam()), std::get<1>(GetParam())};
  }
};

TEST_P(Estimators, Linear) {
  const TrackedMedium tracked = medium(
      make_volume<std::uint16_t>({17, 3, 3}, [](auto i, auto, auto) { return i; }), {{0, 0.1}, {16, 0.5}});
  // mu_t = 0.1 + x / 40 between the outermost voxel centres.
  const auto depth = [](double x) { return 0.1 * x + x * x / 80; };
  expect_transmittance(tracked, {{{0, 1, 1}, {1, 0, 0}}, 0, 16}, std::exp(-depth(16)));
  expect_transmittance(tracked, {{{0, 1, 1}, {1, 0, 0}}, 3.5f, 9.25f}, std::exp(depth(3.5) - depth(9.25)));
  expect_transmittance(tracked, {{{16, 1, 1}, {-1, 0, 0}}, 2, 13}, std::exp(depth(3) - depth(14)));
}

TEST_P(Estimators, NoiseAndNeedlesAtAnyAngle) {
  const CurvePoints points{{-500, 0.01}, {0, 0.1}, {0, 0.02},   {10, 0.02},
                           {12, 0.9},    {14, 0},  {400, 0.05}, {900, 0.3}};
  const TrackedMedium tracked =
      medium(test::noise_volume<std::int16_t>({14, 11, 9}, -600, 1000, 63, test::placements()[3]), points);
  const Vec3d center = world_from_index(tracked.volume).point({6.5, 5, 4});
  Rng rng(64, 0, 0, 0);
  for (int n = 0; n < 2; ++n) {
    const Vec3f direction = test::random_direction(rng);
    const IndexRay ray = to_index_ray(tracked.medium.grid, Vec3f(center) - direction * 40.0f, direction);
    const Interval<float> run = tracked.inside(ray);
    const double tau = test::reference_optical_depth<std::int16_t>(tracked.volume, points, ray, run.t_near,
                                                                   run.t_far, 100000);
    ASSERT_GT(tau, 0.3);
    expect_transmittance(tracked, {ray, run.t_near, run.t_far}, std::exp(-tau));
  }
}

TEST_P(Estimators, SpikeBetweenTwoVoxelValues) {
  const TrackedMedium tracked =
      medium(make_volume<std::uint8_t>({9, 3, 3}, [](auto i, auto, auto) { return i < 4 ? 0 : 100; }),
             {{49, 0.1}, {50, 60}, {51, 0.1}});
  // Triangle of 60/mm over 0.02 mm on a floor of 0.1.
  expect_transmittance(tracked, {{{0, 1, 1}, {1, 0, 0}}, 3, 4.5f}, std::exp(-0.15 - 59.9 * 0.01));
}

TEST_P(Estimators, ThinMatterUnderAFarGreaterMajorant) {
  // Off the ray's way lies what makes the majorant 2/mm, of which the ray meets 0.25.
  const TrackedMedium tracked =
      medium(make_volume<std::uint8_t>({17, 9, 9}, [](auto, auto j, auto) { return j == 0 ? 8 : 1; }),
             {{0, 0}, {8, 2}});
  expect_transmittance(tracked, {{{0, 4, 4}, {1, 0, 0}}, 0, 16}, std::exp(-4.0));
}

TEST_P(Estimators, EmptyPartsAndOpaqueOnes) {
  const TrackedMedium tracked = medium(
      make_volume<std::uint8_t>({33, 3, 3}, [](auto i, auto, auto) { return i >= 14 && i <= 16 ? 1 : 0; }),
      {{0.999, 0}, {0.999, 0.5}, {2, 0.5}});
  // The step at 0.999 lies a thousandth of a voxel outside.
  expect_transmittance(tracked, {{{0, 1, 1}, {1, 0, 0}}, 0, 32}, std::exp(-0.5 * 2.002));
  TrackingCounters counters;
  for (const auto choice : {TransmittanceEstimator::kResidual, TransmittanceEstimator::kMarching}) {
    Rng rng(1, 0, 0, 0);
    EXPECT_EQ(estimate_transmittance(TrackerChoice{choice}, tracked.medium, {{{20, 1, 1}, {1, 0, 0}}, 0, 12},
                                     rng, counters),
              1.0f);
    const TrackedMedium opaque =
        medium(make_volume<std::uint8_t>({9, 9, 9}, [](auto, auto, auto) { return 1; }), {{0, 1e6}});
    for (std::uint32_t n = 0; n < 200; ++n) {
      Rng other(3, 0, 0, n);
      ASSERT_EQ(estimate_transmittance(TrackerChoice{choice}, opaque.medium,
                                       {{{-0.5f, 4, 4}, {1, 0, 0}}, 0, 9}, other, counters),
                0.0f);
      const Collision c =
          sample_free_flight_decomposed(opaque.medium, {{{-0.5f, 4, 4}, {1, 0, 0}}, 0, 9}, other, counters);
      ASSERT_TRUE(c.real && c.t_mm < 1e-4f);
    }
  }
}

TEST_P(Estimators, NaNVoxelsAreTransparent) {
  // Nothing of [2,6] is visible: 6 mm of 10 remain.
  const TrackedMedium tracked = medium(
      make_volume<float>({10, 3, 3}, [](auto i, auto, auto) { return i >= 3 && i <= 5 ? kNaN : 1.0f; }),
      {{0, 0.2}});
  expect_transmittance(tracked, {{{-0.5f, 1, 1}, {1, 0, 0}}, 0, 10}, std::exp(-1.2));
}

TEST_P(Estimators, EmptyIntervals) {
  const TrackedMedium tracked = medium(test::noise_volume<std::uint8_t>({9, 9, 9}, 82), {{0, 100}});
  TrackingCounters counters;
  for (const auto& [a, b] : {std::pair{1.0f, 1.0f}, std::pair{3.0f, 1.0f}, std::pair{kNaN, 1.0f}})
    for (const auto choice : {TransmittanceEstimator::kResidual, TransmittanceEstimator::kMarching}) {
      Rng rng(2, 0, 0, 0);
      const TrackRay ray{{{0, 1, 1}, {1, 0, 0}}, a, b};
      EXPECT_EQ(estimate_transmittance(TrackerChoice{choice}, tracked.medium, ray, rng, counters), 1.0f);
      EXPECT_FALSE(sample_free_flight_decomposed(tracked.medium, ray, rng, counters).real);
    }
  EXPECT_EQ(counters.steps, 0u);
}

TEST_P(Estimators, FreeFlightHistogram) {
  constexpr int kFlights = 200000, kBins = 64;
  const TrackedMedium tracked = medium(
      make_volume<std::uint8_t>({17, 3, 3}, [](auto i, auto, auto) { return i; }), {{0, 0.1}, {16, 0.4}});
  const auto depth = [](double t) { return 0.1 * t + 0.3 * t * t / 32; };
  std::vector<double> observed(kBins + 1), expected(kBins + 1);
  TrackingCounters counters;
  for (int n = 0; n < kFlights; ++n) {
    Rng rng(71, 0, 0, static_cast<std::uint32_t>(n));
    const Collision c =
        sample_free_flight_decomposed(tracked.medium, {{{0, 1, 1}, {1, 0, 0}}, 0, 16}, rng, counters);
    observed[c.real ? std::min<std::size_t>(static_cast<std::size_t>(c.t_mm * (kBins / 16.0f)), kBins - 1)
                    : kBins] += 1;
    if (!c.real) continue;
    ASSERT_NEAR(c.p_index.x, c.t_mm, 1e-3);
    ASSERT_EQ(c.value, sample_trilinear(tracked.medium.grid, c.p_index));
  }
  for (int b = 0; b < kBins; ++b)
    expected[static_cast<std::size_t>(b)] =
        kFlights * (std::exp(-depth(16.0 * b / kBins)) - std::exp(-depth(16.0 * (b + 1) / kBins)));
  expected[kBins] = kFlights * std::exp(-depth(16));
  const test::ChiSquareResult result = test::chi_square(observed, expected);
  EXPECT_GT(result.p, test::significance(6)) << result.statistic << " of " << result.degrees;
  EXPECT_EQ(counters.majorant_violations, 0u);
}

INSTANTIATE_TEST_SUITE_P(CellsAndMinima, Estimators,
                         testing::Combine(testing::Values(1, 4, kGlobal),
                                          testing::Values(CellMinima::kNone, CellMinima::kKept)));

TEST(EstimatorsOfHomogeneousMatter, AreExact) {
  // Whatever differs between look-ups is the control's; 2 is below where Russian roulette begins.
  const TrackedMedium tracked(make_volume<std::uint8_t>({10, 4, 4}, [](auto, auto, auto) { return 9; }),
                              mu_t_function({{0, 0.2}}), 4, CellMinima::kKept);
  for (const auto choice : {TransmittanceEstimator::kResidual, TransmittanceEstimator::kMarching}) {
    TrackingCounters counters;
    for (std::uint32_t n = 0; n < 20000; ++n) {
      Rng rng(93, 0, 0, n);
      ASSERT_NEAR(estimate_transmittance(TrackerChoice{choice}, tracked.medium,
                                         {{{-0.5f, 1, 1}, {1, 0, 0}}, 0, 10}, rng, counters),
                  std::exp(-2.0), 1e-6);
    }
    EXPECT_EQ(counters.majorant_violations, 0u);
  }
}

TEST(EstimatorsOfHomogeneousMatter, AreUnbiasedUnderRoulette) {
  for (const CellMinima minima : {CellMinima::kNone, CellMinima::kKept}) {
    const TrackedMedium tracked(
        make_volume<std::uint8_t>({10, 9, 3}, [](auto, auto j, auto) { return j ? 1 : 2; }),
        mu_t_function({{0, 0}, {2, 2}}), kGlobal, minima);
    TrackingCounters counters;
    for (const auto choice : {TransmittanceEstimator::kResidual, TransmittanceEstimator::kMarching}) {
      const test::Moments m =
          transmittances(choice, tracked, {{{0, 5, 1}, {1, 0, 0}}, 0, 9}, 400000, counters);
      // Ray marching is exact here, up to float rounding: all that the ray meets is alike.
      EXPECT_LT(std::abs(m.z(std::exp(-9.0), 1e-5 * std::exp(-9.0))), 4) << m.mean();
      EXPECT_LT(m.standard_error(), 0.05 * std::exp(-9.0));
    }
  }
}

TEST(EstimatorVariance, FallsWithTheControlAndMarching) {
  const TrackedMedium tracked(
      make_volume<std::uint8_t>({33, 9, 9}, [](auto i, auto j, auto) { return 4 + (i / 3 + j) % 3; }),
      mu_t_function({{0, 0}, {8, 0.4}}), 4, CellMinima::kKept);
  const TrackRay ray{{{0, 4.2f, 4}, {1, 0, 0}}, 0, 8};
  TrackingCounters counters;
  const auto error = [&](TransmittanceEstimator choice) {
    return transmittances(choice, tracked, ray, 20000, counters).standard_error();
  };
  const double ratio = error(TransmittanceEstimator::kRatio);
  EXPECT_LT(error(TransmittanceEstimator::kResidual), 0.7 * ratio);
  EXPECT_LT(error(TransmittanceEstimator::kMarching), 0.5 * ratio);
}

}  // namespace
}  // namespace voxlume
