#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/class_filters.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cmath>
#include <cstdlib>

#include "denoise/class_filters.h"
#include "denoise/guides-inl.h"
#include "denoise/row-inl.h"
#include "denoise/sample_class-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// B3 spline: 3/8, 1/4, 1/16 by distance.
constexpr float kSpline[] = {3.0f / 8, 1.0f / 4, 1.0f / 16};

/// -(|fx - fx'| / sigma + |d - d'| / sigma_d), of which a tap's weight is the exponential.
HWY_INLINE F tap_exponent(F3 fx, F3 fx_there, F depth, F depth_there, F inverse_depth_sigma) {
  const F colour = hn::Mul(rough_length(sub(fx, fx_there)), hn::Set(kD, -1.0f / kSigmaFx));
  return hn::NegMulAdd(hn::AbsDiff(depth, depth_there), inverse_depth_sigma, colour);
}

HWY_INLINE void clear(Planes3& planes, int x, int y, std::size_t lanes) {
  store(zero3(), planes, x, y, lanes);
}

/// Spatial filter of fx (xu2024 eq. 11) over all classes of 3 x 3 pixels. A class counts by its samples.
void filter_fx_row(const DenoiseFrame& frame, int y, ClassStages& stages) {
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

/// The light of one class.
struct LightPlanes {
  const Planes3 &fl_diffuse, &fl_specular, &later;
};

/// Light of one class, filtered at one pixel.
struct Light {
  F3 fl_diffuse, fl_specular, later;
};

/// 5 x 5 taps, `step` pixels apart.
using LightTaps = std::array<Tap, 25>;
HWY_INLINE LightTaps light_taps(const DenoiseFrame& frame, int step) {
  return make_taps<2>(frame.alpha.stride(), step, {kSpline[0], kSpline[1], kSpline[2]});
}

/// What a class adds up from its neighbours, with the sums of the weights.
struct LightSums {
  F weights, diffuse_weights, specular_weights;
  Light light;
};

/// A neighbour's class, which counts for as much as its weight says; fl for as much as fx as well, so that
/// the sums are of direct light over those of fx.
struct LightThere {
  F3 fx_diffuse;
  F fx_luminance, fx_specular, count;
  Light light;
};

HWY_INLINE void add_light(const LightThere& there, F3 own_fx, F alike, LightSums& sums) {
  const F colour =
      hn::MulAdd(rough_length(sub(own_fx, there.fx_diffuse)), hn::Set(kD, -1.0f / kSigmaFx), alike);
  const F weight = hn::Mul(there.count, exp_approx(colour));
  const F diffuse_weight = hn::Mul(weight, there.fx_luminance);
  const F specular_weight = hn::Mul(weight, there.fx_specular);
  sums.weights = hn::Add(sums.weights, weight);
  sums.diffuse_weights = hn::Add(sums.diffuse_weights, diffuse_weight);
  sums.specular_weights = hn::Add(sums.specular_weights, specular_weight);
  sums.light.fl_diffuse = add_scaled(sums.light.fl_diffuse, there.light.fl_diffuse, diffuse_weight);
  sums.light.fl_specular = add_scaled(sums.light.fl_specular, there.light.fl_specular, specular_weight);
  sums.light.later = add_scaled(sums.light.later, there.light.later, weight);
}

HWY_INLINE Light mean_light(const LightSums& sums) {
  const F one = hn::Set(kD, 1.0f);
  return {scale(sums.light.fl_diffuse, hn::Div(one, sums.diffuse_weights)),
          scale(sums.light.fl_specular, hn::Div(one, sums.specular_weights)),
          scale(sums.light.later, hn::Div(one, sums.weights))};
}

/// One step of the light's spatial filter (xu2024 5.3.2), guided by the filtered fx and by what tells matter
/// apart (depth and, beyond the paper, the normal), over all classes. `light_of` gives a class its light;
/// `both`: the pixels have samples of the second class, else only the first is filtered.
template <class LightOf>
HWY_INLINE void filter_light(const DenoiseFrame& frame, const ClassStages& stages, const LightTaps& taps,
                             int x, int y, bool both, const LightOf& light_of, Light (&out)[2]) {
  const GuideRows guides(stages.guides, y);
  const GuideCentre centre = guide_centre(guides, x);
  const F3 own[2] = {load(stages.fx_diffuse[0], x, y), load(stages.fx_diffuse[1], x, y)};
  const F little = hn::Set(kD, 1e-30f);
  const Light dark{zero3(), zero3(), zero3()};
  LightSums sums[2]{{little, little, little, dark}, {little, little, little, dark}};
  for (const Tap& tap : taps) {
    const auto at = [&](const Plane& plane) { return hn::LoadU(kD, plane.row(y) + x + tap.offset); };
    const auto at3 = [&](const Planes3& planes) { return F3{at(planes[0]), at(planes[1]), at(planes[2])}; };
    const F counts[2] = {at((*frame.classes)[0].count), at((*frame.classes)[1].count)};
    if (none(hn::Add(counts[0], counts[1]))) continue;
    const F alike = log_weight(centre, guides, x, tap);
    for (int m = 0; m < 2; ++m) {
      if (none(counts[m])) continue;
      const LightPlanes planes = light_of(m);
      const F3 fx = at3(stages.fx_diffuse[m]);
      const LightThere there{fx,
                             luminance(fx),
                             at(stages.fx_specular[m][1]),
                             counts[m],
                             {at3(planes.fl_diffuse), at3(planes.fl_specular), at3(planes.later)}};
      add_light(there, own[0], alike, sums[0]);
      if (both) add_light(there, own[1], alike, sums[1]);
    }
  }
  out[0] = mean_light(sums[0]);
  out[1] = both ? mean_light(sums[1]) : dark;
}

/// The first step: neighbouring taps.
void filter_light_row(const DenoiseFrame& frame, int y, ClassStages& stages) {
  const std::array<SampleClass, 2>& classes = *frame.classes;
  const LightTaps taps = light_taps(frame, 1);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F counts[2] = {load(classes[0].count, x, y), load(classes[1].count, x, y)};
    const Light dark{zero3(), zero3(), zero3()};
    Light light[2]{dark, dark};
    if (!none(hn::Add(counts[0], counts[1]))) {
      filter_light(
          frame, stages, taps, x, y, !none(counts[1]),
          [&](int m) -> LightPlanes {
            return {classes[m].fl_diffuse, classes[m].fl_specular, classes[m].later};
          },
          light);
    }
    for (int k = 0; k < 2; ++k) {
      store(light[k].fl_diffuse, stages.fl_diffuse[k], x, y, lanes);
      store(light[k].fl_specular, stages.fl_specular[k], x, y, lanes);
      store(light[k].later, stages.later[k], x, y, lanes);
    }
  });
}

/// The second step, and what both classes are together. `classes` is null where nobody asks for them.
void filter_light_again_row(const DenoiseFrame& frame, const ClassStages& stages, int y, Matter& out,
                            std::array<SampleClass, 2>* classes) {
  const F zero = hn::Zero(kD);
  const LightTaps taps = light_taps(frame, 2);
  for_row(frame.width, [&](int x, std::size_t lanes) {
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
    MatterAt matter{zero3(), zero};
    for (int k = 0; k < 2; ++k) {
      const ClassAt filtered{counts[k],
                             load(stages.fx_diffuse[k], x, y),
                             load(stages.fx_specular[k], x, y),
                             light[k].fl_diffuse,
                             light[k].fl_specular,
                             light[k].later};
      const ClassAt result = choose(hn::Gt(counts[k], zero), filtered, empty_class());
      add_class(result, matter);
      if (classes != nullptr) store(result, (*classes)[k], x, y, lanes);
    }
    store(mean_of(matter), out.radiance, x, y, lanes);
    store(matter.count, out.samples, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/parallel.h"

namespace voxlume {

HWY_EXPORT(filter_fx_row);
HWY_EXPORT(filter_light_row);
HWY_EXPORT(filter_light_again_row);

void ClassFilters::operator()(const DenoiseFrame& frame, Matter& out, std::array<SampleClass, 2>* classes) {
  if (stages_.later[0][0].width() != frame.width || stages_.later[0][0].height() != frame.height) {
    for (std::array<Planes3, 2>* both : {&stages_.fx_diffuse, &stages_.fx_specular, &stages_.fl_diffuse,
                                         &stages_.fl_specular, &stages_.later})
      for (Planes3& planes : *both) planes = make_planes3(frame.width, frame.height);
  }
  stages_.inverse_depth_sigma = 1 / (kDepthSigma * frame.size_mm);
  const auto for_rows = [&](const auto& body) {
    parallel_for(frame.height, 8, [&](std::int64_t y) { body(static_cast<int>(y)); });
  };
  make_guides(frame, stages_.guides);
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(filter_fx_row)(frame, y, stages_); });
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(filter_light_row)(frame, y, stages_); });
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(filter_light_again_row)(frame, stages_, y, out, classes); });
}

}  // namespace voxlume
#endif  // HWY_ONCE
