#pragma once
#include "base/assert.h"
#include "tracking/tracking.h"

namespace voxlume {

/// Looks the data up at the tentative collisions of a ray, a Poisson process of at least the majorant's rate,
/// both times `extinction`. `visit(t, p_index, value, share)`, share being mu_t over that rate, returns true
/// to stop.
template <class Visit>
void visit_tentative_collisions(const Medium& medium, const TrackRay& track, float extinction, Rng& rng,
                                TrackingCounters& counters, Visit&& visit) noexcept {
  const IndexRay& ray = track.ray;
  const float t_near = track.t_near, t_far = track.t_far;
  CollisionRates rates = collision_rates(track.fine);
  rates = {rates.in_matter * extinction, rates.elsewhere * extinction};
  float rate = rates.elsewhere;
  float tau = sample_optical_depth(track.u_depth >= 0 ? track.u_depth : rng.next());
  // From here on distances are counted from where the ray enters: far from the eye, t is coarser.
  const Box3f domain = medium.grid.index_box();
  const Vec3f origin = min(max(ray.origin_index + ray.direction_index * t_near, domain.lower), domain.upper);
  with_walk(medium.accelerator, origin, ray.direction_index, t_far - t_near, [&](auto& walk) {
    MajorantSegment segment;
    while (walk.next(segment)) {
      float mu_maj = segment.mu_maj * rate;
      const float length_mm = segment.t_far - segment.t_near;
      float entered_mm = 0;
      for (;;) {
        const float next_mm = entered_mm + tau / mu_maj;
        if (!(next_mm < length_mm)) break;  // also without extinction, where next_mm is infinite or NaN
        entered_mm = next_mm;
        const float t = segment.t_near + entered_mm;
        const Vec3f on_ray = origin + ray.direction_index * t;
        const Vec3f p = min(max(on_ray, segment.cell.lower), segment.cell.upper);
        ++counters.steps;
        const float value = sample_trilinear(medium.grid, p);
        const float mu_t = extinction_of(medium, p, value);
        VOXLUME_ASSERT_LE(mu_t, segment.mu_maj);
        counters.majorant_violations += mu_t > segment.mu_maj;
        if (visit(t_near + t, p, value, mu_t * extinction / mu_maj)) return;
        rate = mu_t > segment.mu_maj * kMatterShare ? rates.in_matter : rates.elsewhere;
        mu_maj = segment.mu_maj * rate;
        tau = sample_optical_depth(rng.next());
      }
      const float left = tau - (length_mm - entered_mm) * mu_maj;
      tau = left > 0 ? left : 0;
    }
  });
}

}  // namespace voxlume
