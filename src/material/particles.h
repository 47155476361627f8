#pragma once
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "material/albedo_table.h"
#include "material/glass.h"
#include "material/material.h"
#include "material/phase.h"
#include "material/rough_diffuse.h"
#include "material/scatter.h"
#include "material/surface.h"
#include "sampling/logarithm.h"
#include "sampling/sobol.h"

namespace voxlume {

// Particles of several kinds at one point (xu2025 section 3.2):
//   h(wo, wi) = P sum_k p_k alpha_k rho_k + (1 - P) alpha rho_phase, per steradian.
// Every scattering function rho (the cosine included) integrates to 1 over wi, so that all that is absorbed
// is in the colours alpha: white matter loses nothing, however rough. That costs reciprocity. The kinds:
//   metal    D G2 / (4 cos_o) / E; alpha is Schlick's reflectance with f0 = color at the half vector.
//   glass    rough interface with Fresnel's exact reflectance (Walter et al. 2007), over the sphere, divided
//   by
//            its own albedo. Reflection is white, refraction has the color. wo's side of the normal decides
//            which way light passes; refraction does not compress radiance.
//   coat     D G2 / (4 cos_o) / E, white; the share F(cos_o) of what is neither metal nor glass.
//   diffuse  FON, normalised; the other 1 - F(cos_o).
//   phase    two Henyey-Greenstein lobes.
// D is GGX, G2 Smith's height-correlated masking and shadowing, E the albedo of D G2 / (4 cos_o). All but
// glass have two sides. Glass with ior < kMinIor does not bend or reflect at all: light passes straight on,
// spread over a milliradian or two, so that there is a density (straight_pdf). Lobes of bending glass
// narrower than floats resolve, (ior - 1) alpha < 1e-5, have a density with a noise of a few per cent; value
// / pdf is exact.

/// What scatters at a point. alpha below kMinAlpha counts as kMinAlpha.
struct ParticlePoint {
  Vec3f normal;              ///< unit, outward (from dense to thin); zero when p_surface = 0
  float p_surface;           ///< P: share of surface particles, [0,1]
  Vec3f color;               ///< alpha of diffuse, metal, transmission and phase, each in [0,1]
  float alpha;               ///< GGX width, the square of the roughness, [0,1]
  float f0;                  ///< the coat's reflectance at normal incidence, [0,1]; 0: no coat
  float metallic;            ///< share of metal among the surface particles, [0,1]
  float transmission;        ///< share of glass among the others, [0,1]
  float ior;                 ///< of glass, inside over outside, >= 1
  float diffuse_roughness;   ///< FON's r, [0,1]; 0: Lambert
  float g, g_back;           ///< anisotropies of the phase function's lobes, (-1,1)
  float back_share;          ///< share of the second lobe, [0,1]
  const GlassAlbedo* glass;  ///< of `ior`; nullptr allowed when transmission = 0 or ior < kMinIor
};

/// A point of a material.
inline ParticlePoint particle_point(const Material& m, Vec3f normal, float p_surface, Vec3f color) noexcept {
  return {normal, p_surface,           color, m.alpha,  m.f0,         m.metallic, m.transmission,
          m.ior,  m.diffuse_roughness, m.g,   m.g_back, m.back_share, m.glass};
}

/// What depends on wo alone: the upper bounds of u_lobe within which each kind is drawn, and albedos.
struct ParticleChoice {
  float metal, glass, coat, diffuse, any;  ///< ascending; any is 1, or 0 when nothing scatters
  AlbedoEntry mirror, pane;                ///< of metal and coat; of glass (the mean: reflected part)
  float fresnel;                           ///< the coat's F(cos_o)
  float rough_albedo;                      ///< of rough_diffuse
};

/// The shares of the kinds that a point consists of; they add up to 1 (rest: coat and diffuse).
struct ParticleShares {
  float metal, glass, rest, phase;
};
inline ParticleShares particle_shares(const ParticlePoint& p) noexcept {
  const float others = p.p_surface * (1.0f - p.metallic);
  return {p.p_surface * p.metallic, others * p.transmission, others * (1.0f - p.transmission),
          1.0f - p.p_surface};
}

/// Least probability of a kind that scatters, before the probabilities are made to add up to 1.
constexpr float kLeastChoice = 0.05f;

/// Kinds are drawn in proportion to the luminance of what they scatter.
inline ParticleChoice particle_choice(const ParticlePoint& p, Vec3f wo) noexcept {
  const ParticleShares shares = particle_shares(p);
  const float bright = luminance(p.color);
  const float cos_o = std::min(std::abs(dot(p.normal, wo)), 1.0f);
  ParticleChoice out{0.0f, 0.0f, 0.0f, 0.0f, 0.0f, {1.0f, 0.0f}, {1.0f, 0.0f}, 0.0f, 1.0f};
  if (shares.rest > 0.0f) {
    out.fresnel = fresnel_schlick(p.f0, cos_o);
    out.rough_albedo = rough_diffuse_albedo(cos_o, p.diffuse_roughness);
  }
  if (shares.metal > 0.0f || out.fresnel > 0.0f) out.mirror = ggx_albedo().at(cos_o, p.alpha);
  if (shares.glass > 0.0f && p.ior >= kMinIor)
    out.pane = p.glass->at(dot(p.normal, wo) >= 0.0f, cos_o, p.alpha);

  float weights[5] = {shares.metal * (bright + (1.0f - bright) * out.mirror.mean),
                      shares.glass * (out.pane.mean + (1.0f - out.pane.mean) * bright),
                      shares.rest * out.fresnel, shares.rest * (1.0f - out.fresnel) * bright,
                      shares.phase * bright};
  float total = 0.0f, floored = 0.0f;
  for (const float w : weights) total += w;
  if (!(total > 0.0f)) return out;
  for (float& w : weights) floored += w = w > 0.0f ? std::max(w / total, kLeastChoice) : 0.0f;
  float bounds[5], sum = 0.0f;
  for (int i = 0; i < 5; ++i) bounds[i] = std::min((sum += weights[i]) / floored, 1.0f);
  // The last kind that scatters reaches to 1 whatever the rounding.
  bounds[4] = 1.0f;
  for (int i = 4; i > 0 && weights[i] == 0.0f; --i) bounds[i - 1] = 1.0f;
  out.metal = bounds[0];
  out.glass = bounds[1];
  out.coat = bounds[2];
  out.diffuse = bounds[3];
  out.any = bounds[4];
  return out;
}

/// Probability with which sample_particles draws from metal, glass or coat.
inline float specular_share(const ParticlePoint& p, Vec3f wo) noexcept { return particle_choice(p, wo).coat; }

/// The integral of h over wi, to the precision of the tables; each in [0,1]. For white it is 1; for colored
/// glass seen from inside, smooth and near the critical angle, the reflected part is an estimate.
inline Vec3f particle_albedo(const ParticlePoint& p, Vec3f wo) noexcept {
  const ParticleShares shares = particle_shares(p);
  const ParticleChoice c = particle_choice(p, wo);
  // What each kind returns is white + (1 - white) color.
  const float white = shares.metal * c.mirror.mean + shares.glass * c.pane.mean + shares.rest * c.fresnel;
  return min(Vec3f(white) + p.color * std::max(0.0f, 1.0f - white), Vec3f(1.0f));
}

/// Glass that does not bend light: exp(-versine / 1e-6) about -wo.
constexpr float kStraightVersine = 1e-6f;
inline float straight_pdf(Vec3f wo, Vec3f wi) noexcept {
  const Vec3f off = wo + wi;
  return std::exp(dot(off, off) * (-0.5f / kStraightVersine)) *
         (0.5f * std::numbers::inv_pi_v<float> / kStraightVersine);
}
inline Vec3f sample_straight(Vec3f wo, float u0, float u1) noexcept {
  return Frame(-wo).to_world(direction_from_versine(kStraightVersine * negative_log(1.0f - u0), u1));
}

/// The phase function of two lobes.
inline float phase_of(const ParticlePoint& p, Vec3f wo, Vec3f wi) noexcept {
  const float first = phase_hg_between(wo, wi, p.g);
  if (!(p.back_share > 0.0f)) return first;
  return (1.0f - p.back_share) * first + p.back_share * phase_hg_between(wo, wi, p.g_back);
}

/// The two directions at a surface, with the normal on wo's side.
struct Incidence {
  Vec3f normal;
  float cos_o, cos_i;  ///< cos_o >= 0
  float eta;           ///< of glass, beyond over before

  Incidence(const ParticlePoint& p, Vec3f wo, Vec3f wi) noexcept {
    const bool outside = dot(p.normal, wo) >= 0.0f;
    normal = outside ? p.normal : -p.normal;
    cos_o = std::clamp(dot(normal, wo), 0.0f, 1.0f);
    cos_i = std::clamp(dot(normal, wi), -1.0f, 1.0f);
    eta = outside ? p.ior : 1.0f / p.ior;
  }
};

/// Adds what surface particles send back to wo's side, cos_i > 0.
inline void add_reflection(const ParticlePoint& p, const ParticleShares& shares, const ParticleChoice& c,
                           const Incidence& at, Vec3f wo, Vec3f wi, ScatterParts& out) noexcept {
  if (shares.rest > 0.0f) {
    const float rho =
        eval_rough_diffuse(at.cos_o, at.cos_i, dot(wo, wi), p.diffuse_roughness) / c.rough_albedo;
    out.diffuse = p.color * (shares.rest * (1.0f - c.fresnel) * rho);
    out.pdf += (c.diffuse - c.coat) * rough_diffuse_pdf(even_share(at.cos_o, p.diffuse_roughness), at.cos_i);
  }
  const bool bends = shares.glass > 0.0f && p.ior >= kMinIor;
  const Vec3f sum = wo + wi;
  const float sum_length = length(sum);
  if (!(shares.metal > 0.0f || c.fresnel > 0.0f || bends) || !(sum_length > 0.0f)) return;

  const float alpha = std::max(p.alpha, kMinAlpha);
  const float d = ggx_distribution(at.normal, sum * (1.0f / sum_length), alpha);
  const float smith_o = smith_term(at.cos_o, alpha);
  const float reflected =
      at.cos_i * d / (2.0f * (at.cos_i * smith_o + at.cos_o * smith_term(at.cos_i, alpha)));
  const float cos_d = std::min(0.5f * sum_length, 1.0f);
  const float m = 1.0f - cos_d, m5 = m * m * m * m * m;
  const float rho = reflected / c.mirror.albedo;
  out.specular += (p.color + (Vec3f(1.0f) - p.color) * m5) * (shares.metal * rho);
  out.specular += Vec3f(shares.rest * c.fresnel * rho);
  out.pdf += (c.metal + (c.coat - c.glass)) * rho;
  if (!bends) return;
  const float rho_glass = fresnel_dielectric(cos_d, at.eta) * reflected / c.pane.albedo;
  out.specular += Vec3f(shares.glass * rho_glass);
  out.pdf += (c.glass - c.metal) * rho_glass;
}

/// Adds what glass lets through to the other side, cos_i < 0.
inline void add_refraction(const ParticlePoint& p, float share, const ParticleChoice& c, const Incidence& at,
                           Vec3f wo, Vec3f wi, ScatterParts& out) noexcept {
  const Vec3f sum = wo + wi * at.eta;
  const float sum_length = length(sum);
  const Vec3f h = sum * (std::copysign(1.0f, dot(sum, at.normal)) / sum_length);
  const float cos_o = std::min(dot(wo, h), 1.0f), cos_i = -dot(wi, h);
  if (!(cos_o > 0.0f) || !(cos_i > 0.0f)) return;  // also where there is no half vector
  const float alpha = std::max(p.alpha, kMinAlpha);
  const float smith_o = smith_term(at.cos_o, alpha);
  // Solid angle of half vectors per solid angle of wi, times D (wo.h).
  const float stretch = at.eta / sum_length;
  const float density = ggx_distribution(at.normal, h, alpha) * cos_o * (cos_i * stretch * stretch);
  // G2 / cos_o
  const float open = 2.0f * -at.cos_i / (-at.cos_i * smith_o + at.cos_o * smith_term(-at.cos_i, alpha));
  const float rho = (1.0f - fresnel_dielectric(cos_o, at.eta)) * density * open / c.pane.albedo;
  out.specular += p.color * (share * rho);
  out.pdf += (c.glass - c.metal) * rho;
}

/// h by its parts (metal, glass and coat are the specular one) and the density of sample_particles, for unit
/// wo and wi and a choice made by particle_choice(p, wo).
inline ScatterParts eval_particles(const ParticlePoint& p, const ParticleChoice& c, Vec3f wo,
                                   Vec3f wi) noexcept {
  ScatterParts out{Vec3f(0.0f), Vec3f(0.0f), Vec3f(0.0f), 0.0f};
  const ParticleShares shares = particle_shares(p);
  if (p.p_surface > 0.0f) {
    const Incidence at(p, wo, wi);
    if (at.cos_i > 0.0f) add_reflection(p, shares, c, at, wo, wi, out);
    if (shares.glass > 0.0f && p.ior >= kMinIor) {
      if (at.cos_i < 0.0f) add_refraction(p, shares.glass, c, at, wo, wi, out);
    } else if (shares.glass > 0.0f) {
      const float rho = straight_pdf(wo, wi);
      out.specular += p.color * (shares.glass * rho);
      out.pdf += (c.glass - c.metal) * rho;
    }
  }
  if (shares.phase > 0.0f) {
    const float rho = phase_of(p, wo, wi);
    out.phase = p.color * (shares.phase * rho);
    out.pdf += (c.any - c.diffuse) * rho;
  }
  return out;
}

/// The same, making the choice itself.
inline ScatterParts eval_particles(const ParticlePoint& p, Vec3f wo, Vec3f wi) noexcept {
  return eval_particles(p, particle_choice(p, wo), wo, wi);
}

/// Where a u between two bounds lies between them, in [0, 1 - 2^-24].
inline float within_bounds(float u, float low, float high) noexcept {
  return std::clamp((u - low) / (high - low), 0.0f, 1.0f - 0x1p-24f);
}

/// Numbers in [0, 1) after those that a sample was given, which decide them.
class FurtherNumbers {
 public:
  FurtherNumbers(float u_lobe, float u0, float u1) noexcept
      : state_(mix_bits(std::bit_cast<std::uint32_t>(u0) ^
                        mix_bits(std::bit_cast<std::uint32_t>(u1) ^
                                 mix_bits(std::bit_cast<std::uint32_t>(u_lobe) + 1)))) {}
  float next() noexcept { return unit_float(mix_bits(state_ += 0x9E3779B9u)); }

 private:
  std::uint32_t state_;
};

/// A direction drawn from the kind that u_lobe chooses; ended: on the side it cannot be on.
struct ParticleDirection {
  Vec3f wi;
  bool ended;
};

/// Microfacets that are tried before a direction is given up: each is kept with a probability of at least 0.3
/// on average.
constexpr int kMostFacets = 100;

/// Draws a direction from metal or coat, or from glass: a visible microfacet (for glass with its Fresnel
/// reflectance, what it reflects or lets through), kept with the probability G2 / G1 that nothing masks the
/// way out. What is kept has the density of the normalised lobe itself, so that white matter changes no
/// path's weight, however often it scatters.
inline ParticleDirection sample_facet(const ParticlePoint& p, bool glass, bool outside, Vec3f wo,
                                      float u_lobe, float u0, float u1) noexcept {
  const Vec3f normal = outside ? p.normal : -p.normal;
  const Frame frame(normal);
  const float alpha = std::max(p.alpha, kMinAlpha), eta = outside ? p.ior : 1.0f / p.ior;
  Vec3f local_o = frame.to_local(wo);
  local_o.z = std::max(local_o.z, 0.0f);
  const float cos_o = std::min(local_o.z, 1.0f), smith_o = smith_term(cos_o, alpha);
  FurtherNumbers numbers(u_lobe, u0, u1);
  for (int i = 0; i < kMostFacets; ++i) {
    const Vec3f h = normalize(frame.to_world(sample_visible_normal(local_o, alpha, u0, u1)));
    const float cos_d = std::clamp(dot(wo, h), 0.0f, 1.0f);
    const bool passes = glass && numbers.next() >= fresnel_dielectric(cos_d, eta);
    const Vec3f wi = normalize(passes ? refract(wo, h, eta) : h * (2.0f * cos_d) - wo);
    const float cos_i = std::min(passes ? -dot(normal, wi) : dot(normal, wi), 1.0f);
    const float masked = cos_i * smith_o + cos_o * smith_term(std::max(cos_i, 0.0f), alpha);
    if (cos_i > 0.0f && numbers.next() * masked < cos_i * (cos_o + smith_o)) return {wi, false};
    u0 = numbers.next();
    u1 = numbers.next();
  }
  return {normal, true};
}

inline ParticleDirection sample_surface_particle(const ParticlePoint& p, const ParticleChoice& c, Vec3f wo,
                                                 float u_lobe, float u0, float u1) noexcept {
  const bool glass = u_lobe >= c.metal && u_lobe < c.glass;
  if (glass && !(p.ior >= kMinIor)) return {sample_straight(wo, u0, u1), false};
  const bool outside = dot(p.normal, wo) >= 0.0f;
  if (u_lobe < c.coat) return sample_facet(p, glass, outside, wo, u_lobe, u0, u1);
  const Vec3f normal = outside ? p.normal : -p.normal;
  const float even = even_share(std::min(dot(normal, wo), 1.0f), p.diffuse_roughness);
  const Vec3f wi = normalize(
      Frame(normal).to_world(sample_rough_diffuse(even, within_bounds(u_lobe, c.coat, c.diffuse), u0, u1)));
  return {wi, !(dot(normal, wi) > 0.0f)};
}

/// Draws wi with the density that eval_particles reports; weight a path by value / pdf. pdf = 0: the path
/// ends. `c` is particle_choice(p, wo).
inline ScatterSample sample_particles(const ParticlePoint& p, const ParticleChoice& c, Vec3f wo, float u_lobe,
                                      float u0, float u1) noexcept {
  if (!(c.any > 0.0f)) return {-wo, Vec3f(0.0f), 0.0f};
  ParticleDirection drawn;
  if (u_lobe >= c.diffuse) {
    const bool back = within_bounds(u_lobe, c.diffuse, c.any) < p.back_share;
    drawn = {sample_hg(-wo, back ? p.g_back : p.g, u0, u1), false};
  } else {
    drawn = sample_surface_particle(p, c, wo, u_lobe, u0, u1);
  }
  // The density of the kind it was drawn from is 0 there: weighted by the others' it would count twice.
  if (drawn.ended) return {drawn.wi, Vec3f(0.0f), 0.0f};
  const ScatterParts parts = eval_particles(p, c, wo, drawn.wi);
  return {drawn.wi, parts.diffuse + parts.specular + parts.phase, parts.pdf};
}

/// The same, making the choice itself.
inline ScatterSample sample_particles(const ParticlePoint& p, Vec3f wo, float u_lobe, float u0,
                                      float u1) noexcept {
  return sample_particles(p, particle_choice(p, wo), wo, u_lobe, u0, u1);
}

}  // namespace voxlume
