#pragma once
#include <algorithm>

#include "base/vec.h"
#include "material/phase.h"
#include "material/surface.h"

namespace voxlume {

// Surface-medium coexistence (xu2024 section 4): h = P_brdf f |cos_i| + (1 - P_brdf) albedo rho, per
// steradian. Directions are drawn from a mixture, and its density q belongs to every direction, whichever
// part it came from.

/// What scatters at a point.
struct ScatterPoint {
  Vec3f normal;  ///< unit, of either side; zero when p_brdf = 0
  float p_brdf;  ///< share of the surface, [0,1]
  Vec3f albedo;  ///< of the diffuse base and of the phase function, each in [0,1]
  float g;       ///< Henyey-Greenstein anisotropy, (-1,1)
  float alpha;   ///< GGX width, [0,1]
  float f0;      ///< reflectance at normal incidence, [0,1]
};

/// h(wo, wi) and the density of sample_scatter, per steradian.
struct ScatterValue {
  Vec3f value;
  float pdf;
};

/// h by its parts: value = diffuse + specular + phase.
struct ScatterParts {
  Vec3f diffuse, specular, phase;
  float pdf;
};

/// pdf = 0: no direction; the path ends here.
struct ScatterSample {
  Vec3f wi;
  Vec3f value;
  float pdf;
};

inline SurfaceLobe surface_lobe(const ScatterPoint& s) noexcept { return {s.albedo, s.alpha, s.f0}; }

/// The probabilities of drawing from the specular part, from the surface (specular included) and from
/// anything.
struct ScatterChoice {
  float specular, surface, any;  ///< ascending; any is 1, or 0 when nothing scatters
};

/// xu2024 eq. 7: P_b = l_b P_brdf / (l_b P_brdf + l_p (1 - P_brdf)) with the luminances of the lobes'
/// albedos, within [0.05, 0.95] when both scatter.
inline ScatterChoice scatter_choice(const ScatterPoint& s, Vec3f wo) noexcept {
  SurfaceAlbedo estimate{Vec3f(0.0f), 0.0f};
  if (s.p_brdf > 0.0f)
    estimate = estimate_albedo(surface_lobe(s), std::min(std::abs(dot(s.normal, wo)), 1.0f));
  const float surface = s.p_brdf * (luminance(estimate.diffuse) + estimate.specular);
  const float phase = (1.0f - s.p_brdf) * luminance(s.albedo);
  if (!(surface > 0.0f)) return {0.0f, 0.0f, phase > 0.0f ? 1.0f : 0.0f};
  const float p_b = phase > 0.0f ? std::clamp(surface / (surface + phase), 0.05f, 0.95f) : 1.0f;
  return {p_b * specular_probability(estimate), p_b, 1.0f};
}

/// h and q for unit wo and wi, for a choice made by scatter_choice(s, wo).
inline ScatterParts eval_scatter_parts(const ScatterPoint& s, const ScatterChoice& choice, Vec3f wo,
                                       Vec3f wi) noexcept {
  ScatterParts out{Vec3f(0.0f), Vec3f(0.0f), Vec3f(0.0f), 0.0f};
  if (s.p_brdf > 0.0f) {
    const SurfaceValue surface = eval_surface(surface_lobe(s), s.normal, wo, wi);
    out.diffuse = surface.diffuse * s.p_brdf;
    out.specular = surface.specular * s.p_brdf;
    out.pdf = choice.surface * surface.pdf;
  }
  if (s.p_brdf < 1.0f) {
    const float rho = phase_hg_between(wo, wi, s.g);
    out.phase = s.albedo * ((1.0f - s.p_brdf) * rho);
    out.pdf += (choice.any - choice.surface) * rho;
  }
  return out;
}

/// h by its parts, and q.
inline ScatterParts eval_scatter_parts(const ScatterPoint& s, Vec3f wo, Vec3f wi) noexcept {
  return eval_scatter_parts(s, scatter_choice(s, wo), wo, wi);
}

/// h and q for unit wo and wi, for a choice made by scatter_choice(s, wo).
inline ScatterValue eval_scatter(const ScatterPoint& s, const ScatterChoice& choice, Vec3f wo,
                                 Vec3f wi) noexcept {
  const ScatterParts parts = eval_scatter_parts(s, choice, wo, wi);
  return {parts.diffuse + parts.specular + parts.phase, parts.pdf};
}

/// h and q for unit wo and wi.
inline ScatterValue eval_scatter(const ScatterPoint& s, Vec3f wo, Vec3f wi) noexcept {
  return eval_scatter(s, scatter_choice(s, wo), wo, wi);
}

/// Draws wi with density q; weight a path by value / pdf. `choice` is scatter_choice(s, wo).
inline ScatterSample sample_scatter(const ScatterPoint& s, const ScatterChoice& choice, Vec3f wo,
                                    float u_lobe, float u0, float u1) noexcept {
  if (!(choice.any > 0.0f)) return {-wo, Vec3f(0.0f), 0.0f};
  const bool from_surface = u_lobe < choice.surface;
  const Vec3f wi = from_surface
                       ? sample_surface_part(u_lobe < choice.specular, surface_lobe(s), s.normal, wo, u0, u1)
                       : sample_hg(-wo, s.g, u0, u1);
  // q does not contain what the surface's part sends below the surface, so those samples end here: weighted
  // by the phase function they would be counted twice.
  if (from_surface && !same_side(s.normal, wo, wi)) return {wi, Vec3f(0.0f), 0.0f};
  const ScatterParts parts = eval_scatter_parts(s, choice, wo, wi);
  return {wi, parts.diffuse + parts.specular + parts.phase, parts.pdf};
}

/// The same, making the choice itself.
inline ScatterSample sample_scatter(const ScatterPoint& s, Vec3f wo, float u_lobe, float u0,
                                    float u1) noexcept {
  return sample_scatter(s, scatter_choice(s, wo), wo, u_lobe, u0, u1);
}

}  // namespace voxlume
