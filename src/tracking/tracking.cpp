#include "tracking/tracking.h"

#include "tracking/tentative_collisions.h"

namespace voxlume {
Collision sample_free_flight(const Medium& medium, const TrackRay& ray, Rng& rng,
                             TrackingCounters& counters) noexcept {
  Collision collision;
  const float threshold = collision_threshold(ray.u_collision >= 0 ? ray.u_collision : rng.next());
  float transmittance = 1;
  visit_tentative_collisions(medium, ray, 1, rng, counters,
                             [&](float t, Vec3f p_index, float value, float share) {
                               transmittance *= 1.0f - share;
                               if (!(transmittance < threshold)) return false;
                               collision = {true, t, p_index, value};
                               return true;
                             });
  return collision;
}

float estimate_transmittance(const Medium& medium, const TrackRay& ray, Rng& rng,
                             TrackingCounters& counters) noexcept {
  float transmittance = 1;
  const auto visit = [&](float, Vec3f, float, float share) {
    transmittance *= 1.0f - share;
    if (transmittance >= kRouletteTransmittance) return false;
    if (rng.next() * kRouletteTransmittance >= transmittance) {
      transmittance = 0;
      return true;
    }
    transmittance = kRouletteTransmittance;
    return false;
  };
  visit_tentative_collisions(medium, ray, medium.shadow_extinction, rng, counters, visit);
  return transmittance;
}

}  // namespace voxlume
