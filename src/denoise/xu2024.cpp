#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/xu2024.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/sample_class-inl.h"
#include "denoise/xu2024.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// a and b of xu2024 eq. 13.
constexpr float kLightSlope = 3, kPresentShare = 5;

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

HWY_INLINE ClassAt gather(const SampleClass& from, const Place& place) {
  return {gather(from.count, place),      gather(from.fx_diffuse, place),  gather(from.fx_specular, place),
          gather(from.fl_diffuse, place), gather(from.fl_specular, place), gather(from.later, place)};
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
  F3 fl_diffuse = zero3(), fl_specular = zero3(), later = zero3();
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
    fl_diffuse = add_scaled(fl_diffuse, b.fl_diffuse, v);
    fl_specular = add_scaled(fl_specular, b.fl_specular, v);
    later = add_scaled(later, b.later, v);
  }
  const F own = hn::Add(one, hn::Div(hn::Set(kD, kPresentShare), hn::Add(light_weights, hn::Set(kD, 1e-6f))));
  const F fx_norm = hn::Div(one, fx_weights), light_norm = hn::Div(one, hn::Add(own, light_weights));
  return {now.count,
          scale(diffuse, fx_norm),
          scale(specular, fx_norm),
          scale(add_scaled(fl_diffuse, now.fl_diffuse, own), light_norm),
          scale(add_scaled(fl_specular, now.fl_specular, own), light_norm),
          scale(add_scaled(later, now.later, own), light_norm)};
}

/// (alpha + w before) / (1 + w), w = exp(-(1 + |difference|)): xu2024 eq. 14, signs corrected.
HWY_INLINE F blend_alpha(F alpha, F before, F trust) {
  const F w = hn::Mul(trust, exp_approx(hn::Neg(hn::Add(hn::Set(kD, 1.0f), hn::AbsDiff(alpha, before)))));
  return hn::Div(hn::MulAdd(w, before, alpha), hn::Add(hn::Set(kD, 1.0f), w));
}

/// The temporal filters of all classes, and what the classes are together. `moved` is null where there is no
/// frame before; `now` has this frame's classes and gets the blended ones.
void blend_row(const DenoiseFrame& frame, const Reprojection* moved, const ClassHistory& before,
               BlendScales scales, int y, ClassHistory& now, Matter& out) {
  const F zero = hn::Zero(kD), inverse_light = hn::Set(kD, scales.inverse_light);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    F trust = zero, alpha = load(now.alpha, x, y);
    ClassAt past[2]{empty_class(), empty_class()};
    if (moved != nullptr) {
      const Place place = place_before(*moved, before.alpha, x, y);
      for (int l = 0; l < 2; ++l) past[l] = gather(before.classes[l], place);
      // Another surface was there: what it looked like does not count.
      const F apart = hn::AbsDiff(load(moved->depth_mm, x, y), gather(before.depth_mm, place));
      const F nearness = exp_approx(hn::Neg(hn::Mul(apart, hn::Set(kD, scales.inverse_depth_sigma))));
      trust = hn::IfThenElseZero(place.seen, nearness);
      alpha =
          blend_alpha(alpha, gather(before.alpha, place), hn::IfThenElseZero(place.seen, hn::Set(kD, 1.0f)));
    }
    store(alpha, now.alpha, x, y, lanes);
    store(load(frame.depth_mm, x, y), now.depth_mm, x, y, lanes);
    const ClassAt present[2] = {load(now.classes[0], x, y), load(now.classes[1], x, y)};
    const auto empty = hn::Eq(hn::Add(present[0].count, present[1].count), zero);
    MatterAt matter{zero3(), zero};
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
    store(mean_of(matter), out.radiance, x, y, lanes);
    store(matter.count, out.samples, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <utility>

#include "base/parallel.h"
#include "denoise/signal.h"
#include "voxlume/error.h"

namespace voxlume {

HWY_EXPORT(blend_row);

namespace {

constexpr std::int64_t kRowsAtOnce = 8;

void resize_history(ClassHistory& history, int width, int height) {
  for (SampleClass& c : history.classes) {
    c.count = Plane(width, height);
    for (Planes3* planes : {&c.fx_diffuse, &c.fx_specular, &c.fl_diffuse, &c.fl_specular, &c.later})
      *planes = make_planes3(width, height);
  }
  history.alpha = history.depth_mm = Plane(width, height);
}

/// 1 / mean luminance of the light of all samples that scattered, so that nothing depends on its unit.
float inverse_light(const DenoiseFrame& frame, std::vector<double>& row_sums) {
  row_sums.assign(static_cast<std::size_t>(frame.height) * 2, 0);
  parallel_for(frame.height, kRowsAtOnce, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    double light = 0, samples = 0;
    for (const SampleClass& c : *frame.classes) {
      for (int x = 0; x < frame.width; ++x) {
        const float count = c.count.at(x, y);
        if (!(count > 0)) continue;
        const Vec3f l(c.fl_diffuse[0].at(x, y) + c.later[0].at(x, y),
                      c.fl_diffuse[1].at(x, y) + c.later[1].at(x, y),
                      c.fl_diffuse[2].at(x, y) + c.later[2].at(x, y));
        light += count * luminance(l);
        samples += count;
      }
    }
    row_sums[2 * row] = light;
    row_sums[2 * row + 1] = samples;
  });
  double light = 0, samples = 0;
  for (std::size_t i = 0; i < row_sums.size(); i += 2) light += row_sums[i], samples += row_sums[i + 1];
  return light > 0 ? static_cast<float>(samples / light) : 1.0f;
}

}  // namespace

void Xu2024Denoiser::denoise(const DenoiseFrame& frame, DenoisedFrame& out) {
  if (!frame.classes) {
    throw Error(ErrorCode::kBadParameter, "", "the denoiser xu2024 needs the classes of samples");
  }
  if (now_.alpha.width() != frame.width || now_.alpha.height() != frame.height) {
    resize_history(now_, frame.width, frame.height);
    resize_history(before_, frame.width, frame.height);
    has_history_ = false;
  }
  matter_.resize(frame.width, frame.height);
  out.resize(frame.width, frame.height);
  filter_classes_(frame, matter_, &now_.classes);
  filter_alpha(frame.alpha, frame.samples, now_.alpha);
  const Reprojection* moved =
      has_history_ ? &reproject_(frame.camera, frame.depth_mm, camera_before_) : nullptr;
  const BlendScales scales{1 / (ClassFilters::kDepthSigma * frame.size_mm), inverse_light(frame, row_sums_)};
  parallel_for(frame.height, kRowsAtOnce, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(blend_row)(frame, moved, before_, scales, static_cast<int>(y), now_, matter_);
  });
  out.alpha = now_.alpha;
  compose(matter_, out);
  std::swap(now_, before_);
  camera_before_ = frame.camera;
  has_history_ = true;
}

}  // namespace voxlume
#endif  // HWY_ONCE
