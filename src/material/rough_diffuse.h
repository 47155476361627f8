#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "sampling/warp.h"

namespace voxlume {

// Rough diffuse reflection: Fujii's simplification of Oren and Nayar's, "FON" in Portsmouth et al. 2025,
// "EON: A practical energy-preserving rough diffuse BRDF": f ~ 1 + r s/t with s = wo.wi - cos_o cos_i, t =
// max(cos_o, cos_i) for s > 0, else 1. Roughness r in [0,1]; 0 is Lambert's. All directions are on the
// normal's side.

/// The integral over wi of (1 + r s/t) cos_i / pi: FON's albedo but for its constant factor. At least 1.
inline float rough_diffuse_albedo(float cos_o, float roughness) noexcept {
  const float sine = std::sqrt(std::max(0.0f, (1.0f - cos_o) * (1.0f + cos_o)));
  // sin/cos (1 - sin^3) = sin cos (1 + sin + sin^2) / (1 + sin)
  const float last = sine * cos_o * (1.0f + sine + sine * sine) / (1.0f + sine) - sine;
  const float g = sine * (std::acos(std::min(cos_o, 1.0f)) - sine * cos_o) + (2.0f / 3.0f) * last;
  return 1.0f + roughness * std::numbers::inv_pi_v<float> * g;
}

/// (1 + r s/t) cos_i / pi.
inline float eval_rough_diffuse(float cos_o, float cos_i, float cos_between, float roughness) noexcept {
  const float s = cos_between - cos_o * cos_i;
  const float t = s > 0.0f ? std::max(cos_o, cos_i) : 1.0f;
  return cosine_hemisphere_pdf(cos_i) * std::max(0.0f, 1.0f + roughness * s / t);
}

/// The share of directions drawn evenly over the hemisphere, the others by their cosine: near grazing f grows
/// with 1 / cos_i.
inline float even_share(float cos_o, float roughness) noexcept { return 0.5f * roughness * (1.0f - cos_o); }

/// Draws wi about +z.
inline Vec3f sample_rough_diffuse(float even, float u_lobe, float u0, float u1) noexcept {
  return u_lobe < even ? uniform_cone(1.0f, u0, u1) : cosine_hemisphere(u0, u1);
}

/// Density of sample_rough_diffuse, 1/sr; cos_i > 0.
inline float rough_diffuse_pdf(float even, float cos_i) noexcept {
  return even * (0.5f * std::numbers::inv_pi_v<float>)+(1.0f - even) * cosine_hemisphere_pdf(cos_i);
}

}  // namespace voxlume
