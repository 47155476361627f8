// The spatial filters of the decoupled denoiser, row by row; included once for every target.
#if defined(VOXLUME_DENOISE_DECOUPLED_SPATIAL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_DECOUPLED_SPATIAL_INL_H_
#undef VOXLUME_DENOISE_DECOUPLED_SPATIAL_INL_H_
#else
#define VOXLUME_DENOISE_DECOUPLED_SPATIAL_INL_H_
#endif

#include <cmath>
#include <cstdlib>

#include "denoise/decoupled.h"
#include "denoise/guides-inl.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// sigma_c of xu2024 eq. 11 and sigma_e of eq. 12, in units of a white Lambert surface's fx.
constexpr float kSigmaFx = 0.2f;
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

/// The light of one class.
struct LightPlanes {
  const Planes3 &fl_diffuse, &fl_specular, &later;
};

/// Light of one class, filtered at one pixel.
struct Light {
  F3 fl_diffuse, fl_specular, later;
};

/// One step of the light's spatial filter (xu2024 5.3.2): 5 x 5 taps, guided by the filtered fx and by what
/// tells matter apart (depth and, beyond the paper, the normal), over all classes. `light_of` gives a class
/// its light.
template <class LightOf>
HWY_INLINE Light filter_light(const DenoiseFrame& frame, const DecoupledStages& stages, int k, int x, int y,
                              int step, const LightOf& light_of) {
  const GuideRows guides(stages.guides, y);
  const GuideCentre centre = guide_centre(guides, x);
  const F3 own = load(stages.fx_diffuse[k], x, y);
  F weights = hn::Set(kD, 1e-30f), diffuse_weights = weights, specular_weights = weights;
  Light sum{zero3(), zero3(), zero3()};
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const int there_x = x + dx * step, there_y = y + dy * step;
      const float distance = static_cast<float>(step) * std::sqrt(static_cast<float>(dx * dx + dy * dy));
      const Tap tap{static_cast<std::ptrdiff_t>(dy * step) * frame.alpha.stride() + dx * step,
                    std::log(kSpline[std::abs(dx)] * kSpline[std::abs(dy)]), distance > 0 ? 1 / distance : 0};
      const F alike = log_weight(centre, guides, x, tap);
      for (int m = 0; m < 2; ++m) {
        const F count = load((*frame.classes)[m].count, there_x, there_y);
        if (none(count)) continue;
        const F3 fx = load(stages.fx_diffuse[m], there_x, there_y);
        const F weight = hn::Mul(
            count, exp_approx(hn::MulAdd(rough_length(sub(own, fx)), hn::Set(kD, -1.0f / kSigmaFx), alike)));
        const F diffuse_weight = hn::Mul(weight, luminance(fx));
        const F specular_weight = hn::Mul(weight, load(stages.fx_specular[m][1], there_x, there_y));
        weights = hn::Add(weights, weight);
        diffuse_weights = hn::Add(diffuse_weights, diffuse_weight);
        specular_weights = hn::Add(specular_weights, specular_weight);
        const LightPlanes light = light_of(m);
        sum.fl_diffuse = add_scaled(sum.fl_diffuse, load(light.fl_diffuse, there_x, there_y), diffuse_weight);
        sum.fl_specular =
            add_scaled(sum.fl_specular, load(light.fl_specular, there_x, there_y), specular_weight);
        sum.later = add_scaled(sum.later, load(light.later, there_x, there_y), weight);
      }
    }
  }
  const F one = hn::Set(kD, 1.0f);
  return {scale(sum.fl_diffuse, hn::Div(one, diffuse_weights)),
          scale(sum.fl_specular, hn::Div(one, specular_weights)), scale(sum.later, hn::Div(one, weights))};
}

/// The first step: neighbouring taps.
void filter_light_row(const DenoiseFrame& frame, int y, DecoupledStages& stages) {
  const std::array<SampleClass, 2>& classes = *frame.classes;
  for_row(frame.width, [&](int x, std::size_t lanes) {
    for (int k = 0; k < 2; ++k) {
      const F count = load(classes[k].count, x, y);
      Light light{zero3(), zero3(), zero3()};
      if (!none(count)) {
        light = filter_light(frame, stages, k, x, y, 1, [&](int m) -> LightPlanes {
          return {classes[m].fl_diffuse, classes[m].fl_specular, classes[m].later};
        });
      }
      store(light.fl_diffuse, stages.fl_diffuse[k], x, y, lanes);
      store(light.fl_specular, stages.fl_specular[k], x, y, lanes);
      store(light.later, stages.later[k], x, y, lanes);
    }
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
