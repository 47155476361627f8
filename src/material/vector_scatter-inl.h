// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_MATERIAL_VECTOR_SCATTER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_MATERIAL_VECTOR_SCATTER_INL_H_
#undef VOXLUME_MATERIAL_VECTOR_SCATTER_INL_H_
#else
#define VOXLUME_MATERIAL_VECTOR_SCATTER_INL_H_
#endif

#include <hwy/highway.h>

#include "material/scatter.h"
#include "material/surface_share.h"
#include "sampling/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Twins of material/surface.h, material/phase.h, material/scatter.h and material/surface_share.h: the same
// arithmetic, so that lanes and scalar code agree to the last bit.

/// ScatterPoint. Anisotropy and lobe are everywhere alike.
template <class F>
struct VectorScatterPoint {
  Vector3<F> normal;
  F p_brdf;
  Vector3<F> albedo;
  float g, alpha, f0;
};

template <class F>
struct VectorScatterChoice {
  F specular, surface, any;
};

template <class F>
struct VectorScatterValue {
  Vector3<F> value;
  F pdf;
};

template <class F>
struct VectorScatterSample {
  Vector3<F> wi;
  Vector3<F> value;
  F pdf;
};

template <class F>
F vector_surface_share(SurfaceShareForm form, float gradient_factor, bool opacity_modulated, F opacity,
                       F gradient_normalized) {
  const F one = broadcast<F>(1.0f);
  switch (form) {
    case SurfaceShareForm::kHybrid: {
      const float exponent = 25.0f * gradient_factor * gradient_factor * gradient_factor;
      const F share = vector_one_minus_exp(broadcast<F>(exponent) * gradient_normalized);
      return opacity_modulated ? opacity * share : share;
    }
    case SurfaceShareForm::kExponential:
      return vector_one_minus_exp(broadcast<F>(gradient_factor) * gradient_normalized);
    case SurfaceShareForm::kModulation: {
      const F rest = one - lesser(gradient_normalized, one);
      return one - rest * rest;
    }
    case SurfaceShareForm::kThreshold:
      break;
  }
  return hn::IfThenElseZero(hn::Gt(gradient_normalized, broadcast<F>(0.5f)), one);
}

template <class F>
F vector_fresnel_schlick(float f0, F cosine) {
  if (f0 == 0.0f) return broadcast<F>(0.0f);
  const F m = clamped(broadcast<F>(1.0f) - cosine, 0.0f, 1.0f);
  const F m2 = m * m;
  return broadcast<F>(f0) + broadcast<F>(1.0f - f0) * m2 * m2 * m;
}

template <class F>
struct VectorSurfaceAlbedo {
  Vector3<F> diffuse;
  F specular;
};
template <class F>
VectorSurfaceAlbedo<F> vector_estimate_albedo(const VectorScatterPoint<F>& s, F cos_o) {
  const F fresnel = vector_fresnel_schlick(s.f0, cos_o);
  const float transmitted_in = s.f0 == 0.0f ? 1.0f : (1.0f - s.f0) * (20.0f / 21.0f);
  return {s.albedo * ((broadcast<F>(1.0f) - fresnel) * broadcast<F>(transmitted_in)), fresnel};
}

template <class F>
F vector_specular_probability(const VectorSurfaceAlbedo<F>& estimate) {
  const F zero = broadcast<F>(0.0f), diffuse = luminance(estimate.diffuse);
  const F share = clamped(estimate.specular / (estimate.specular + diffuse), 0.05f, 0.95f);
  return hn::IfThenElseZero(hn::Gt(estimate.specular, zero),
                            hn::IfThenElse(hn::Gt(diffuse, zero), share, broadcast<F>(1.0f)));
}

template <class F>
F vector_ggx_distribution(Vector3<F> n, Vector3<F> h, float alpha) {
  const Vector3<F> n_cross_h = cross(n, h);
  const F sin2 = dot(n_cross_h, n_cross_h);
  const F cos_h = dot(n, h);
  const F s = sin2 + broadcast<F>(alpha * alpha) * cos_h * cos_h;
  return broadcast<F>(alpha * alpha * std::numbers::inv_pi_v<float>) / (s * s);
}

template <class F>
F vector_smith_term(F cosine, float alpha) {
  const F one = broadcast<F>(1.0f);
  return hn::Sqrt(cosine * cosine + broadcast<F>(alpha * alpha) * (one - cosine) * (one + cosine));
}

/// The normal on the side of wo.
template <class F>
Vector3<F> vector_facing(Vector3<F> normal, Vector3<F> wo) {
  return choose(hn::Lt(dot(normal, wo), broadcast<F>(0.0f)), -normal, normal);
}

template <class F>
struct VectorSurfaceValue {
  Vector3<F> diffuse;
  F specular;  ///< of every colour
  F pdf;
};
template <class F>
VectorSurfaceValue<F> vector_eval_surface(const VectorScatterPoint<F>& s, Vector3<F> wo, Vector3<F> wi) {
  const F zero = broadcast<F>(0.0f), one = broadcast<F>(1.0f), two = broadcast<F>(2.0f);
  const Vector3<F> n = vector_facing(s.normal, wo);
  const F cos_o = lesser(dot(n, wo), one), cos_i = lesser(dot(n, wi), one);
  const auto lit = hn::And(hn::Gt(cos_o, zero), hn::Gt(cos_i, zero));

  const F p_specular = vector_specular_probability(vector_estimate_albedo(s, cos_o));
  const F transmitted =
      (one - vector_fresnel_schlick(s.f0, cos_i)) * (one - vector_fresnel_schlick(s.f0, cos_o));
  const F cosine_pdf = greater(zero, cos_i) * broadcast<F>(std::numbers::inv_pi_v<float>);
  VectorSurfaceValue<F> out{choose_or_zero(lit, s.albedo * (transmitted * cosine_pdf)), zero,
                            hn::IfThenElseZero(lit, (one - p_specular) * cosine_pdf)};
  if (s.f0 == 0.0f) return out;

  const Vector3<F> sum = wo + wi;
  const F sum_length = length(sum);
  const auto shines = hn::And(lit, hn::Gt(sum_length, zero));
  const float alpha = std::max(s.alpha, kMinAlpha);
  const F d = vector_ggx_distribution(n, sum * (one / sum_length), alpha);
  const F smith_o = vector_smith_term(cos_o, alpha), smith_i = vector_smith_term(cos_i, alpha);
  const F fresnel = vector_fresnel_schlick(s.f0, broadcast<F>(0.5f) * sum_length);
  out.specular =
      hn::IfThenElseZero(shines, cos_i * fresnel * d / (two * (cos_i * smith_o + cos_o * smith_i)));
  out.pdf = out.pdf + hn::IfThenElseZero(shines, p_specular * d / (two * (cos_o + smith_o)));
  return out;
}

template <class F>
F vector_phase_hg_between(Vector3<F> wo, Vector3<F> wi, float g) {
  const Vector3<F> from_peak = g < 0.0f ? wi - wo : wi + wo;
  const F versine = broadcast<F>(0.5f) * dot(from_peak, from_peak);
  const float a = std::abs(g);
  const F s2 = broadcast<F>((1.0f - a) * (1.0f - a)) + broadcast<F>(2.0f * a) * versine;
  return broadcast<F>(kUniformSpherePdf * (1.0f - a) * (1.0f + a)) / (s2 * hn::Sqrt(s2));
}

template <class F>
VectorScatterChoice<F> vector_scatter_choice(const VectorScatterPoint<F>& s, Vector3<F> wo) {
  const F zero = broadcast<F>(0.0f), one = broadcast<F>(1.0f);
  const VectorSurfaceAlbedo<F> estimate = vector_estimate_albedo(s, lesser(hn::Abs(dot(s.normal, wo)), one));
  const F surface = s.p_brdf * (luminance(estimate.diffuse) + estimate.specular);
  const F phase = (one - s.p_brdf) * luminance(s.albedo);
  const auto reflects = hn::Gt(surface, zero), scatters = hn::Gt(phase, zero);
  const F p_b = hn::IfThenElse(scatters, clamped(surface / (surface + phase), 0.05f, 0.95f), one);
  return {hn::IfThenElseZero(reflects, p_b * vector_specular_probability(estimate)),
          hn::IfThenElseZero(reflects, p_b), hn::IfThenElseZero(hn::Or(reflects, scatters), one)};
}

template <class F>
VectorScatterValue<F> vector_eval_scatter(const VectorScatterPoint<F>& s,
                                          const VectorScatterChoice<F>& choice, Vector3<F> wo,
                                          Vector3<F> wi) {
  const VectorSurfaceValue<F> surface = vector_eval_surface(s, wo, wi);
  const auto is_surface = hn::Gt(s.p_brdf, broadcast<F>(0.0f));
  const Vector3<F> diffuse = choose_or_zero(is_surface, surface.diffuse * s.p_brdf);
  const F specular = hn::IfThenElseZero(is_surface, surface.specular * s.p_brdf);
  const F surface_pdf = hn::IfThenElseZero(is_surface, choice.surface * surface.pdf);
  const F rho = vector_phase_hg_between(wo, wi, s.g);
  const auto is_medium = hn::Lt(s.p_brdf, broadcast<F>(1.0f));
  const Vector3<F> phase = choose_or_zero(is_medium, s.albedo * ((broadcast<F>(1.0f) - s.p_brdf) * rho));
  const F phase_pdf = hn::IfThenElseZero(is_medium, (choice.any - choice.surface) * rho);
  return {diffuse + Vector3<F>{specular, specular, specular} + phase, surface_pdf + phase_pdf};
}

/// Local directions about +z: of cosine_hemisphere, sample_visible_normal's mirror direction and sample_hg.
template <class F>
Vector3<F> vector_cosine_hemisphere(F radius, F sine, F cosine) {
  const F x = radius * cosine, y = radius * sine;
  return {x, y, hn::Sqrt(greater(broadcast<F>(0.0f), broadcast<F>(1.0f) - x * x - y * y))};
}
template <class F>
Vector3<F> vector_mirrored(Vector3<F> local_o, float alpha, F sine, F cosine, F u1) {
  const F one = broadcast<F>(1.0f), a = broadcast<F>(alpha);
  const Vector3<F> stretched = normalize(Vector3<F>{a * local_o.x, a * local_o.y, local_o.z});
  const F z = (one - u1) * (one + stretched.z) - stretched.z;
  const F sin_theta = hn::Sqrt(greater(broadcast<F>(0.0f), (one - z) * (one + z)));
  const Vector3<F> cap = Vector3<F>{sin_theta * cosine, sin_theta * sine, z} + stretched;
  const Vector3<F> h = normalize(Vector3<F>{a * cap.x, a * cap.y, greater(cap.z, broadcast<F>(1e-20f))});
  return h * (broadcast<F>(2.0f) * dot(local_o, h)) - local_o;
}
template <class F>
Vector3<F> vector_hg(float g, F u0, F sine, F cosine) {
  const F one = broadcast<F>(1.0f), two = broadcast<F>(2.0f);
  const float a = std::abs(g);
  const F r = broadcast<F>(1.0f - a) / (broadcast<F>(1.0f - a) + broadcast<F>(2.0f * a) * u0);
  const F versine = two * r * r * (one - u0) * (one + broadcast<F>(a) * u0);
  const F sin_theta = hn::Sqrt(greater(broadcast<F>(0.0f), versine * (two - versine)));
  return {sin_theta * cosine, sin_theta * sine, one - versine};
}

template <class F>
VectorScatterSample<F> vector_sample_scatter(const VectorScatterPoint<F>& s,
                                             const VectorScatterChoice<F>& choice, Vector3<F> wo, F u_lobe,
                                             F u0, F u1) {
  const F zero = broadcast<F>(0.0f), one = broadcast<F>(1.0f), two = broadcast<F>(2.0f);
  const auto from_surface = hn::Lt(u_lobe, choice.surface), specular = hn::Lt(u_lobe, choice.specular);
  const Vector3<F> n = vector_facing(s.normal, wo);
  const Vector3<F> propagation = -wo, peak = s.g < 0.0f ? -propagation : propagation;
  const VectorFrame<F> frame = vector_frame(choose(from_surface, n, peak));

  // concentric_disk; the other two turn about their axis by one of the numbers.
  const F a = two * u0 - one, b = two * u1 - one;
  const auto a_leads = hn::Gt(hn::Abs(a), hn::Abs(b));
  const F radius = hn::IfThenElse(a_leads, a, b);
  const F eighths = hn::IfThenZeroElse(hn::Eq(radius, zero), hn::IfThenElse(a_leads, b, a) / radius);
  const F eighth = broadcast<F>(0.125f) * eighths;
  const F disk_turns = hn::IfThenElse(a_leads, eighth, broadcast<F>(0.25f) - eighth);
  F sine, cosine;
  vector_sine_cosine_of_turns(hn::IfThenElse(from_surface, hn::IfThenElse(specular, u0, disk_turns), u1),
                              sine, cosine);

  Vector3<F> local =
      choose(from_surface, vector_cosine_hemisphere(radius, sine, cosine), vector_hg(s.g, u0, sine, cosine));
  const float alpha = std::max(s.alpha, kMinAlpha);
  local = choose(specular, vector_mirrored(to_local(frame, wo), alpha, sine, cosine, u1), local);
  Vector3<F> wi = to_world(frame, local);
  wi = choose(specular, normalize(wi), wi);

  const auto any = hn::Gt(choice.any, zero);
  const auto below = hn::And(from_surface, hn::Not(hn::Gt(dot(n, wi), zero)));
  const auto drawn = hn::AndNot(below, any);
  const VectorScatterValue<F> at = vector_eval_scatter(s, choice, wo, wi);
  return {choose(any, wi, propagation), choose_or_zero(drawn, at.value), hn::IfThenElseZero(drawn, at.pdf)};
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
