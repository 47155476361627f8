#pragma once
#include <bit>
#include <cstdint>
#include <limits>

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
/// carried from cell to cell, which is exact by memorylessness. Draws two numbers per look-up, and one more
/// at the start.
Collision sample_free_flight(const Medium& medium, const TrackRay& ray, Rng& rng,
                             TrackingCounters& counters) noexcept;

/// Ratio tracking on the ray: an unbiased estimate of the transmittance, in [0, 1]. Below
/// kRouletteTransmittance Russian roulette ends it or raises it back to that.
float estimate_transmittance(const Medium& medium, const TrackRay& ray, Rng& rng,
                             TrackingCounters& counters) noexcept;

constexpr float kRouletteTransmittance = 1e-3f;

// log(1 + f) = f - f^2/2 + f^3 * polynomial for f in [sqrt(1/2) - 1, sqrt(2) - 1]; ln 2 in two parts.
inline constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3;
inline constexpr float kLogPolynomial[9] = {7.0376836292e-2f,  -1.1514610310e-1f, 1.1676998740e-1f,
                                            -1.2420140846e-1f, 1.4249322787e-1f,  -1.6668057665e-1f,
                                            2.0000714765e-1f,  -2.4999993993e-1f, 3.3333331174e-1f};
inline constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;

/// exp(1)-distributed optical depth from a multiple u of 2^-24 in [0,1): -log(1 - u) by the polynomial of
/// Cephes' logf (Moshier 1992), to 2 ulp. The vector tracker does the same arithmetic.
inline float sample_optical_depth(float u) noexcept {
  const auto bits = std::bit_cast<std::int32_t>(1.0f - u);
  const std::int32_t exponent = (bits - kSqrtHalfBits) >> 23;
  const float f = std::bit_cast<float>(bits - (exponent << 23)) - 1.0f;
  float p = kLogPolynomial[0];
  for (int i = 1; i < 9; ++i) p = p * f + kLogPolynomial[i];
  const float f2 = f * f, e = static_cast<float>(exponent);
  const float tail = (p * f) * f2 + e * kLn2Low - 0.5f * f2;
  const float log = (tail + f) + e * kLn2High;
  return 0.0f - log;
}

}  // namespace voxlume
