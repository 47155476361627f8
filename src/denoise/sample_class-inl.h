// The classes of a pixel's samples in vectors; included once for every target.
#if defined(VOXLUME_DENOISE_SAMPLE_CLASS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_SAMPLE_CLASS_INL_H_
#undef VOXLUME_DENOISE_SAMPLE_CLASS_INL_H_
#else
#define VOXLUME_DENOISE_SAMPLE_CLASS_INL_H_
#endif

#include "denoise/frame.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// sigma_c of xu2024 eq. 11 and sigma_e of eq. 12, in units of a white Lambert surface's fx.
constexpr float kSigmaFx = 0.2f;
/// The length of a vector to about 1e-3; 0 for zero.
HWY_INLINE F rough_length(F3 v) {
  const F square = dot(v, v);
  return hn::Mul(square, hn::ApproximateReciprocalSqrt(hn::Max(square, hn::Set(kD, 1e-20f))));
}

HWY_INLINE bool none(F count) { return hn::AllFalse(kD, hn::Gt(count, hn::Zero(kD))); }

/// A class at a pixel.
struct ClassAt {
  F count;
  F3 fx_diffuse, fx_specular, fl_diffuse, fl_specular, later;
};

HWY_INLINE ClassAt empty_class() { return {hn::Zero(kD), zero3(), zero3(), zero3(), zero3(), zero3()}; }

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

/// What scattered at a pixel, from its classes (xu2024 eq. 15).
struct MatterAt {
  F3 sum;
  F count;
};
HWY_INLINE void add_class(const ClassAt& c, MatterAt& matter) {
  const F3 radiance =
      add(add(multiply(c.fx_diffuse, c.fl_diffuse), multiply(c.fx_specular, c.fl_specular)), c.later);
  matter.sum = add_scaled(matter.sum, radiance, c.count);
  matter.count = hn::Add(matter.count, c.count);
}
HWY_INLINE F3 mean_of(const MatterAt& matter) {
  return scale(matter.sum, hn::Div(hn::Set(kD, 1.0f), hn::Max(matter.count, hn::Set(kD, 1e-6f))));
}

HWY_INLINE ClassAt load(const SampleClass& from, int x, int y) {
  return {load(from.count, x, y),      load(from.fx_diffuse, x, y),  load(from.fx_specular, x, y),
          load(from.fl_diffuse, x, y), load(from.fl_specular, x, y), load(from.later, x, y)};
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
