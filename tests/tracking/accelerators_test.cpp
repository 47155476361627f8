// Every accelerator, with any parameters, gives the same free flights and transmittances.
#include <gtest/gtest.h>

#include "accel/accelerator.h"
#include "tracked_medium.h"

namespace voxlume {
namespace {

struct Variant {
  std::string name;
  AcceleratorChoice choice;
};

std::vector<Variant> variants() {
  using Kind = AcceleratorKind;
  std::vector<Variant> out{{"skipping octree", {Kind::kSkippingOctree, 2, {}, {}}},
                           {"residency", {Kind::kResidency, 2, {}, {}}},
                           {"residency, large bricks", {Kind::kResidency, 8, {}, {}}},
                           {"macrocells", {Kind::kMacrocell, 3, {}, {}}}};
  for (const float lookup : {0.0f, 0.5f, 2.5f, 20.0f, 1e30f})
    for (const int max_level : {0, 3, 6})
      out.push_back({"cost " + std::to_string(lookup) + ", level " + std::to_string(max_level),
                     {Kind::kHierarchy, 1 + max_level % 2, {lookup, max_level}, {}}});
  for (const OctreeThresholds thresholds :
       {OctreeThresholds{0, 0}, {1e30f, 1e30f}, {0, 1e30f}, {0.1f, 1}, {0.01f, 0.1f}, {1, 10}, {2, 0.5f}})
    out.push_back(
        {"thresholds " + std::to_string(thresholds.climb) + " " + std::to_string(thresholds.descend),
         {Kind::kThresholdOctree, 1, {}, thresholds}});
  return out;
}

class Accelerators : public testing::Test {
 protected:
  static Volume noisy() {
    Rng rng(90, 0, 0, 0);
    return test::make_volume<std::uint8_t>({40, 24, 20}, [&](auto i, auto j, auto k) {
      const float u = rng.next();
      return i < 12 ? 5 : i < 20 ? 90 + 10 * u : (i + j + k) % 16 < 8 ? 250 * u : 40;
    });
  }
  TrackRay ray() const {
    const IndexRay line{{-0.5f, 3.3f, 4.1f}, {0.9f, 0.35f, 0.26f}};
    return {line, 0, tracked.inside(line).t_far};
  }
  /// Calls check(medium, counters) with every accelerator; no look-up may be above its majorant.
  template <class Check>
  void for_every_variant(Check&& check) const {
    for (const Variant& variant : variants()) {
      SCOPED_TRACE(variant.name);
      Accelerator accelerator(tracked.medium.grid, variant.choice);
      accelerator.update(tracked.function);
      TrackingCounters counters;
      check({tracked.medium.grid, tracked.medium.transfer, accelerator.view()}, counters);
      EXPECT_EQ(counters.majorant_violations, 0u);
    }
  }

  const test::CurvePoints points{{10, 0}, {60, 0.01}, {120, 0.05}, {200, 0.05}, {250, 0.6}};
  const test::TrackedMedium tracked{noisy(), test::mu_t_function(points), test::kGlobal};
};

/// One hypothesis a variant and quantity; 5 sigma over all of them.
constexpr double kLargestZ = 5;

TEST_F(Accelerators, GiveTheSameTransmittance) {
  const double expected = std::exp(-test::reference_optical_depth<std::uint8_t>(
      tracked.volume, points, ray().ray, 0, static_cast<double>(ray().t_far), 200000));
  std::uint32_t stream = 0;
  for_every_variant([&](const Medium& medium, TrackingCounters& counters) {
    double sum = 0, sum2 = 0, escaped = 0;
    constexpr int kDraws = 20000;
    for (int n = 0; n < kDraws; ++n) {
      Rng rng(91, 0, ++stream, 0);
      const auto t = static_cast<double>(estimate_transmittance(medium, ray(), rng, counters));
      sum += t;
      sum2 += t * t;
      escaped += !sample_free_flight(medium, ray(), rng, counters).real;
    }
    const double mean = sum / kDraws, error = std::sqrt((sum2 / kDraws - mean * mean) / kDraws);
    EXPECT_LT(std::abs(mean - expected), kLargestZ * error);
    EXPECT_LT(std::abs(escaped / kDraws - expected),
              kLargestZ * std::sqrt(expected * (1 - expected) / kDraws));
  });
}

TEST_F(Accelerators, GiveTheSameFreeFlights) {
  // Mean depth of collisions against quadrature of t mu_t(t) T(t).
  const auto t_far = static_cast<double>(ray().t_far);
  double expected = 0, depth = 0;
  constexpr int kSteps = 4000;
  for (int i = 0; i < kSteps; ++i) {
    const double a = t_far * i / kSteps, b = t_far * (i + 1) / kSteps;
    const double tau =
        test::reference_optical_depth<std::uint8_t>(tracked.volume, points, ray().ray, a, b, 20);
    expected += 0.5 * (a + b) * std::exp(-depth) * -std::expm1(-tau);
    depth += tau;
  }
  const double collided = -std::expm1(-depth);
  std::uint32_t stream = 0;
  for_every_variant([&](const Medium& medium, TrackingCounters& counters) {
    double sum = 0, sum2 = 0;
    int count = 0;
    for (int n = 0; n < 20000; ++n) {
      Rng rng(92, 0, ++stream, 0);
      const Collision c = sample_free_flight(medium, ray(), rng, counters);
      if (!c.real) continue;
      sum += static_cast<double>(c.t_mm);
      sum2 += static_cast<double>(c.t_mm) * static_cast<double>(c.t_mm);
      ++count;
    }
    const double mean = sum / count, error = std::sqrt((sum2 / count - mean * mean) / count);
    EXPECT_LT(std::abs(mean - expected / collided), kLargestZ * error + 1e-3 * t_far / kSteps);
  });
}

TEST_F(Accelerators, NeverLookUpAboveTheirMajorant) {
  std::uint32_t stream = 0;
  for_every_variant([&](const Medium& medium, TrackingCounters& counters) {
    for (int n = 0; n < 20000; ++n) {
      Rng rng(93, 0, ++stream, 0);
      const Vec3f target = test::random_point(tracked.volume, rng);
      Vec3f direction(rng.next() - 0.5f, rng.next() - 0.5f, rng.next() - 0.5f);
      if (n % 4 == 0) direction[n / 4 % 3] = 0;
      const IndexRay line{target - direction * (n % 3 ? 0.0f : 100.0f), direction};
      const Interval<float> run = tracked.inside(line);
      if (run.empty()) continue;
      estimate_transmittance(medium, {line, run.t_near, run.t_far}, rng, counters);
    }
    EXPECT_GT(counters.steps, 10000u);
  });
}

}  // namespace
}  // namespace voxlume
