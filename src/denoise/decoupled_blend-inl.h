// What the decoupled denoiser does after its spatial filters, row by row: history, composition, blending with
// the plain mean; included once for every target.
#if defined(VOXLUME_DENOISE_DECOUPLED_BLEND_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_DECOUPLED_BLEND_INL_H_
#undef VOXLUME_DENOISE_DECOUPLED_BLEND_INL_H_
#else
#define VOXLUME_DENOISE_DECOUPLED_BLEND_INL_H_
#endif

#include "denoise/decoupled_spatial-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// a and b of xu2024 eq. 13.
constexpr float kLightSlope = 3, kPresentShare = 5;
/// Variance of the difference between two filtered pictures of one moment, in units of the plain means'; what
/// is beyond is lag of the history.
constexpr float kFilteredVariance = 0.02f;
/// The least mean squared error that a filtered picture is taken to have, in the same units.
constexpr float kFilterError = 0.1f;
/// Pixels of a LocalMean.
constexpr float kWindow = (2 * LocalMean::kRadius + 1) * (2 * LocalMean::kRadius + 1);
/// Squared difference.
HWY_INLINE F squared_difference(F a, F b) {
  const F d = hn::Sub(a, b);
  return hn::Mul(d, d);
}

void luminance_row(const DenoiseFrame& frame, int y, Plane& out) {
  for_row(frame.width,
          [&](int x, std::size_t lanes) { store(luminance(load(frame.radiance, x, y)), out, x, y, lanes); });
}

/// The variance of each pixel's mean; of a single sample, which has none, its distance from those around it.
void variance_row(const DenoiseFrame& frame, const Plane& local_luminance, int y, Plane& out) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F apart = squared_difference(luminance(load(frame.radiance, x, y)), load(local_luminance, x, y));
    const auto single = hn::Lt(load(frame.samples, x, y), hn::Set(kD, 1.5f));
    store(hn::IfThenElse(single, apart, load(frame.variance, x, y)), out, x, y, lanes);
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
  F3 fx_diffuse, fx_specular, fl_diffuse, fl_specular, later;
};

HWY_INLINE ClassAt gather(const SampleClass& from, const Place& place) {
  return {gather(from.count, place),      gather(from.fx_diffuse, place),  gather(from.fx_specular, place),
          gather(from.fl_diffuse, place), gather(from.fl_specular, place), gather(from.later, place)};
}

HWY_INLINE F3 choose(hn::Mask<Floats> mask, F3 yes, F3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
HWY_INLINE ClassAt choose(hn::Mask<Floats> mask, const ClassAt& yes, const ClassAt& no) {
  return {hn::IfThenElse(mask, yes.count, no.count),     choose(mask, yes.fx_diffuse, no.fx_diffuse),
          choose(mask, yes.fx_specular, no.fx_specular), choose(mask, yes.fl_diffuse, no.fl_diffuse),
          choose(mask, yes.fl_specular, no.fl_specular), choose(mask, yes.later, no.later)};
}
HWY_INLINE void store(const ClassAt& from, SampleClass& to, int x, int y, std::size_t lanes) {
  store(from.count, to.count, x, y, lanes);
  store(from.fx_diffuse, to.fx_diffuse, x, y, lanes);
  store(from.fx_specular, to.fx_specular, x, y, lanes);
  store(from.fl_diffuse, to.fl_diffuse, x, y, lanes);
  store(from.fl_specular, to.fl_specular, x, y, lanes);
  store(from.later, to.later, x, y, lanes);
}

/// The luminance of the light of a class, in units of the frame's.
HWY_INLINE F light_luminance(const ClassAt& c, F inverse_light) {
  return hn::Mul(hn::Add(luminance(c.fl_diffuse), luminance(c.later)), inverse_light);
}

/// Temporal filters of a class (xu2024 eqs. 12 and 13) over the classes of the frame before, each of which
/// counts `trust` in [0,1].
HWY_INLINE ClassAt with_history(const ClassAt& now, const ClassAt (&before)[2], F trust, F inverse_light) {
  const F one = hn::Set(kD, 1.0f), zero = hn::Zero(kD);
  const F lu = light_luminance(now, inverse_light);
  F fx_weights = one, light_weights = zero;
  F3 diffuse = now.fx_diffuse, specular = now.fx_specular;
  Light light{zero3(), zero3(), zero3()};
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
    light.fl_diffuse = add_scaled(light.fl_diffuse, b.fl_diffuse, v);
    light.fl_specular = add_scaled(light.fl_specular, b.fl_specular, v);
    light.later = add_scaled(light.later, b.later, v);
  }
  const F own = hn::Add(one, hn::Div(hn::Set(kD, kPresentShare), hn::Add(light_weights, hn::Set(kD, 1e-6f))));
  const F fx_norm = hn::Div(one, fx_weights), light_norm = hn::Div(one, hn::Add(own, light_weights));
  return {now.count,
          scale(diffuse, fx_norm),
          scale(specular, fx_norm),
          scale(add_scaled(light.fl_diffuse, now.fl_diffuse, own), light_norm),
          scale(add_scaled(light.fl_specular, now.fl_specular, own), light_norm),
          scale(add_scaled(light.later, now.later, own), light_norm)};
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

/// How far an estimate is from the truth, where it is `apart` (mean squared) from means of variance
/// `variance`: its mean squared error is what the variance does not explain.
HWY_INLINE F error_beyond(F apart, F variance) { return hn::Max(hn::Sub(apart, variance), hn::Zero(kD)); }

/// Radiance of what scattered at a pixel, from its classes (xu2024 eq. 15).
struct Matter {
  F3 sum;
  F count;
};
HWY_INLINE void add_class(const ClassAt& c, Matter& matter) {
  const F3 radiance =
      add(add(multiply(c.fx_diffuse, c.fl_diffuse), multiply(c.fx_specular, c.fl_specular)), c.later);
  matter.sum = add_scaled(matter.sum, radiance, c.count);
  matter.count = hn::Add(matter.count, c.count);
}
HWY_INLINE F3 mean_of(const Matter& matter) {
  return scale(matter.sum, hn::Div(hn::Set(kD, 1.0f), hn::Max(matter.count, hn::Set(kD, 1e-6f))));
}

HWY_INLINE ClassAt load(const SampleClass& from, int x, int y) {
  return {load(from.count, x, y),      load(from.fx_diffuse, x, y),  load(from.fx_specular, x, y),
          load(from.fl_diffuse, x, y), load(from.fl_specular, x, y), load(from.later, x, y)};
}

/// The second step of the light's spatial filter, and how far the result is from the frame before. `moved` is
/// null where there is none.
void filter_light_again_row(const DenoiseFrame& frame, const Reprojection* moved,
                            const Plane& luminance_before, int y, DecoupledStages& stages,
                            DecoupledHistory& now) {
  const F zero = hn::Zero(kD);
  const LightTaps taps = light_taps(frame, 2);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    Matter matter{zero3(), zero};
    const F counts[2] = {load((*frame.classes)[0].count, x, y), load((*frame.classes)[1].count, x, y)};
    const Light dark{zero3(), zero3(), zero3()};
    Light light[2]{dark, dark};
    if (!none(hn::Add(counts[0], counts[1]))) {
      filter_light(
          frame, stages, taps, x, y, !none(counts[1]),
          [&](int m) -> LightPlanes {
            return {stages.fl_diffuse[m], stages.fl_specular[m], stages.later[m]};
          },
          light);
    }
    for (int k = 0; k < 2; ++k) {
      const ClassAt filtered{counts[k],
                             load(stages.fx_diffuse[k], x, y),
                             load(stages.fx_specular[k], x, y),
                             light[k].fl_diffuse,
                             light[k].fl_specular,
                             light[k].later};
      const ClassAt nothing{zero, zero3(), zero3(), zero3(), zero3(), zero3()};
      const ClassAt result = choose(hn::Gt(counts[k], zero), filtered, nothing);
      store(result, now.classes[k], x, y, lanes);
      add_class(result, matter);
    }
    if (moved == nullptr) return;
    const Place place = place_before(*moved, luminance_before, x, y);
    const F before = gather(luminance_before, place);
    const F here = hn::Mul(luminance(mean_of(matter)), load(frame.alpha, x, y));
    store(hn::IfThenElseZero(hn::Gt(matter.count, zero), squared_difference(here, before)), stages.error, x,
          y, lanes);
  });
}

/// All temporal filters, and the composition of what scattered (xu2024 eq. 15). `moved` is null where there
/// is no frame before.
void blend_row(const DenoiseFrame& frame, const Reprojection* moved, const DecoupledHistory& before, int y,
               DecoupledStages& stages, DecoupledHistory& now) {
  const F zero = hn::Zero(kD), inverse_light = hn::Set(kD, stages.inverse_light);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    F trust = zero, alpha = filter_alpha(frame, x, y);
    ClassAt past[2]{{zero, zero3(), zero3(), zero3(), zero3(), zero3()},
                    {zero, zero3(), zero3(), zero3(), zero3(), zero3()}};
    if (moved != nullptr) {
      const Place place = place_before(*moved, before.alpha, x, y);
      for (int l = 0; l < 2; ++l) past[l] = gather(before.classes[l], place);
      // Another surface was there: what it looked like does not count.
      const F apart = hn::AbsDiff(load(moved->depth_mm, x, y), gather(before.depth_mm, place));
      const F nearness = exp_approx(hn::Neg(hn::Mul(apart, hn::Set(kD, stages.inverse_depth_sigma))));
      const F v = hn::Mul(load(stages.variance, x, y), hn::Set(kD, kFilteredVariance));
      const F lag = error_beyond(load(stages.error, x, y), v);
      const F steady =
          hn::Div(hn::Add(v, hn::Set(kD, 1e-30f)), hn::Add(hn::Add(v, lag), hn::Set(kD, 1e-30f)));
      trust = hn::IfThenElseZero(place.seen, hn::Mul(nearness, steady));
      alpha =
          blend_alpha(alpha, gather(before.alpha, place), hn::IfThenElseZero(place.seen, hn::Set(kD, 1.0f)));
    }
    store(alpha, now.alpha, x, y, lanes);
    store(load(frame.depth_mm, x, y), now.depth_mm, x, y, lanes);
    const ClassAt present[2] = {load(now.classes[0], x, y), load(now.classes[1], x, y)};
    const auto empty = hn::Eq(hn::Add(present[0].count, present[1].count), zero);
    Matter matter{zero3(), zero};
    for (int k = 0; k < 2; ++k) {
      ClassAt result = present[k];
      if (!none(present[k].count)) {
        const ClassAt blended = with_history(present[k], past, trust, inverse_light);
        result = choose(hn::Gt(present[k].count, zero), blended, result);
      }
      // A pixel that no sample scattered in keeps what it had: by chance it is empty now and again.
      result = choose(empty, past[k], result);
      store(result, now.classes[k], x, y, lanes);
      add_class(result, matter);
    }
    store(mean_of(matter), stages.matter, x, y, lanes);
    store(matter.count, stages.scattered, x, y, lanes);
  });
}

/// Premultiplied matter; a pixel without any takes what is around it.
void compose_row(const DenoiseFrame& frame, const DecoupledStages& stages, const DecoupledHistory& now, int y,
                 DenoisedFrame& out, Planes3& residual, Plane& luminance_out) {
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
    const F3 radiance = scale(matter, alpha);
    store(radiance, out.radiance, x, y, lanes);
    store(alpha, out.alpha, x, y, lanes);
    store(luminance(radiance), luminance_out, x, y, lanes);
    store(sub(load(frame.radiance, x, y), radiance), residual, x, y, lanes);
  });
}

/// Gives back what the filters took from a neighbourhood as a whole, as far as it is more than noise;
/// `residual` is what the means have beyond the filtered picture, averaged around each pixel.
void restore_row(const DenoiseFrame& frame, const Plane& variance, const Planes3& residual, int y,
                 DenoisedFrame& out, Plane& error) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F3 lost = load(residual, x, y);
    const F y_lost = luminance(lost);
    const F squared = hn::Mul(y_lost, y_lost);
    const F noise = hn::Mul(load(variance, x, y), hn::Set(kD, 1.0f / kWindow));
    const F share = hn::Div(squared, hn::Add(hn::Add(squared, noise), hn::Set(kD, 1e-30f)));
    const auto matter = hn::Gt(load(out.alpha, x, y), hn::Zero(kD));
    const F3 kept = load(out.radiance, x, y);
    F3 radiance = add_scaled(kept, lost, hn::IfThenElseZero(matter, share));
    const F zero = hn::Zero(kD);
    radiance = {hn::Max(radiance.x, zero), hn::Max(radiance.y, zero), hn::Max(radiance.z, zero)};
    store(radiance, out.radiance, x, y, lanes);
    store(squared_difference(luminance(radiance), luminance(load(frame.radiance, x, y))), error, x, y, lanes);
  });
}

/// Goes over from the filtered picture to the plain mean where the filter's error is larger than the mean's
/// variance: each counts by the inverse of its mean squared error.
void blend_mean_row(const DenoiseFrame& frame, const Plane& variance, const Plane& error, int y,
                    DenoisedFrame& out) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F v = load(variance, x, y);
    const F filter_error = hn::MulAdd(v, hn::Set(kD, kFilterError), error_beyond(load(error, x, y), v));
    // v = 0: nothing is known of one sample's variance, or nothing varies.
    const F share =
        hn::IfThenElseZero(hn::Gt(v, hn::Zero(kD)), hn::Div(filter_error, hn::Add(filter_error, v)));
    const F3 filtered = load(out.radiance, x, y), mean = load(frame.radiance, x, y);
    const F3 radiance = add_scaled(filtered, sub(mean, filtered), share);
    const F alpha = load(out.alpha, x, y);
    store(radiance, out.radiance, x, y, lanes);
    store(hn::MulAdd(hn::Sub(load(frame.alpha, x, y), alpha), share, alpha), out.alpha, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
