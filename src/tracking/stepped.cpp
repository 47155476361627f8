#include <algorithm>

#include "tracking/estimators.h"

namespace voxlume {
namespace {

/// Looks the data up every step_mm along the ray, from a place in the first step that is drawn.
/// `visit(t, p_index, value, depth)`, depth being what the step has, returns true to stop.
template <class Visit>
void visit_steps(const Medium& medium, const TrackRay& track, float step_mm, Rng& rng,
                 TrackingCounters& counters, Visit&& visit) noexcept {
  const Box3f domain = medium.grid.index_box();
  const float start = track.t_near + step_mm * (track.u_depth >= 0 ? track.u_depth : rng.next());
  for (std::int64_t i = 0;; ++i) {
    const float t = start + static_cast<float>(i) * step_mm;
    if (!(t < track.t_far)) return;
    const Vec3f on_ray = track.ray.origin_index + track.ray.direction_index * t;
    const Vec3f p = min(max(on_ray, domain.lower), domain.upper);
    const float value = sample_trilinear(medium.grid, p);
    ++counters.steps;
    if (visit(t, p, value, extinction_of(medium, p, value) * step_mm)) return;
  }
}

}  // namespace

Collision sample_free_flight_stepped(const Medium& medium, const TrackRay& ray, float step_mm, Rng& rng,
                                     TrackingCounters& counters) noexcept {
  Collision collision;
  float left = negative_log(collision_threshold(ray.u_collision >= 0 ? ray.u_collision : rng.next()));
  visit_steps(medium, ray, step_mm, rng, counters, [&](float t, Vec3f p_index, float value, float depth) {
    left -= depth;
    if (!(depth > 0 && left <= 0)) return false;
    collision = {true, t, p_index, value};
    return true;
  });
  return collision;
}

float estimate_transmittance_stepped(const Medium& medium, const TrackRay& ray, float step_mm, Rng& rng,
                                     TrackingCounters& counters) noexcept {
  float left = sample_optical_depth(rng.next());
  bool blocked = false;
  visit_steps(medium, ray, step_mm, rng, counters, [&](float, Vec3f, float, float depth) {
    left -= depth * medium.shadow_extinction;
    return blocked = depth > 0 && left <= 0;
  });
  return blocked ? 0.0f : 1.0f;
}

}  // namespace voxlume
