#include <gtest/gtest.h>

#include "support/moments.h"
#include "support/random_direction.h"
#include "tracked_medium.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::identity_function;
using test::kGlobal;
using test::make_volume;
using test::mu_t_function;
using test::TrackedMedium;

constexpr int kSamples = 100000;

/// z-tests of ratio tracking's mean and of the share of free flights that survive, against a known
/// transmittance.
void expect_transmittance(const TrackedMedium& tracked, const IndexRay& ray, Interval<float> run,
                          double expected, int samples = kSamples) {
  test::Moments ratio, survived;
  TrackingCounters counters;
  for (int n = 0; n < samples; ++n) {
    Rng rng(61, 0, 0, static_cast<std::uint32_t>(n)), other(62, 0, 0, static_cast<std::uint32_t>(n));
    const float t = estimate_transmittance(tracked.medium, {ray, run.t_near, run.t_far}, rng, counters);
    ASSERT_TRUE(t >= 0 && t <= 1);
    ratio.add(t);
    const Collision collision =
        sample_free_flight(tracked.medium, {ray, run.t_near, run.t_far}, other, counters);
    ASSERT_TRUE(!collision.real || (collision.t_mm >= run.t_near && collision.t_mm <= run.t_far));
    survived.add(collision.real ? 0 : 1);
  }
  // A float's product of up to 100 factors.
  EXPECT_LT(std::abs(ratio.z(expected, 1e-5 * expected)), 4) << ratio.mean() << " expected " << expected;
  EXPECT_LT(std::abs(survived.z(expected, 1e-5 * expected)), 4)
      << survived.mean() << " expected " << expected;
  EXPECT_EQ(counters.majorant_violations, 0u);
}

class Transmittance : public testing::TestWithParam<int> {};

TEST_P(Transmittance, Constant) {
  for (const double tau : {0.01, 0.7, 3.0}) {
    // 10 voxels of 0.5 mm; the domain is 5 mm long.
    const TrackedMedium tracked(make_volume<std::uint8_t>({10, 4, 4}, [](auto, auto, auto) { return 9; },
                                                          {{0.5, 0.5, 0.5}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}),
                                mu_t_function({{0, tau / 5}}), GetParam());
    const IndexRay ray = to_index_ray(tracked.medium.grid, {-20, 0.5f, 0.6f}, {1, 0, 0});
    const Interval<float> run = tracked.inside(ray);
    EXPECT_NEAR(run.t_near, 19.75, 1e-4);
    EXPECT_NEAR(run.t_far, 24.75, 1e-4);
    expect_transmittance(tracked, ray, run, std::exp(-tau));
  }
}

TEST_P(Transmittance, Linear) {
  const TrackedMedium tracked(make_volume<std::uint16_t>({17, 3, 3}, [](auto i, auto, auto) { return i; }),
                              mu_t_function({{0, 0}, {16, 0.4}}), GetParam());
  // mu_t = x / 40 between the outermost voxel centres: tau over [a,b] is (b^2 - a^2) / 80.
  const IndexRay ray{{0, 1, 1}, {1, 0, 0}};
  expect_transmittance(tracked, ray, {0, 16}, std::exp(-256.0 / 80));
  expect_transmittance(tracked, ray, {3.5f, 9.25f}, std::exp(-(9.25 * 9.25 - 3.5 * 3.5) / 80));
  const IndexRay back{{16, 1, 1}, {-1, 0, 0}};
  expect_transmittance(tracked, back, {2, 13}, std::exp(-(14.0 * 14 - 3 * 3) / 80));
}

TEST_P(Transmittance, Oscillating) {
  // 4 t^2 + 3 (1/2 + 1/2 sin 20 t) on [0,1] mm, in 1025 voxels.
  const double spacing = 1.0 / 1024;
  const auto mu_t = [](double t) { return 4 * t * t + 3 * (0.5 + 0.5 * std::sin(20 * t)); };
  const TrackedMedium tracked(
      make_volume<float>({1025, 1, 1}, [&](auto i, auto, auto) { return mu_t(i * spacing); },
                         {{spacing, 1, 1}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}),
      identity_function(10), GetParam() == kGlobal ? kGlobal : GetParam() * 32);
  double tau = 0;  // the interpolated field's integral is the trapezoidal rule
  for (int i = 0; i < 1024; ++i) tau += 0.5 * spacing * (mu_t(i * spacing) + mu_t((i + 1) * spacing));
  EXPECT_NEAR(std::exp(-tau), 0.056262, 1e-6);
  expect_transmittance(tracked, to_index_ray(tracked.medium.grid, {0, 0, 0}, {1, 0, 0}), {0, 1},
                       std::exp(-tau));
}

TEST_P(Transmittance, Checkerboard) {
  // Voxels of 0 and 1, cut at one half: cubes of mu_t 0 and 0.6, each one voxel wide along the axes.
  const CurvePoints points{{0, 0}, {0.5, 0}, {0.5, 0.6}, {1, 0.6}};
  const TrackedMedium tracked(
      make_volume<std::uint8_t>({13, 12, 11}, [](auto i, auto j, auto k) { return (i + j + k) % 2; }),
      mu_t_function(points), GetParam());
  const IndexRay ray{{-0.5f, 4, 5}, {1, 0, 0}};
  expect_transmittance(tracked, ray, tracked.inside(ray),
                       std::exp(-0.6 * 7));  // 7 of the 13 voxels at (i,4,5) are 1
  const Vec3f direction = normalize(Vec3f(0.6f, -0.5f, 0.4f));
  const IndexRay oblique{{1.2f, 10.4f, 0.7f}, direction};
  const Interval<float> run = tracked.inside(oblique);
  const double tau = test::reference_optical_depth<std::uint8_t>(tracked.volume, points, oblique, run.t_near,
                                                                 run.t_far, 200000);
  expect_transmittance(tracked, oblique, run, std::exp(-tau));
}

TEST_P(Transmittance, NoiseAtAnyAngle) {
  const CurvePoints points{{-500, 0.01}, {0, 0.1}, {0, 0},      {10, 0},
                           {12, 0.9},    {14, 0},  {400, 0.05}, {900, 0.3}};
  const TrackedMedium tracked(
      test::noise_volume<std::int16_t>({14, 11, 9}, -600, 1000, 63, test::placements()[3]),
      mu_t_function(points), GetParam());
  const Vec3d center = world_from_index(tracked.volume).point({6.5, 5, 4});
  Rng rng(64, 0, 0, 0);
  for (int n = 0; n < 2; ++n) {
    const Vec3f direction = test::random_direction(rng);
    const IndexRay ray = to_index_ray(tracked.medium.grid, Vec3f(center) - direction * 40.0f, direction);
    const Interval<float> run = tracked.inside(ray);
    const double tau = test::reference_optical_depth<std::int16_t>(tracked.volume, points, ray, run.t_near,
                                                                   run.t_far, 100000);
    ASSERT_GT(tau, 0.3);
    expect_transmittance(tracked, ray, run, std::exp(-tau));
  }
}

TEST_P(Transmittance, SpikeBetweenTwoVoxelValues) {
  // Neither voxel value is visible; a thin sheet between them is: data rises by 100 a mm, the needle is 2
  // wide.
  const TrackedMedium tracked(
      make_volume<std::uint8_t>({9, 3, 3}, [](auto i, auto, auto) { return i < 4 ? 0 : 100; }),
      mu_t_function({{49, 0}, {50, 60}, {51, 0}}), GetParam());
  expect_transmittance(tracked, {{0, 1, 1}, {1, 0, 0}}, {3, 4.5f}, std::exp(-60 * 0.01));
}

TEST_P(Transmittance, ParallelToFacesAndOnThem) {
  const TrackedMedium tracked(make_volume<std::uint8_t>({9, 9, 9}, [](auto, auto, auto) { return 1; }),
                              mu_t_function({{0, 0.1}}), GetParam());
  for (const float at : {-0.5f, 0.0f, 4.0f, 8.0f, 8.5f})
    for (int a = 0; a < 3; ++a)
      for (const float sign : {1.0f, -1.0f}) {
        IndexRay ray{Vec3f(at), Vec3f(0)};
        ray.origin_index[a] = sign > 0 ? -0.5f : 8.5f;
        ray.direction_index[a] = sign;
        expect_transmittance(tracked, ray, tracked.inside(ray), std::exp(-0.9), 20000);
      }
}
INSTANTIATE_TEST_SUITE_P(CellSizes, Transmittance, testing::Values(1, 4, kGlobal));

TEST(Transmittances, SmallOnesAreUnbiasedUnderRoulette) {
  // The transmittance is below kRouletteTransmittance; a face off the ray's way makes the majorant twice
  // mu_t.
  const TrackedMedium tracked(
      make_volume<std::uint8_t>({10, 9, 3}, [](auto, auto j, auto) { return j ? 1 : 2; }),
      mu_t_function({{0, 0}, {2, 2}}), kGlobal);
  test::Moments ratio;
  TrackingCounters counters;
  for (int n = 0; n < 1200000; ++n) {
    Rng rng(65, 0, 0, static_cast<std::uint32_t>(n));
    ratio.add(estimate_transmittance(tracked.medium, {{{0, 5, 1}, {1, 0, 0}}, 0, 9}, rng, counters));
  }
  EXPECT_LT(std::abs(ratio.z(std::exp(-9.0))), 4) << ratio.mean();
  EXPECT_LT(ratio.standard_error(), 0.03 * std::exp(-9.0));
}

TEST(Transmittances, ShadowsMeetAShareOfTheExtinction) {
  const TrackedMedium tracked(test::noise_volume<std::uint8_t>({12, 9, 9}, 0, 200, 13),
                              mu_t_function({{0, 0}, {200, 2}}), 4);
  const IndexRay ray{{-0.5f, 4.3f, 4.7f}, {1, 0.05f, 0.1f}};
  const Interval<float> run = tracked.inside(ray);
  const double tau = test::reference_optical_depth<std::uint8_t>(tracked.volume, {{0, 0}, {200, 2}}, ray,
                                                                 run.t_near, run.t_far, 20000);
  for (const float share : {1.0f, 0.3f, 0.02f}) {
    Medium medium = tracked.medium;
    medium.shadow_extinction = share;
    test::Moments ratio;
    TrackingCounters counters, plain;
    for (int n = 0; n < kSamples; ++n) {
      Rng rng(64, 0, 0, static_cast<std::uint32_t>(n)), flight(65, 0, 0, static_cast<std::uint32_t>(n));
      Rng same = flight;
      const TrackRay track{ray, run.t_near, run.t_far};
      ratio.add(estimate_transmittance(medium, track, rng, counters));
      // Free flights know nothing of it.
      const Collision a = sample_free_flight(medium, track, flight, plain),
                      b = sample_free_flight(tracked.medium, track, same, plain);
      ASSERT_EQ(a.real, b.real);
      ASSERT_EQ(a.t_mm, b.t_mm);
    }
    const double expected = std::exp(-tau * static_cast<double>(share));
    EXPECT_LT(std::abs(ratio.z(expected, 1e-5 * expected)), 4) << ratio.mean() << " expected " << expected;
    EXPECT_EQ(counters.majorant_violations, 0u);
  }
}

TEST(Transmittances, DistanceToTheEyeDoesNotMatter) {
  // One opaque corner makes the majorant 10000 times the extinction on the ray; 500 mm away floats are 3e-5
  // apart.
  const TrackedMedium tracked(
      make_volume<float>({3, 3, 3}, [](auto i, auto j, auto k) { return i + j + k == 6 ? 1e4 : 1.0; },
                         {{0.5, 0.5, 0.5}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}}),
      identity_function(1e4), kGlobal);
  const IndexRay ray = to_index_ray(tracked.medium.grid, {-500, 0.25f, 0.25f}, {1, 0, 0});
  expect_transmittance(tracked, ray, {500, 501}, std::exp(-1), 500);
}

}  // namespace
}  // namespace voxlume
