#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "material/scatter.h"

namespace voxlume {

// A medium with highlights where its extinction changes (lerzer2025 section 3):
//   h = albedo (rho(wo, wi) + strength (n . m)^shininess (n . wi)_+),  m the half vector of wo and wi,
// per steradian. It is neither normalised nor reciprocal: strong highlights add light.

/// The second term: `strength` follows the gradient of the extinction.
struct Highlight {
  float strength = 0;  ///< >= 0
  float shininess = 40;
};

/// The part of light from all around that a highlight of strength 1 reflects along the normal, over the
/// albedo.
inline float blinn_phong_albedo(float shininess) noexcept {
  const auto moment = [&](float e) { return (1 - std::exp2(-0.5f * e)) / e; };
  return 8 * std::numbers::pi_v<float> * (2 * moment(shininess + 4) - moment(shininess + 2));
}

/// Directions of highlights are drawn as from a mirror of this roughness, whose normals are spread alike.
inline SurfaceLobe highlight_mirror(float shininess) noexcept {
  return {Vec3f(0.0f), std::sqrt(2.0f / (shininess + 2.0f)), 1.0f};
}

/// The probabilities of drawing a highlight's direction and any; those of `specular` and `surface` are one.
inline ScatterChoice blinn_phong_choice(const ScatterPoint& s, const Highlight& highlight) noexcept {
  if (!(luminance(s.albedo) > 0)) return {0, 0, 0};
  const float reflected = highlight.strength * blinn_phong_albedo(highlight.shininess);
  if (!(reflected > 0)) return {0, 0, 1};
  const float p = std::clamp(reflected / (reflected + 1), 0.05f, 0.95f);
  return {p, p, 1};
}

/// h by its parts, and q; the normal counts on wo's side.
inline ScatterParts eval_blinn_phong(const ScatterPoint& s, const Highlight& highlight,
                                     const ScatterChoice& choice, Vec3f wo, Vec3f wi) noexcept {
  const float rho = phase_hg_between(wo, wi, s.g);
  ScatterParts out{Vec3f(0.0f), Vec3f(0.0f), s.albedo * rho, (choice.any - choice.surface) * rho};
  if (!(choice.surface > 0) || !same_side(s.normal, wo, wi)) return out;
  const Vec3f n = dot(s.normal, wo) < 0.0f ? -s.normal : s.normal;
  const Vec3f sum = wo + wi;
  const float sum_length = length(sum);
  if (!(sum_length > 0)) return out;
  const float cos_half = std::clamp(dot(n, sum) / sum_length, 0.0f, 1.0f);
  out.specular =
      s.albedo * (highlight.strength * std::pow(cos_half, highlight.shininess) * std::min(dot(n, wi), 1.0f));
  out.pdf += choice.surface * eval_surface(highlight_mirror(highlight.shininess), s.normal, wo, wi).pdf;
  return out;
}

/// Draws wi with density q; weight a path by value / pdf.
inline ScatterSample sample_blinn_phong(const ScatterPoint& s, const Highlight& highlight,
                                        const ScatterChoice& choice, Vec3f wo, float u_lobe, float u0,
                                        float u1) noexcept {
  if (!(choice.any > 0)) return {-wo, Vec3f(0.0f), 0};
  const bool from_highlight = u_lobe < choice.surface;
  const Vec3f wi =
      from_highlight ? sample_surface_part(true, highlight_mirror(highlight.shininess), s.normal, wo, u0, u1)
                     : sample_hg(-wo, s.g, u0, u1);
  // q has nothing below the surface.
  if (from_highlight && !same_side(s.normal, wo, wi)) return {wi, Vec3f(0.0f), 0};
  const ScatterParts parts = eval_blinn_phong(s, highlight, choice, wo, wi);
  return {wi, parts.specular + parts.phase, parts.pdf};
}

}  // namespace voxlume
