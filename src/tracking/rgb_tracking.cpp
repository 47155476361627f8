#include "tracking/rgb_tracking.h"

#include "tracking/tentative_collisions.h"

namespace voxlume {
namespace {

/// A channel that carries less of the throughput than this is given up: its weight could exceed a float.
constexpr float kLeastShare = 1e-20f;

Vec3f extinction_color_of(const Medium& medium, Vec3f p_index, float value) noexcept {
  return medium.rules.rule_count == 0 ? extinction_color_at(medium.extinction_color, value)
                                      : classify(medium.rules, p_index, value).extinction_color();
}

}  // namespace

RgbFlight sample_rgb_flight(const Medium& medium, const TrackRay& ray, Vec3f throughput, Rng& rng,
                            TrackingCounters& counters) noexcept {
  RgbFlight flight{{}, Vec3f(1)};
  Vec3f carried = throughput / (throughput.x + throughput.y + throughput.z);
  for (int c = 0; c < 3; ++c)
    if (!(carried[c] > kLeastShare)) carried[c] = flight.weight[c] = 0;
  const auto go_on = [&](Vec3f probability, float mean) {
    const Vec3f weight = probability * (1 / mean);
    flight.weight *= weight;
    carried *= weight;
  };
  const float threshold = collision_threshold(ray.u_collision >= 0 ? ray.u_collision : rng.next());
  // As sample_free_flight: that the flight has ended is as probable as the transmittance has fallen, whatever
  // its past makes the probability at the next look-up.
  float transmittance = 1;
  visit_tentative_collisions(medium, ray, 1, rng, counters,
                             [&](float t, Vec3f p_index, float value, float share) {
                               if (!(share > 0)) return false;
                               const Vec3f real = extinction_color_of(medium, p_index, value) * share;
                               // Not 1 - dot(carried, real): rounding would cost what little of a channel is
                               // left at a majorant that the extinction reaches.
                               const Vec3f null = Vec3f(1) - real;
                               const float null_mean = dot(carried, null);
                               transmittance *= null_mean;
                               if (!(transmittance < threshold)) {
                                 go_on(null, null_mean);
                                 return false;
                               }
                               const float real_mean = dot(carried, real);
                               if (!(real_mean > 0)) return false;
                               go_on(real, real_mean);
                               flight.collision = {true, t, p_index, value};
                               return true;
                             });
  return flight;
}

Vec3f estimate_rgb_transmittance(const Medium& medium, const TrackRay& ray, Rng& rng,
                                 TrackingCounters& counters) noexcept {
  Vec3f transmittance(1);
  const auto visit = [&](float, Vec3f p_index, float value, float share) {
    if (!(share > 0)) return false;
    transmittance *= Vec3f(1) - extinction_color_of(medium, p_index, value) * share;
    const float most = max_component(transmittance);
    if (most >= kRouletteTransmittance) return false;
    if (rng.next() * kRouletteTransmittance >= most) {
      transmittance = Vec3f(0);
      return true;
    }
    transmittance *= kRouletteTransmittance / most;
    return false;
  };
  visit_tentative_collisions(medium, ray, medium.shadow_extinction, rng, counters, visit);
  return transmittance;
}

}  // namespace voxlume
