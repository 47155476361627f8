#include <cmath>

#include "tracking/control_walk.h"
#include "tracking/estimators.h"

namespace voxlume {

float estimate_transmittance_residual(const Medium& medium, const TrackRay& track, Rng& rng,
                                      TrackingCounters& counters) noexcept {
  const WalkRay ray = to_walk_ray(medium, track);
  float transmittance = 1;
  float tau = sample_optical_depth(track.u_depth >= 0 ? track.u_depth : rng.next());
  with_walk(medium.accelerator, ray.origin, ray.direction, ray.length_mm, [&](auto& walk) {
    MajorantSegment segment;
    while (walk.next(segment)) {
      const float length_mm = segment.t_far - segment.t_near;
      if (segment.mu_min > 0) {
        transmittance *= std::exp(-segment.mu_min * length_mm);
        if (roulette(transmittance, rng)) return;
      }
      const float rate = segment.mu_maj - segment.mu_min;
      float entered_mm = 0;
      for (;;) {
        const float next_mm = entered_mm + tau / rate;
        if (!(next_mm < length_mm)) break;  // also where nothing varies: next_mm is infinite or NaN
        entered_mm = next_mm;
        ++counters.steps;
        const float mu_t = extinction_at(medium, point_on(ray, segment, segment.t_near + entered_mm));
        transmittance *= 1.0f - residual_share(segment, mu_t, counters);
        if (roulette(transmittance, rng)) return;
        tau = sample_optical_depth(rng.next());
      }
      tau = std::max(0.0f, tau - (length_mm - entered_mm) * rate);
    }
  });
  return transmittance;
}

Collision sample_free_flight_decomposed(const Medium& medium, const TrackRay& track, Rng& rng,
                                        TrackingCounters& counters) noexcept {
  const WalkRay ray = to_walk_ray(medium, track);
  float tau = sample_optical_depth(track.u_depth >= 0 ? track.u_depth : rng.next());
  float control_tau = -1;  // drawn where the control begins
  Collision collision;
  with_walk(medium.accelerator, ray.origin, ray.direction, ray.length_mm, [&](auto& walk) {
    MajorantSegment segment;
    const auto collide = [&](float t, Vec3f p_index, float value) {
      collision = {true, track.t_near + t, p_index, value};
    };
    while (walk.next(segment)) {
      const float length_mm = segment.t_far - segment.t_near;
      float control_mm = std::numeric_limits<float>::infinity();
      if (segment.mu_min > 0) {
        if (control_tau < 0) control_tau = sample_optical_depth(rng.next());
        control_mm = control_tau / segment.mu_min;
        control_tau = std::max(0.0f, control_tau - length_mm * segment.mu_min);
      }
      const float end_mm = std::min(length_mm, control_mm);
      const float rate = segment.mu_maj - segment.mu_min;
      float entered_mm = 0;
      for (;;) {
        const float next_mm = entered_mm + tau / rate;
        if (!(next_mm < end_mm)) break;  // also where nothing varies: next_mm is infinite or NaN
        entered_mm = next_mm;
        ++counters.steps;
        const float t = segment.t_near + entered_mm;
        const Vec3f p = point_on(ray, segment, t);
        const float value = sample_trilinear(medium.grid, p);
        const float share = residual_share(segment, classify_mu_t(medium.transfer, value), counters);
        if (rng.next() < share) return collide(t, p, value);
        tau = sample_optical_depth(rng.next());
      }
      if (control_mm < length_mm) {
        ++counters.steps;  // what is hit has to be known
        const float t = segment.t_near + control_mm;
        const Vec3f p = point_on(ray, segment, t);
        return collide(t, p, sample_trilinear(medium.grid, p));
      }
      tau = std::max(0.0f, tau - (length_mm - entered_mm) * rate);
    }
  });
  return collision;
}

}  // namespace voxlume
