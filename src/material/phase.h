#pragma once
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "sampling/warp.h"

namespace voxlume {

// The Henyey-Greenstein phase function, 1/sr; its integral over the sphere is 1 and its mean cosine is g.
// Requires |g| < 1. Everything is written in the versine from the peak (the propagation direction for g >= 0,
// the opposite one for g < 0): the textbook form 1 + g^2 - 2 g c cancels in float where the function is
// largest.

/// p for `versine` = 1 - cosine from the peak, in [0, 2].
inline float phase_hg_from_versine(float versine, float g) noexcept {
  const float a = std::abs(g);
  const float s2 = (1.0f - a) * (1.0f - a) + 2.0f * a * versine;
  return kUniformSpherePdf * (1.0f - a) * (1.0f + a) / (s2 * std::sqrt(s2));
}

/// p for the cosine between the propagation directions before and after; forward peak at 1 for g > 0.
inline float phase_hg(float cos_theta_propagation, float g) noexcept {
  return phase_hg_from_versine(g < 0.0f ? 1.0f + cos_theta_propagation : 1.0f - cos_theta_propagation, g);
}

/// p for unit vectors that both point away from the vertex. More precise than phase_hg of their dot product.
inline float phase_hg_between(Vec3f wo, Vec3f wi, float g) noexcept {
  const Vec3f from_peak = g < 0.0f ? wi - wo : wi + wo;
  return phase_hg_from_versine(0.5f * dot(from_peak, from_peak), g);
}

/// Samples p exactly (pdf = value). `direction_in` is the propagation direction, -wo; the result, wi, is
/// unit.
inline Vec3f sample_hg(Vec3f direction_in, float g, float u0, float u1) noexcept {
  // Inverting the distribution for s = sqrt(1 + g^2 - 2 g c) = (1 - g^2) / t with t = 1 - g + 2 g u gives
  // 1 - c = 2 (1-g)^2 (1-u) (1 + g u) / t^2, which needs no special case at g = 0.
  const float a = std::abs(g);
  const float r = (1.0f - a) / (1.0f - a + 2.0f * a * u0);
  const float versine = 2.0f * r * r * (1.0f - u0) * (1.0f + a * u0);
  const Frame frame(g < 0.0f ? -direction_in : direction_in);
  return frame.to_world(direction_from_versine(versine, u1));
}

}  // namespace voxlume
