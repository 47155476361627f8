// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_LIGHT_VECTOR_LIGHT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_LIGHT_VECTOR_LIGHT_INL_H_
#undef VOXLUME_LIGHT_VECTOR_LIGHT_INL_H_
#else
#define VOXLUME_LIGHT_VECTOR_LIGHT_INL_H_
#endif

#include <hwy/highway.h>

#include "light/sample_light.h"
#include "sampling/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// LightSample; `delta` is a mask.
template <class F>
struct VectorLightSample {
  using Mask = hn::Mask<hn::DFromV<F>>;
  Vector3<F> wi;
  F distance_mm;
  Vector3<F> radiance;
  F pdf;
  Mask delta;
};

template <class F>
VectorLightSample<F> choose(hn::Mask<hn::DFromV<F>> mask, const VectorLightSample<F>& yes,
                            const VectorLightSample<F>& no) {
  return {choose(mask, yes.wi, no.wi), hn::IfThenElse(mask, yes.distance_mm, no.distance_mm),
          choose(mask, yes.radiance, no.radiance), hn::IfThenElse(mask, yes.pdf, no.pdf),
          hn::Or(hn::And(mask, yes.delta), hn::AndNot(mask, no.delta))};
}

template <class F>
VectorLightSample<F> vector_no_light() {
  const F zero = broadcast<F>(0.0f);
  return {broadcast<F>(Vec3f(0.0f, 0.0f, 1.0f)), broadcast<F>(std::numeric_limits<float>::infinity()),
          broadcast<F>(Vec3f(0.0f)), zero, hn::Lt(zero, zero)};
}

/// RectFromPoint.
template <class F>
struct VectorRect {
  F x0, x1, y0, y1, height;
};
template <class F>
VectorRect<F> vector_rect_from_point(const Light& light, Vector3<F> p_world) {
  const F half_width = broadcast<F>(light.half_width_mm), half_height = broadcast<F>(light.half_height_mm);
  const Vector3<F> to_centre = broadcast<F>(light.position_mm) - p_world;
  const F x = dot(to_centre, broadcast<F>(light.axis_x)), y = dot(to_centre, broadcast<F>(light.axis_y));
  return {x - half_width, x + half_width, y - half_height, y + half_height,
          hn::Neg(dot(to_centre, broadcast<F>(light.direction)))};
}
template <class F>
hn::Mask<hn::DFromV<F>> vector_rect_emits_toward(const Light& light, F height) {
  const F zero = broadcast<F>(0.0f);
  return light.two_sided ? hn::Ne(height, zero) : hn::Gt(height, zero);
}

/// sample_rect_light where the light is far, and the lanes where it is near.
template <class F>
VectorLightSample<F> vector_sample_far_rect(const Light& light, Vector3<F> p_world, F u0, F u1,
                                            hn::Mask<hn::DFromV<F>>& near) {
  const VectorRect<F> r = vector_rect_from_point(light, p_world);
  const auto emits = vector_rect_emits_toward(light, r.height);
  // rect_technique
  const Vector3<F> twice_centre{r.x0 + r.x1, r.y0 + r.y1, broadcast<F>(2.0f) * r.height},
      diagonal{r.x1 - r.x0, r.y1 - r.y0, broadcast<F>(0.0f)};
  const auto far = hn::Gt(dot(twice_centre, twice_centre),
                          broadcast<F>(kFarHalfDiagonals * kFarHalfDiagonals) * dot(diagonal, diagonal));
  near = hn::AndNot(far, emits);
  // sample_rect and rect_pdf
  const F qx = r.x0 + u0 * (r.x1 - r.x0), qy = r.y0 + u1 * (r.y1 - r.y0);
  const auto outside =
      hn::Or(hn::Or(hn::Lt(qx, r.x0), hn::Gt(qx, r.x1)), hn::Or(hn::Lt(qy, r.y0), hn::Gt(qy, r.y1)));
  const Vector3<F> to_light = broadcast<F>(light.axis_x) * qx + broadcast<F>(light.axis_y) * qy -
                              broadcast<F>(light.direction) * r.height;
  const F distance_mm = length(to_light);
  const F area = (r.x1 - r.x0) * (r.y1 - r.y0);
  const F pdf = distance_mm * distance_mm * distance_mm / (hn::Abs(r.height) * area);
  const VectorLightSample<F> none = vector_no_light<F>();
  return choose(hn::AndNot(outside, emits),
                VectorLightSample<F>{to_light * (broadcast<F>(1.0f) / distance_mm), distance_mm,
                                     broadcast<F>(light.emission), pdf, none.delta},
                none);
}

template <class F>
VectorLightSample<F> vector_sample_delta_light(const Light& light, Vector3<F> p_world) {
  const F one = broadcast<F>(1.0f);
  const VectorLightSample<F> none = vector_no_light<F>();
  const auto all = hn::Eq(one, one);
  if (light.kind == LightKind::kDirectional)
    return {broadcast<F>(light.direction), none.distance_mm, broadcast<F>(light.emission), one, all};
  const Vector3<F> to_light = broadcast<F>(light.position_mm) - p_world;
  const F d2 = dot(to_light, to_light), distance_mm = hn::Sqrt(d2);
  return choose(hn::Gt(d2, broadcast<F>(1e-12f)),
                VectorLightSample<F>{to_light * (one / distance_mm), distance_mm,
                                     broadcast<F>(light.emission) * (one / d2), one, all},
                none);
}

/// More lights than this are left to scalar code.
constexpr int kMostVectorLights = 8;

/// sample_light, and the lanes that are left to scalar code: those that take the environment or a rectangle
/// nearby.
template <class F>
VectorLightSample<F> vector_sample_light(const LightsView& view, Vector3<F> p_world, F u_pick, F u0, F u1,
                                         hn::Mask<hn::DFromV<F>>& left) {
  const F one = broadcast<F>(1.0f);
  VectorLightSample<F> out = vector_no_light<F>();
  left = hn::Eq(one, one);
  if (view.light_count > kMostVectorLights) return out;
  for (int i = 0; i < view.light_count; ++i) {
    const auto at_least = hn::Ge(u_pick, broadcast<F>(view.pick.cdf[i]));
    const auto picked = hn::And(at_least, hn::Lt(u_pick, broadcast<F>(view.pick.cdf[i + 1])));
    if (hn::AllFalse(hn::DFromV<F>(), picked)) continue;
    const Light& light = view.lights[i];
    auto near = hn::Lt(one, one);
    VectorLightSample<F> sample = light.kind == LightKind::kRect
                                      ? vector_sample_far_rect(light, p_world, u0, u1, near)
                                      : vector_sample_delta_light(light, p_world);
    sample.pdf = sample.pdf * broadcast<F>(bin_probability(view.pick, i));
    out = choose(picked, sample, out);
    left = hn::AndNot(hn::AndNot(near, picked), left);
  }
  return out;
}

/// meets_rect_light.
template <class F>
hn::Mask<hn::DFromV<F>> vector_meets_rect_light(const LightsView& view, Vector3<F> origin,
                                                Vector3<F> direction) {
  const F zero = broadcast<F>(0.0f), infinity = broadcast<F>(std::numeric_limits<float>::infinity());
  auto meets = hn::Lt(zero, zero);
  for (int i = 0; i < view.rect_count; ++i) {
    const Light& light = view.lights[i];
    const Vector3<F> axis_x = broadcast<F>(light.axis_x), axis_y = broadcast<F>(light.axis_y),
                     normal = broadcast<F>(light.direction);
    const VectorRect<F> r = vector_rect_from_point(light, origin);
    const F t = hn::Neg(r.height) / dot(direction, normal);
    const F x = t * dot(direction, axis_x), y = t * dot(direction, axis_y);
    const auto ahead = hn::And(hn::Gt(t, zero), hn::Lt(t, infinity));
    const auto beside =
        hn::Or(hn::Or(hn::Lt(x, r.x0), hn::Gt(x, r.x1)), hn::Or(hn::Lt(y, r.y0), hn::Gt(y, r.y1)));
    meets = hn::Or(meets, hn::AndNot(beside, hn::And(ahead, vector_rect_emits_toward(light, r.height))));
  }
  return meets;
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
