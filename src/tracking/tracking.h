#pragma once
#include <cstdint>
#include <limits>

#include "sampling/logarithm.h"
#include "sampling/rng.h"
#include "tracking/medium.h"

namespace voxlume {

/// What a tracker did, for rates and tests.
struct TrackingCounters {
  std::uint64_t steps = 0;                ///< density look-ups (tentative collisions)
  std::uint64_t majorant_violations = 0;  ///< look-ups above their majorant: 0 unless something is broken
};

/// Where a free flight ends.
struct Collision {
  bool real = false;  ///< false: left the interval without a collision
  float t_mm = std::numeric_limits<float>::infinity();
  Vec3f p_index;
  float value = 0;  ///< interpolated data at p_index
};

/// Delta (Woodcock) tracking on the ray: t has density mu_t(t) T(t). The residual optical depth is
/// carried from cell to cell, which is exact by memorylessness. The flight ends where the transmittance that
/// ratio tracking would estimate falls below a threshold drawn once: the same as deciding at every look-up,
/// with probability mu_t / mu_maj, but so one number, which can be stratified, places the collision.
Collision sample_free_flight(const Medium& medium, const TrackRay& ray, Rng& rng,
                             TrackingCounters& counters) noexcept;

/// Ratio tracking on the ray: an unbiased estimate of the transmittance, in [0, 1]. Below
/// kRouletteTransmittance Russian roulette ends it or raises it back to that.
float estimate_transmittance(const Medium& medium, const TrackRay& ray, Rng& rng,
                             TrackingCounters& counters) noexcept;

constexpr float kRouletteTransmittance = 0.1f;

/// exp(1)-distributed optical depth from a multiple u of 2^-24 in [0,1).
inline float sample_optical_depth(float u) noexcept { return negative_log(1.0f - u); }

/// How many times the majorant's rate the tentative collisions of a ray have, after one in matter and
/// elsewhere. Any rate above the majorant that the ray's past decides is exact.
struct CollisionRates {
  float in_matter, elsewhere;
};

/// Matter is what has more than this share of the majorant.
constexpr float kMatterShare = 0.02f;

/// Fine rays have denser ones: the denser they are, the more their stratified threshold places the collision
/// and the less chance does. 0.77 of the time to the same error in the peer scene, 0.84 with ct-bone.
constexpr CollisionRates collision_rates(bool fine) noexcept {
  return fine ? CollisionRates{4.5f, 1.5f} : CollisionRates{1, 1};
}

/// The transmittance below which a free flight has ended, in (0, 1].
inline float collision_threshold(float u) noexcept { return 1.0f - u; }

}  // namespace voxlume
