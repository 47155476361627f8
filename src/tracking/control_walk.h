#pragma once
#include <algorithm>

#include "base/assert.h"
#include "tracking/tracking.h"

namespace voxlume {

/// A ray to walk along, counted from where it enters, as the walks expect it.
struct WalkRay {
  Vec3f origin, direction;  ///< index space; per mm
  float length_mm;
};

inline WalkRay to_walk_ray(const Medium& medium, const TrackRay& track) noexcept {
  const Box3f domain = medium.grid.index_box();
  const Vec3f from = track.ray.origin_index + track.ray.direction_index * track.t_near;
  return {min(max(from, domain.lower), domain.upper), track.ray.direction_index, track.t_far - track.t_near};
}

/// The point `t` mm along the ray, kept inside the segment's cell.
inline Vec3f point_on(const WalkRay& ray, const MajorantSegment& segment, float t) noexcept {
  return min(max(ray.origin + ray.direction * t, segment.cell.lower), segment.cell.upper);
}

/// The share of what the control leaves over, (mu_t - mu_min) / (mu_maj - mu_min), in [0, 1]; the segment's
/// majorant must be above its minimum.
inline float residual_share(const MajorantSegment& segment, float mu_t, TrackingCounters& counters) noexcept {
  VOXLUME_ASSERT_LE(mu_t, segment.mu_maj);
  VOXLUME_ASSERT_LE(segment.mu_min, mu_t);
  counters.majorant_violations += mu_t > segment.mu_maj || mu_t < segment.mu_min;
  return std::clamp((mu_t - segment.mu_min) / (segment.mu_maj - segment.mu_min), 0.0f, 1.0f);
}

/// Ends an estimate below kRouletteTransmittance, or raises it back to that; true when it has ended.
inline bool roulette(float& transmittance, Rng& rng) noexcept {
  const float size = std::abs(transmittance);
  if (size >= kRouletteTransmittance) return false;
  const bool dies = rng.next() * kRouletteTransmittance >= size;
  transmittance = dies ? 0.0f : std::copysign(kRouletteTransmittance, transmittance);
  return dies;
}

}  // namespace voxlume
