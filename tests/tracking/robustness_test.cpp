#include <gtest/gtest.h>

#include <set>

#include "support/moments.h"
#include "support/random_direction.h"
#include "tracked_medium.h"

namespace voxlume {
namespace {

using test::kGlobal;
using test::make_volume;
using test::mu_t_function;
using test::TrackedMedium;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(Tracking, NothingVisibleTakesNoStep) {
  for (const int c : {1, 4, kGlobal}) {
    const TrackedMedium tracked(test::noise_volume<std::int16_t>({9, 9, 9}, 0, 1000, 81),
                                mu_t_function({{2000, 0}, {3000, 1}}), c);
    TrackingCounters counters;
    Rng rng(1, 0, 0, 0);
    const IndexRay ray{{-0.5f, 3, 4}, {1, 0.1f, 0.2f}};
    EXPECT_FALSE(sample_free_flight(tracked.medium, {ray, 0, 9}, rng, counters).real);
    EXPECT_EQ(estimate_transmittance(tracked.medium, {ray, 0, 9}, rng, counters), 1.0f);
    EXPECT_EQ(counters.steps, 0u);
  }
}

TEST(Tracking, EmptyIntervals) {
  const TrackedMedium tracked(test::noise_volume<std::uint8_t>({9, 9, 9}, 82), mu_t_function({{0, 100}}), 4);
  TrackingCounters counters;
  for (const auto& [a, b] : {std::pair{1.0f, 1.0f}, std::pair{3.0f, 1.0f}, std::pair{kNaN, 1.0f}}) {
    Rng rng(2, 0, 0, 0);
    const Collision collision =
        sample_free_flight(tracked.medium, {{{0, 1, 1}, {1, 0, 0}}, a, b}, rng, counters);
    EXPECT_FALSE(collision.real);
    EXPECT_EQ(collision.t_mm, kInfinity);
    EXPECT_EQ(estimate_transmittance(tracked.medium, {{{0, 1, 1}, {1, 0, 0}}, a, b}, rng, counters), 1.0f);
  }
  EXPECT_EQ(counters.steps, 0u);
}

TEST(Tracking, OpaqueMatterStopsAtItsFace) {
  const TrackedMedium tracked(make_volume<std::uint8_t>({9, 9, 9}, [](auto, auto, auto) { return 1; }),
                              mu_t_function({{0, 1e6}}), 4);
  TrackingCounters counters;
  for (std::uint32_t n = 0; n < 1000; ++n) {
    Rng rng(3, 0, 0, n);
    const Collision collision =
        sample_free_flight(tracked.medium, {{{-0.5f, 4, 4}, {1, 0, 0}}, 0, 9}, rng, counters);
    ASSERT_TRUE(collision.real);
    ASSERT_LT(collision.t_mm, 1e-4f);
    ASSERT_EQ(estimate_transmittance(tracked.medium, {{{-0.5f, 4, 4}, {1, 0, 0}}, 0, 9}, rng, counters),
              0.0f);
  }
}

TEST(Tracking, NaNVoxelsAreTransparent) {
  // The voxels at x = 3..5 are NaN: nothing of [2,6] is visible. 6 mm of 10 remain.
  const TrackedMedium tracked(
      make_volume<float>({10, 3, 3}, [](auto i, auto, auto) { return i >= 3 && i <= 5 ? kNaN : 1.0f; }),
      mu_t_function({{0, 0.2}}), 2);
  test::Moments ratio, survived;
  TrackingCounters counters;
  for (std::uint32_t n = 0; n < 100000; ++n) {
    Rng rng(4, 0, 0, n);
    const IndexRay ray{{-0.5f, 1, 1}, {1, 0, 0}};
    ratio.add(estimate_transmittance(tracked.medium, {ray, 0, 10}, rng, counters));
    const Collision collision = sample_free_flight(tracked.medium, {ray, 0, 10}, rng, counters);
    ASSERT_FALSE(std::isnan(collision.value));
    ASSERT_TRUE(!collision.real || collision.p_index.x <= 2 || collision.p_index.x >= 6);
    survived.add(collision.real ? 0 : 1);
  }
  EXPECT_LT(std::abs(ratio.z(std::exp(-1.2), 1e-5)), 4) << ratio.mean();
  EXPECT_LT(std::abs(survived.z(std::exp(-1.2), 1e-5)), 4) << survived.mean();
}

TEST(Tracking, AnyRayAnyFieldStaysInRange) {
  Rng rng(5, 0, 0, 0);
  for (const test::Size3& size :
       {test::Size3{3, 5, 7}, test::Size3{1, 1, 1}, test::Size3{12, 7, 1}, test::Size3{20, 18, 16}})
    for (const int c : {1, 3, 4, kGlobal}) {
      const TrackedMedium tracked(
          test::noise_volume<std::int16_t>(size, -1000, 3000, 83, test::placements()[3]),
          mu_t_function(test::random_curve(-1000, 3000, 2, 30, rng)), c);
      const Box3d bounds = world_bounds(tracked.volume);
      TrackingCounters counters;
      for (int n = 0; n < 5000; ++n) {
        Vec3f direction = test::random_direction(rng);
        if (n % 4 == 0)
          direction =
              Vec3f(tracked.medium.grid.world_from_index.vector(Vec3f(n % 3 == 0, n % 3 == 1, n % 3 == 2)));
        direction = normalize(direction);
        const Vec3f inside =
            Vec3f(bounds.lower + bounds.extent() * Vec3d(rng.next(), rng.next(), rng.next()));
        const IndexRay ray =
            to_index_ray(tracked.medium.grid, inside - direction * (n % 2 ? 300.0f : 0.0f), direction);
        const Interval<float> run = tracked.inside(ray);
        if (run.empty()) continue;
        const float t = estimate_transmittance(tracked.medium, {ray, run.t_near, run.t_far}, rng, counters);
        ASSERT_TRUE(t >= 0 && t <= 1);
        const Collision collision =
            sample_free_flight(tracked.medium, {ray, run.t_near, run.t_far}, rng, counters);
        if (!collision.real) continue;
        ASSERT_TRUE(collision.t_mm >= run.t_near && collision.t_mm <= run.t_far);
        ASSERT_TRUE(tracked.medium.grid.index_box().contains(collision.p_index));
        ASSERT_GT(extinction_at(tracked.medium, collision.p_index), 0);
      }
      EXPECT_EQ(counters.majorant_violations, 0u);
    }
}

TEST(Tracking, StepsAreTheTentativeCollisions) {
  // The number of look-ups of ratio tracking is Poisson with the optical depth of the majorant; off the ray's
  // way lies what makes the majorant 0.5.
  const TrackedMedium tracked(make_volume<std::uint8_t>({9, 9, 9}, [](auto, auto j, auto) { return j == 0; }),
                              mu_t_function({{0, 0}, {1, 0.5}}), kGlobal);
  constexpr double kMean = 8 * 0.5 * 1.0001;
  test::Moments steps, squares;
  for (std::uint32_t n = 0; n < 100000; ++n) {
    TrackingCounters counters;
    Rng rng(6, 0, 0, n);
    estimate_transmittance(tracked.medium, {{{0, 4, 4}, {1, 0, 0}}, 0, 8}, rng, counters);
    steps.add(static_cast<double>(counters.steps));
    squares.add(std::pow(static_cast<double>(counters.steps) - kMean, 2));
  }
  EXPECT_LT(std::abs(steps.z(kMean)), 4) << steps.mean();
  EXPECT_LT(std::abs(squares.z(kMean)), 4) << squares.mean();
}

TEST(Tracking, TighterMajorantsTakeFewerSteps) {
  const auto steps = [](int cell_voxels) {
    const TrackedMedium tracked(
        make_volume<std::uint8_t>({65, 9, 9}, [](auto i, auto, auto) { return i < 8 ? 200 : 2; }),
        mu_t_function({{0, 0}, {255, 2.55}}), cell_voxels);
    TrackingCounters counters;
    for (std::uint32_t n = 0; n < 1000; ++n) {
      Rng rng(7, 0, 0, n);
      estimate_transmittance(tracked.medium, {{{64, 4, 4}, {-1, 0, 0}}, 0, 60}, rng, counters);
    }
    return counters.steps;
  };
  EXPECT_LT(steps(4) * 5, steps(kGlobal));
}

TEST(Tracking, IsAFunctionOfItsRandomStream) {
  const TrackedMedium tracked(test::noise_volume<std::uint8_t>({12, 12, 12}, 84),
                              mu_t_function({{0, 0}, {255, 1}}), 4);
  const IndexRay ray{{-0.5f, 3.2f, 4.1f}, {0.9f, 0.3f, 0.2f}};
  const auto fly = [&](std::uint64_t seed, std::uint32_t frame, std::uint32_t pixel, std::uint32_t sample) {
    TrackingCounters counters;
    Rng rng(seed, frame, pixel, sample);
    return sample_free_flight(tracked.medium, {ray, 0, 12}, rng, counters).t_mm;
  };
  for (std::uint32_t n = 0; n < 1000; ++n) EXPECT_EQ(fly(n, 1, 2, 3), fly(n, 1, 2, 3));
  EXPECT_NE(fly(1, 0, 0, 0), fly(2, 0, 0, 0));
  EXPECT_NE(fly(1, 0, 0, 0), fly(1, 1, 0, 0));
  EXPECT_NE(fly(1, 0, 0, 0), fly(1, 0, 1, 0));
  EXPECT_NE(fly(1, 0, 0, 0), fly(1, 0, 0, 1));
}

TEST(Streams, DifferForEveryDifference) {
  // 2^16 neighbours in seed, frame, pixel and sample: their first 72 bits must all differ.
  std::set<std::array<float, 3>> seen;
  const std::uint64_t seeds[] = {0, 1, 1ull << 32, ~0ull};
  const std::uint32_t frames[] = {0, 1, 2, 1u << 31};
  for (const std::uint64_t seed : seeds)
    for (const std::uint32_t frame : frames)
      for (std::uint32_t pixel = 0; pixel < 64; ++pixel)
        for (std::uint32_t sample = 0; sample < 64; ++sample) {
          Rng rng(seed, frame, pixel, sample);
          const float a = rng.next(), b = rng.next(), c = rng.next();
          seen.insert({a, b, c});
        }
  EXPECT_EQ(seen.size(), 4u * 4 * 64 * 64);
}

}  // namespace
}  // namespace voxlume
