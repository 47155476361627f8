#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "sampling/warp.h"

namespace voxlume {

// A rough dielectric over a Lambertian base, as one reciprocal BRDF whose albedo never exceeds 1:
//   f = albedo/pi (1 - F(cos_i)) (1 - F(cos_o))  +  D G2 F(cos_d) / (4 cos_i cos_o)
// with the GGX distribution, the height-correlated Smith G2 and Schlick's F. f0 = 0 means no interface: F = 0
// at every angle, so f = albedo/pi. Normals that face away from wo are flipped; wi below the surface gives 0.

/// The smallest alpha; smoother surfaces are rendered with this one.
constexpr float kMinAlpha = 1e-3f;

struct SurfaceLobe {
  Vec3f albedo;  ///< of the base, each in [0,1]
  float alpha;   ///< GGX width, [0,1]
  float f0;      ///< reflectance at normal incidence, [0,1]
};

/// f |cos_i| of the two parts and the density with which sample_surface draws wi, all per steradian.
struct SurfaceValue {
  Vec3f diffuse, specular;
  float pdf;
};

/// A direction with its SurfaceValue. pdf = 0: no direction (the sample fell below the surface).
struct SurfaceSample {
  Vec3f wi;
  Vec3f diffuse, specular;
  float pdf;
};

/// Schlick's approximation; 0 for f0 = 0. Cosine in [0,1].
inline float fresnel_schlick(float f0, float cosine) noexcept {
  if (f0 == 0.0f) return 0.0f;
  const float m = std::clamp(1.0f - cosine, 0.0f, 1.0f);
  const float m2 = m * m;
  return f0 + (1.0f - f0) * m2 * m2 * m;
}

/// An estimate of the reflected part of light leaving along a wo at cos_o: diffuse and specular.
struct SurfaceAlbedo {
  Vec3f diffuse;
  float specular;
};
inline SurfaceAlbedo estimate_albedo(const SurfaceLobe& lobe, float cos_o) noexcept {
  const float fresnel = fresnel_schlick(lobe.f0, cos_o);
  // The cosine-weighted mean of Schlick's F over the hemisphere is f0 + (1 - f0)/21.
  const float transmitted_in = lobe.f0 == 0.0f ? 1.0f : (1.0f - lobe.f0) * (20.0f / 21.0f);
  return {lobe.albedo * ((1.0f - fresnel) * transmitted_in), fresnel};
}

/// Probability of drawing from the specular part: its share of the estimated luminance, within [0.05, 0.95]
/// when both parts reflect. 0 when neither does.
inline float specular_probability(const SurfaceAlbedo& estimate) noexcept {
  const float diffuse = luminance(estimate.diffuse);
  if (!(estimate.specular > 0.0f)) return 0.0f;
  if (!(diffuse > 0.0f)) return 1.0f;
  return std::clamp(estimate.specular / (estimate.specular + diffuse), 0.05f, 0.95f);
}

/// The GGX distribution of normals at half vector h about n, 1/sr. Uses the sine: 1 - (n.h)^2 cancels at
/// small alpha.
inline float ggx_distribution(Vec3f n, Vec3f h, float alpha) noexcept {
  const Vec3f n_cross_h = cross(n, h);
  const float sin2 = dot(n_cross_h, n_cross_h);
  const float cos_h = dot(n, h);
  const float s = sin2 + alpha * alpha * cos_h * cos_h;
  return alpha * alpha * std::numbers::inv_pi_v<float> / (s * s);
}

/// cos sqrt(1 + alpha^2 tan^2): the part of Smith's functions that belongs to one direction, finite at
/// grazing.
inline float smith_term(float cosine, float alpha) noexcept {
  return std::sqrt(cosine * cosine + alpha * alpha * (1.0f - cosine) * (1.0f + cosine));
}

/// Whether wi is above the surface as seen from wo.
inline bool same_side(Vec3f normal, Vec3f wo, Vec3f wi) noexcept {
  return dot(dot(normal, wo) < 0.0f ? -normal : normal, wi) > 0.0f;
}

/// The value and density for unit wo and wi; `normal` is unit, of either side.
inline SurfaceValue eval_surface(const SurfaceLobe& lobe, Vec3f normal, Vec3f wo, Vec3f wi) noexcept {
  const Vec3f n = dot(normal, wo) < 0.0f ? -normal : normal;
  const float cos_o = std::min(dot(n, wo), 1.0f);
  const float cos_i = std::min(dot(n, wi), 1.0f);
  if (!(cos_o > 0.0f) || !(cos_i > 0.0f)) return {Vec3f(0.0f), Vec3f(0.0f), 0.0f};

  const float p_specular = specular_probability(estimate_albedo(lobe, cos_o));
  const float transmitted =
      (1.0f - fresnel_schlick(lobe.f0, cos_i)) * (1.0f - fresnel_schlick(lobe.f0, cos_o));
  SurfaceValue out;
  out.diffuse = lobe.albedo * (transmitted * cosine_hemisphere_pdf(cos_i));
  out.specular = Vec3f(0.0f);
  out.pdf = (1.0f - p_specular) * cosine_hemisphere_pdf(cos_i);
  if (lobe.f0 == 0.0f) return out;

  const Vec3f sum = wo + wi;
  const float sum_length = length(sum);
  if (!(sum_length > 0.0f)) return out;
  const float alpha = std::max(lobe.alpha, kMinAlpha);
  const float d = ggx_distribution(n, sum * (1.0f / sum_length), alpha);
  const float smith_o = smith_term(cos_o, alpha);
  const float smith_i = smith_term(cos_i, alpha);
  const float fresnel = fresnel_schlick(lobe.f0, 0.5f * sum_length);  // wo.h = wi.h = |wo + wi| / 2
  // G2 / (4 cos_i cos_o) = 1 / (2 (cos_i smith_o + cos_o smith_i)), and G1 / (4 cos_o) = 1 / (2 (cos_o +
  // smith_o)).
  out.specular = Vec3f(cos_i * fresnel * d / (2.0f * (cos_i * smith_o + cos_o * smith_i)));
  out.pdf += p_specular * d / (2.0f * (cos_o + smith_o));
  return out;
}

/// A half vector from the distribution of normals visible from the local wo (z up, wo.z >= 0), by spherical
/// caps (Dupuy and Benyoub 2023).
inline Vec3f sample_visible_normal(Vec3f wo, float alpha, float u0, float u1) noexcept {
  const Vec3f stretched = normalize(Vec3f(alpha * wo.x, alpha * wo.y, wo.z));
  const SineCosine phi = sine_cosine_of_turns(u0);
  const float z = (1.0f - u1) * (1.0f + stretched.z) - stretched.z;
  const float sin_theta = std::sqrt(std::max(0.0f, (1.0f - z) * (1.0f + z)));
  const Vec3f cap = Vec3f(sin_theta * phi.cosine, sin_theta * phi.sine, z) + stretched;
  return normalize(Vec3f(alpha * cap.x, alpha * cap.y, std::max(cap.z, 1e-20f)));
}

/// Draws wi from one part, by `specular`. May fall below the surface.
inline Vec3f sample_surface_part(bool specular, const SurfaceLobe& lobe, Vec3f normal, Vec3f wo, float u0,
                                 float u1) noexcept {
  const Frame frame(dot(normal, wo) < 0.0f ? -normal : normal);
  if (!specular) return frame.to_world(cosine_hemisphere(u0, u1));
  const Vec3f local_o = frame.to_local(wo);
  const Vec3f h = sample_visible_normal(local_o, std::max(lobe.alpha, kMinAlpha), u0, u1);
  return normalize(frame.to_world(h * (2.0f * dot(local_o, h)) - local_o));
}

/// Draws wi with the density that eval_surface reports; its integral is below 1 by the part of the specular
/// reflections that falls below the surface.
inline SurfaceSample sample_surface(const SurfaceLobe& lobe, Vec3f normal, Vec3f wo, float u_lobe, float u0,
                                    float u1) noexcept {
  const float cos_o = std::min(std::abs(dot(normal, wo)), 1.0f);
  const bool specular = u_lobe < specular_probability(estimate_albedo(lobe, cos_o));
  const Vec3f wi = sample_surface_part(specular, lobe, normal, wo, u0, u1);
  const SurfaceValue value = eval_surface(lobe, normal, wo, wi);
  return {wi, value.diffuse, value.specular, value.pdf};
}

}  // namespace voxlume
