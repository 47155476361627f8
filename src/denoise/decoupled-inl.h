// Rows of the decoupled denoiser's stages; included once for every target.
#if defined(VOXLUME_DENOISE_DECOUPLED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_DECOUPLED_INL_H_
#undef VOXLUME_DENOISE_DECOUPLED_INL_H_
#else
#define VOXLUME_DENOISE_DECOUPLED_INL_H_
#endif

#include <cstdlib>

#include "denoise/decoupled.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// sigma_c of xu2024 eq. 11 and sigma_e of eq. 12, in units of a white Lambert surface's fx.
constexpr float kSigmaFx = 0.2f;
/// a and b of xu2024 eq. 13.
constexpr float kLightSlope = 3, kPresentShare = 5;
/// B3 spline: 3/8, 1/4, 1/16 by distance.
constexpr float kSpline[] = {3.0f / 8, 1.0f / 4, 1.0f / 16};

/// The length of a vector to about 1e-3; 0 for zero.
HWY_INLINE F rough_length(F3 v) {
  const F square = dot(v, v);
  return hn::Mul(square, hn::ApproximateReciprocalSqrt(hn::Max(square, hn::Set(kD, 1e-20f))));
}

/// -(|fx - fx'| / sigma + |d - d'| / sigma_d), of which a tap's weight is the exponential.
HWY_INLINE F tap_exponent(F3 fx, F3 fx_there, F depth, F depth_there, F inverse_depth_sigma) {
  const F colour = hn::Mul(rough_length(sub(fx, fx_there)), hn::Set(kD, -1.0f / kSigmaFx));
  return hn::NegMulAdd(hn::AbsDiff(depth, depth_there), inverse_depth_sigma, colour);
}

HWY_INLINE bool none(F count) { return hn::AllFalse(kD, hn::Gt(count, hn::Zero(kD))); }

HWY_INLINE void clear(Planes3& planes, int x, int y, std::size_t lanes) {
  store(zero3(), planes, x, y, lanes);
}

/// Spatial filter of fx (xu2024 eq. 11) over all classes of 3 x 3 pixels. A class counts by its samples.
void filter_fx_row(const DenoiseFrame& frame, int y, DecoupledStages& stages) {
  const std::array<SampleClass, 2>& classes = *frame.classes;
  const F inverse_sigma = hn::Set(kD, stages.inverse_depth_sigma);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F depth = load(frame.depth_mm, x, y);
    for (int k = 0; k < 2; ++k) {
      const F own_count = load(classes[k].count, x, y);
      if (none(own_count)) {
        clear(stages.fx_diffuse[k], x, y, lanes);
        clear(stages.fx_specular[k], x, y, lanes);
        continue;
      }
      const F3 own = load(classes[k].fx_diffuse, x, y);
      F weights = hn::Zero(kD);
      F3 diffuse = zero3(), specular = zero3();
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dx = -1; dx <= 1; ++dx) {
          const F depth_there = load(frame.depth_mm, x + dx, y + dy);
          for (const SampleClass& there : classes) {
            const F count = load(there.count, x + dx, y + dy);
            if (none(count)) continue;
            const F3 value = load(there.fx_diffuse, x + dx, y + dy);
            const F weight =
                hn::Mul(count, exp_approx(tap_exponent(own, value, depth, depth_there, inverse_sigma)));
            weights = hn::Add(weights, weight);
            diffuse = add_scaled(diffuse, value, weight);
            specular = add_scaled(specular, load(there.fx_specular, x + dx, y + dy), weight);
          }
        }
      }
      const F norm = hn::IfThenElseZero(hn::Gt(own_count, hn::Zero(kD)), hn::Div(hn::Set(kD, 1.0f), weights));
      store(scale(diffuse, norm), stages.fx_diffuse[k], x, y, lanes);
      store(scale(specular, norm), stages.fx_specular[k], x, y, lanes);
    }
  });
}

/// Light of one class, filtered at one pixel.
struct Light {
  F3 fl, later;
};

/// One step of the light's spatial filter (xu2024 5.3.2): 5 x 5 taps `stride` pixels apart, guided by the
/// filtered fx and by depth, over all classes. `fl` and `later` are by class.
template <class FlOf, class LaterOf>
HWY_INLINE Light filter_light(const DenoiseFrame& frame, const DecoupledStages& stages, int k, int x, int y,
                              int stride, const FlOf& fl_of, const LaterOf& later_of) {
  const F inverse_sigma = hn::Set(kD, stages.inverse_depth_sigma);
  const F depth = load(frame.depth_mm, x, y);
  const F3 own = load(stages.fx_diffuse[k], x, y);
  F weights = hn::Set(kD, 1e-30f);
  Light sum{zero3(), zero3()};
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const int there_x = x + dx * stride, there_y = y + dy * stride;
      const F spline = hn::Set(kD, kSpline[std::abs(dx)] * kSpline[std::abs(dy)]);
      const F depth_there = load(frame.depth_mm, there_x, there_y);
      for (int m = 0; m < 2; ++m) {
        const F count = load((*frame.classes)[m].count, there_x, there_y);
        if (none(count)) continue;
        const F3 fx = load(stages.fx_diffuse[m], there_x, there_y);
        const F edge = exp_approx(tap_exponent(own, fx, depth, depth_there, inverse_sigma));
        const F weight = hn::Mul(hn::Mul(count, spline), edge);
        weights = hn::Add(weights, weight);
        sum.fl = add_scaled(sum.fl, load(fl_of(m), there_x, there_y), weight);
        sum.later = add_scaled(sum.later, load(later_of(m), there_x, there_y), weight);
      }
    }
  }
  const F norm = hn::Div(hn::Set(kD, 1.0f), weights);
  return {scale(sum.fl, norm), scale(sum.later, norm)};
}

/// The first step: neighbouring taps.
void filter_light_row(const DenoiseFrame& frame, int y, DecoupledStages& stages) {
  const std::array<SampleClass, 2>& classes = *frame.classes;
  for_row(frame.width, [&](int x, std::size_t lanes) {
    for (int k = 0; k < 2; ++k) {
      const F count = load(classes[k].count, x, y);
      Light light{zero3(), zero3()};
      if (!none(count)) {
        light = filter_light(
            frame, stages, k, x, y, 1, [&](int m) -> const Planes3& { return classes[m].fl; },
            [&](int m) -> const Planes3& { return classes[m].later; });
      }
      store(light.fl, stages.fl[k], x, y, lanes);
      store(light.later, stages.later[k], x, y, lanes);
    }
  });
}

/// Where pixels were in the frame before, as offsets from row 0 of its planes.
struct Place {
  hn::Vec<hn::RebindToSigned<Floats>> offset;
  hn::Mask<Floats> seen;
};

HWY_INLINE Place place_before(const Reprojection& moved, const Plane& plane, int x, int y) {
  const hn::RebindToSigned<Floats> integers;
  const F px = load(moved.x, x, y), py = load(moved.y, x, y);
  const auto seen = hn::Ge(px, hn::Zero(kD));
  const auto column = hn::ConvertTo(integers, hn::IfThenElseZero(seen, px));
  const auto row = hn::ConvertTo(integers, hn::IfThenElseZero(seen, py));
  return {hn::Add(hn::Mul(row, hn::Set(integers, plane.stride())), column), seen};
}

HWY_INLINE F gather(const Plane& plane, const Place& place) {
  return hn::IfThenElseZero(place.seen, hn::GatherIndex(kD, plane.row(0), place.offset));
}
HWY_INLINE F3 gather(const Planes3& planes, const Place& place) {
  return {gather(planes[0], place), gather(planes[1], place), gather(planes[2], place)};
}

/// A class at a pixel.
struct ClassAt {
  F count;
  F3 fx_diffuse, fx_specular, fl, later;
};

HWY_INLINE ClassAt gather(const SampleClass& from, const Place& place) {
  return {gather(from.count, place), gather(from.fx_diffuse, place), gather(from.fx_specular, place),
          gather(from.fl, place), gather(from.later, place)};
}

HWY_INLINE F3 choose(hn::Mask<Floats> mask, F3 yes, F3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE ClassAt choose(hn::Mask<Floats> mask, const ClassAt& yes, const ClassAt& no) {
  return {hn::IfThenElse(mask, yes.count, no.count), choose(mask, yes.fx_diffuse, no.fx_diffuse),
          choose(mask, yes.fx_specular, no.fx_specular), choose(mask, yes.fl, no.fl),
          choose(mask, yes.later, no.later)};
}
HWY_INLINE void store(const ClassAt& from, SampleClass& to, int x, int y, std::size_t lanes) {
  store(from.count, to.count, x, y, lanes);
  store(from.fx_diffuse, to.fx_diffuse, x, y, lanes);
  store(from.fx_specular, to.fx_specular, x, y, lanes);
  store(from.fl, to.fl, x, y, lanes);
  store(from.later, to.later, x, y, lanes);
}

/// The luminance of the light of a class, in units of the frame's.
HWY_INLINE F light_luminance(const ClassAt& c, F inverse_light) {
  return hn::Mul(hn::Add(luminance(c.fl), luminance(c.later)), inverse_light);
}

/// Temporal filters of a class (xu2024 eqs. 12 and 13) over the classes of the frame before, each of which
/// counts `trust` in [0,1].
HWY_INLINE ClassAt with_history(const ClassAt& now, const ClassAt (&before)[2], F trust, F inverse_light) {
  const F one = hn::Set(kD, 1.0f), zero = hn::Zero(kD);
  const F lu = light_luminance(now, inverse_light);
  F fx_weights = one, light_weights = zero;
  F3 diffuse = now.fx_diffuse, specular = now.fx_specular, fl = zero3(), later = zero3();
  for (const ClassAt& b : before) {
    const F there = hn::IfThenElseZero(hn::Gt(b.count, zero), trust);
    const F apart = hn::Add(hn::AbsDiff(now.count, b.count), one);
    const F alike =
        exp_approx(hn::Mul(rough_length(sub(now.fx_diffuse, b.fx_diffuse)), hn::Set(kD, -1.0f / kSigmaFx)));
    const F w = hn::Mul(there, hn::Div(alike, hn::Sqrt(apart)));
    fx_weights = hn::Add(fx_weights, w);
    diffuse = add_scaled(diffuse, b.fx_diffuse, w);
    specular = add_scaled(specular, b.fx_specular, w);
    // 1 / sigmoid(a (|difference| - 1)) = 1 + exp(-a (|difference| - 1))
    const F difference = hn::AbsDiff(lu, light_luminance(b, inverse_light));
    const F exponent = hn::Mul(hn::Set(kD, -kLightSlope), difference);
    const F v = hn::Mul(there, hn::MulAdd(hn::Set(kD, 20.0855369f), exp_approx(exponent), one));
    light_weights = hn::Add(light_weights, v);
    fl = add_scaled(fl, b.fl, v);
    later = add_scaled(later, b.later, v);
  }
  const F own = hn::Add(one, hn::Div(hn::Set(kD, kPresentShare), hn::Add(light_weights, hn::Set(kD, 1e-6f))));
  const F fx_norm = hn::Div(one, fx_weights), light_norm = hn::Div(one, hn::Add(own, light_weights));
  return {now.count, scale(diffuse, fx_norm), scale(specular, fx_norm),
          scale(add_scaled(fl, now.fl, own), light_norm),
          scale(add_scaled(later, now.later, own), light_norm)};
}

/// 5 x 5 bilateral filter of alpha. Differences that the number of samples explains do not count.
HWY_INLINE F filter_alpha(const DenoiseFrame& frame, int x, int y) {
  const F own = load(frame.alpha, x, y);
  const F spread = hn::Sqrt(hn::Max(load(frame.samples, x, y), hn::Set(kD, 1.0f)));
  F weights = hn::Zero(kD), sum = hn::Zero(kD);
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      // Outside the picture there are no samples.
      const auto inside = hn::Gt(load(frame.samples, x + dx, y + dy), hn::Zero(kD));
      const F alpha = load(frame.alpha, x + dx, y + dy);
      const F exponent = hn::Neg(hn::Mul(hn::AbsDiff(own, alpha), spread));
      const F spline = hn::Set(kD, kSpline[std::abs(dx)] * kSpline[std::abs(dy)]);
      const F weight = hn::IfThenElseZero(inside, hn::Mul(spline, exp_approx(exponent)));
      weights = hn::Add(weights, weight);
      sum = hn::MulAdd(weight, alpha, sum);
    }
  }
  return hn::Div(sum, hn::Max(weights, hn::Set(kD, 1e-20f)));
}

/// (alpha + w before) / (1 + w), w = exp(-(1 + |difference|)): xu2024 eq. 14, signs corrected.
HWY_INLINE F blend_alpha(F alpha, F before, F trust) {
  const F w = hn::Mul(trust, exp_approx(hn::Neg(hn::Add(hn::Set(kD, 1.0f), hn::AbsDiff(alpha, before)))));
  return hn::Div(hn::MulAdd(w, before, alpha), hn::Add(hn::Set(kD, 1.0f), w));
}

/// The second step of the light's spatial filter, all temporal filters, and the composition of what
/// scattered (xu2024 eq. 15). `moved` is null where there is no frame before.
void blend_row(const DenoiseFrame& frame, const Reprojection* moved, const DecoupledHistory& before, int y,
               DecoupledStages& stages, DecoupledHistory& now) {
  const F zero = hn::Zero(kD), inverse_light = hn::Set(kD, stages.inverse_light);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    F trust = zero, alpha = filter_alpha(frame, x, y);
    ClassAt past[2]{{zero, zero3(), zero3(), zero3(), zero3()}, {zero, zero3(), zero3(), zero3(), zero3()}};
    if (moved != nullptr) {
      const Place place = place_before(*moved, before.alpha, x, y);
      for (int l = 0; l < 2; ++l) past[l] = gather(before.classes[l], place);
      // Another surface was there: what it looked like does not count.
      const F apart = hn::AbsDiff(load(moved->depth_mm, x, y), gather(before.depth_mm, place));
      const F nearness = exp_approx(hn::Neg(hn::Mul(apart, hn::Set(kD, stages.inverse_depth_sigma))));
      trust = hn::IfThenElseZero(place.seen, nearness);
      alpha =
          blend_alpha(alpha, gather(before.alpha, place), hn::IfThenElseZero(place.seen, hn::Set(kD, 1.0f)));
    }
    store(alpha, now.alpha, x, y, lanes);
    store(load(frame.depth_mm, x, y), now.depth_mm, x, y, lanes);

    const F counts[2] = {load((*frame.classes)[0].count, x, y), load((*frame.classes)[1].count, x, y)};
    const auto empty = hn::Eq(hn::Add(counts[0], counts[1]), zero);
    F scattered = zero;
    F3 matter = zero3();
    for (int k = 0; k < 2; ++k) {
      ClassAt result{zero, zero3(), zero3(), zero3(), zero3()};
      if (!none(counts[k])) {
        const Light light = filter_light(
            frame, stages, k, x, y, 2, [&](int m) -> const Planes3& { return stages.fl[m]; },
            [&](int m) -> const Planes3& { return stages.later[m]; });
        const ClassAt present{counts[k], load(stages.fx_diffuse[k], x, y), load(stages.fx_specular[k], x, y),
                              light.fl, light.later};
        const ClassAt blended = with_history(present, past, trust, inverse_light);
        result = choose(hn::Gt(counts[k], zero), blended, result);
      }
      // A pixel that no sample scattered in keeps what it had: by chance it is empty now and again.
      result = choose(empty, past[k], result);
      store(result, now.classes[k], x, y, lanes);
      scattered = hn::Add(scattered, result.count);
      const F3 fx = add_scaled(result.fx_diffuse, result.fx_specular, hn::Set(kD, 1.0f));
      const F3 radiance{hn::MulAdd(fx.x, result.fl.x, result.later.x),
                        hn::MulAdd(fx.y, result.fl.y, result.later.y),
                        hn::MulAdd(fx.z, result.fl.z, result.later.z)};
      matter = add_scaled(matter, radiance, result.count);
    }
    const F norm = hn::Div(hn::Set(kD, 1.0f), hn::Max(scattered, hn::Set(kD, 1e-6f)));
    store(scale(matter, norm), stages.matter, x, y, lanes);
    store(scattered, stages.scattered, x, y, lanes);
  });
}

/// Premultiplied matter; a pixel without any takes what is around it.
void compose_row(const DecoupledStages& stages, const DecoupledHistory& now, int y, DenoisedFrame& out) {
  for_row(out.alpha.width(), [&](int x, std::size_t lanes) {
    const F zero = hn::Zero(kD), alpha = load(now.alpha, x, y);
    const auto lacking = hn::And(hn::Eq(load(stages.scattered, x, y), zero), hn::Gt(alpha, zero));
    F3 matter = load(stages.matter, x, y);
    if (!hn::AllFalse(kD, lacking)) {
      F weights = hn::Set(kD, 1e-20f);
      F3 sum = zero3();
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
          const F weight = load(stages.scattered, x + dx, y + dy);
          weights = hn::Add(weights, weight);
          sum = add_scaled(sum, load(stages.matter, x + dx, y + dy), weight);
        }
      }
      matter = choose(lacking, scale(sum, hn::Div(hn::Set(kD, 1.0f), weights)), matter);
    }
    store(scale(matter, alpha), out.radiance, x, y, lanes);
    store(alpha, out.alpha, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
