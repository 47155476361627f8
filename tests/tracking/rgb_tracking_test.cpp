#include "tracking/rgb_tracking.h"

#include <gtest/gtest.h>

#include "support/moments.h"
#include "tracked_medium.h"

namespace voxlume {
namespace {

using test::Moments;
using test::TrackedMedium;

constexpr int kFlights = 40000;
constexpr double kLength_mm = 14;

/// Noise of extinctions up to 0.25/mm, of one extinction colour.
class RgbTracking : public testing::TestWithParam<Vec3f> {
 protected:
  RgbTracking()
      : tracked_(test::noise_volume<float>({16, 4, 4}, 0, 0.25, 5), test::identity_function(0.25), 4),
        curve_([] {
          std::vector<TransferPoint> points(1);
          points[0].extinction_color = Color{{GetParam().x, GetParam().y, GetParam().z}};
          return points;
        }()) {
    tracked_.medium.extinction_color = curve_.view();
  }

  TrackRay ray() const {
    TrackRay out;
    out.ray = to_index_ray(tracked_.medium.grid, {0.5f, 1.3f, 1.6f}, {1, 0, 0});
    out.t_far = static_cast<float>(kLength_mm);
    return out;
  }
  double depth(double t) const {
    return test::reference_optical_depth<float>(tracked_.volume, {{0, 0}, {0.25, 0.25}}, ray().ray, 0, t,
                                                4000);
  }

  TrackedMedium tracked_;
  ExtinctionColorCurve curve_;
};

TEST_P(RgbTracking, FlightsEndAsEveryChannelsExtinctionSays) {
  const double half = depth(kLength_mm / 2), whole = depth(kLength_mm);
  for (const Vec3f throughput : {Vec3f(1), Vec3f(2, 0, 0), Vec3f(1e-6f, 1, 0.3f), Vec3f(1e-30f, 0, 5)}) {
    for (const bool fine : {false, true}) {
      Moments escaped[3], early[3];
      TrackingCounters counters;
      const float sum = throughput.x + throughput.y + throughput.z;
      for (int n = 0; n < kFlights; ++n) {
        Rng rng(31, 0, fine, static_cast<std::uint32_t>(n));
        TrackRay track = ray();
        track.fine = fine;
        const RgbFlight flight = sample_rgb_flight(tracked_.medium, track, throughput, rng, counters);
        ASSERT_NEAR(dot(flight.weight, throughput) / sum, 1, 1e-4);
        for (int c = 0; c < 3; ++c) {
          ASSERT_TRUE(std::isfinite(flight.weight[c]) && flight.weight[c] >= 0);
          const bool real = flight.collision.real;
          escaped[c].add(real ? 0 : double{flight.weight[c]});
          early[c].add(real && flight.collision.t_mm < kLength_mm / 2 ? double{flight.weight[c]} : 0);
        }
      }
      EXPECT_EQ(counters.majorant_violations, 0u);
      for (int c = 0; c < 3; ++c) {
        SCOPED_TRACE("channel " + std::to_string(c) + " of throughput " + std::to_string(throughput[c]));
        if (!(throughput[c] > 1e-20f * sum)) {
          EXPECT_EQ(escaped[c].mean() + early[c].mean(), 0) << "given up";
        } else if (throughput[c] > 0.01f * sum) {  // weights of less are far from normal
          const double own = GetParam()[c];
          EXPECT_LT(std::abs(escaped[c].z(std::exp(-own * whole), 1e-5)), 4.5);
          EXPECT_LT(std::abs(early[c].z(1 - std::exp(-own * half), 1e-5)), 4.5);
        }
      }
    }
  }
}

TEST_P(RgbTracking, TransmittancesAreEveryChannels) {
  for (const float shadow_extinction : {1.0f, 0.4f}) {
    tracked_.medium.shadow_extinction = shadow_extinction;
    const double tau = depth(kLength_mm) * double{shadow_extinction};
    Moments channels[3];
    TrackingCounters counters;
    for (int n = 0; n < kFlights; ++n) {
      Rng rng(32, 0, 0, static_cast<std::uint32_t>(n));
      const Vec3f transmittance = estimate_rgb_transmittance(tracked_.medium, ray(), rng, counters);
      for (int c = 0; c < 3; ++c) channels[c].add(transmittance[c]);
    }
    for (int c = 0; c < 3; ++c)
      EXPECT_LT(std::abs(channels[c].z(std::exp(-tau * double{GetParam()[c]}), 1e-5)), 4.5) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Colors, RgbTracking,
                         testing::Values(Vec3f(1), Vec3f(0.3f, 0.7f, 1), Vec3f(0, 0.01f, 1), Vec3f(1, 0, 0),
                                         Vec3f(0)));

TEST(ExtinctionColor, IsACurveThroughThePointsThatGiveIt) {
  std::vector<TransferPoint> points(5);
  for (int i = 0; i < 5; ++i) points[i].value = std::array{-10, 0, 10, 10, 20}[i];
  const ExtinctionColorCurve none(points);
  EXPECT_EQ(extinction_color_at(none.view(), 3), Vec3f(1));
  points[0].extinction_color = Color{{0, 1, 0.5f}};
  points[2].extinction_color = Color{{1, 0, 0.5f}};
  points[3].extinction_color = Color{{0.25f, 0.5f, 1}};
  const ExtinctionColorCurve curve(points);
  EXPECT_EQ(extinction_color_at(curve.view(), -1e30f), Vec3f(0, 1, 0.5f));
  EXPECT_EQ(extinction_color_at(curve.view(), -10), Vec3f(0, 1, 0.5f));
  EXPECT_EQ(extinction_color_at(curve.view(), 0), Vec3f(0.5f));
  EXPECT_NEAR(extinction_color_at(curve.view(), std::nextafter(10.0f, 0.0f)).x, 1, 1e-6);
  EXPECT_EQ(extinction_color_at(curve.view(), 10), Vec3f(0.25f, 0.5f, 1));
  EXPECT_EQ(extinction_color_at(curve.view(), 1e30f), Vec3f(0.25f, 0.5f, 1));
}

}  // namespace
}  // namespace voxlume
