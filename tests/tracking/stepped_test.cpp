#include <gtest/gtest.h>

#include "support/chi_square.h"
#include "support/moments.h"
#include "tracked_medium.h"
#include "tracking/estimators.h"

namespace voxlume {
namespace {

using test::kGlobal;
using test::make_volume;
using test::mu_t_function;
using test::TrackedMedium;

constexpr double kMu = 0.2;
constexpr float kStep_mm = 2;
constexpr int kSteps = 8;

TrackedMedium& homogeneous() {
  static TrackedMedium tracked(make_volume<std::uint8_t>({17, 3, 3}, [](auto, auto, auto) { return 1; }),
                               mu_t_function({{0, kMu}, {1, kMu}}), kGlobal);
  return tracked;
}

TrackRay along_x() { return {{{0, 1, 1}, {1, 0, 0}}, 0, kStep_mm * kSteps}; }

TEST(Stepped, FlightsEndAtStepsAsTheirDepthsSay) {
  constexpr int kFlights = 100000;
  std::vector<double> observed(kSteps + 1), expected(kSteps + 1);
  TrackingCounters counters;
  for (std::uint32_t n = 0; n < kFlights; ++n) {
    Rng rng(31, 0, 0, n);
    const Collision c = sample_free_flight_stepped(homogeneous().medium, along_x(), kStep_mm, rng, counters);
    observed[c.real ? static_cast<std::size_t>(c.t_mm / kStep_mm) : kSteps] += 1;
    if (!c.real) continue;
    ASSERT_NEAR(c.p_index.x, c.t_mm, 1e-4);
  }
  for (int k = 0; k <= kSteps; ++k)
    expected[static_cast<std::size_t>(k)] =
        kFlights * std::exp(-kMu * kStep_mm * k) * (k < kSteps ? 1 - std::exp(-kMu * kStep_mm) : 1);
  const test::ChiSquareResult result = test::chi_square(observed, expected);
  EXPECT_GT(result.p, test::significance(4)) << result.statistic;
  EXPECT_LE(counters.steps, std::uint64_t{kFlights} * kSteps);
}

TEST(Stepped, TransmittanceHasTheMeanOfItsSumAndIsOneOrNothing) {
  Medium medium = homogeneous().medium;
  for (const float share : {1.0f, 0.3f}) {
    medium.shadow_extinction = share;
    test::Moments mean;
    TrackingCounters counters;
    for (std::uint32_t n = 0; n < 100000; ++n) {
      Rng rng(32, 0, 0, n);
      const float t = estimate_transmittance_stepped(medium, along_x(), kStep_mm, rng, counters);
      ASSERT_TRUE(t == 0 || t == 1);
      mean.add(t);
    }
    EXPECT_LT(std::abs(mean.z(std::exp(-kMu * share * kStep_mm * kSteps))), 4) << share;
  }
}

TEST(Stepped, FineStepsAreDeltaTracking) {
  TrackedMedium tracked(make_volume<std::uint8_t>({17, 3, 3}, [](auto i, auto, auto) { return i; }),
                        mu_t_function({{0, 0}, {16, 0.4}}), kGlobal);
  test::Moments transmittance, distance;
  TrackingCounters counters;
  for (std::uint32_t n = 0; n < 100000; ++n) {
    Rng rng(33, 0, 0, n);
    const TrackRay ray{{{0, 1, 1}, {1, 0, 0}}, 0, 8};
    transmittance.add(estimate_transmittance_stepped(tracked.medium, ray, 0.05f, rng, counters));
    const TrackRay whole{{{0, 1, 1}, {1, 0, 0}}, 0, 16};
    const Collision c = sample_free_flight_stepped(tracked.medium, whole, 0.05f, rng, counters);
    distance.add(c.real ? double{c.t_mm} : 16.0);
  }
  // mu_t = t / 40, depth t^2 / 80; the mean of min(t, 16) is the integral of exp(-t^2 / 80).
  EXPECT_LT(std::abs(transmittance.z(std::exp(-0.8), 1e-3)), 4);
  EXPECT_LT(std::abs(distance.z(
                std::sqrt(80.0) * 0.5 * std::sqrt(std::numbers::pi) * std::erf(16 / std::sqrt(80.0)), 0.03)),
            4);
}

TEST(Stepped, NothingIsMetWhereThereIsNothing) {
  TrackedMedium tracked(make_volume<std::uint8_t>({17, 3, 3}, [](auto, auto, auto) { return 0; }),
                        mu_t_function({{0, 0}, {1, 1}}), kGlobal);
  TrackingCounters counters;
  TrackRay ray = along_x();
  ray.u_collision = 0;  // a depth of 0
  Rng rng(34, 0, 0, 0);
  EXPECT_FALSE(sample_free_flight_stepped(tracked.medium, ray, kStep_mm, rng, counters).real);
  EXPECT_EQ(estimate_transmittance_stepped(tracked.medium, ray, kStep_mm, rng, counters), 1);
  ray.t_far = ray.t_near;
  EXPECT_FALSE(sample_free_flight_stepped(homogeneous().medium, ray, kStep_mm, rng, counters).real);
}

}  // namespace
}  // namespace voxlume
