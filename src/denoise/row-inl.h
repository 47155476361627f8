// Vectors over a row of a Plane; included once for every target (no include guard of the usual kind).
#if defined(VOXLUME_DENOISE_ROW_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_ROW_INL_H_
#undef VOXLUME_DENOISE_ROW_INL_H_
#else
#define VOXLUME_DENOISE_ROW_INL_H_
#endif

#include <hwy/highway.h>

#include <algorithm>

#include "base/vec.h"
#include "denoise/plane.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using F = hn::Vec<Floats>;
constexpr Floats kD;

/// Three vectors: colours or points, one a lane.
struct F3 {
  F x, y, z;
};

HWY_INLINE F3 set(Vec3f v) { return {hn::Set(kD, v.x), hn::Set(kD, v.y), hn::Set(kD, v.z)}; }
HWY_INLINE F3 zero3() { return {hn::Zero(kD), hn::Zero(kD), hn::Zero(kD)}; }
/// a + b * s
HWY_INLINE F3 add_scaled(F3 a, F3 b, F s) {
  return {hn::MulAdd(b.x, s, a.x), hn::MulAdd(b.y, s, a.y), hn::MulAdd(b.z, s, a.z)};
}
HWY_INLINE F3 add(F3 a, F3 b) { return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)}; }
/// By component.
HWY_INLINE F3 multiply(F3 a, F3 b) { return {hn::Mul(a.x, b.x), hn::Mul(a.y, b.y), hn::Mul(a.z, b.z)}; }
HWY_INLINE F3 sub(F3 a, F3 b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE F3 scale(F3 a, F s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
HWY_INLINE F dot(F3 a, F3 b) { return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z))); }
HWY_INLINE F3 choose(hn::Mask<Floats> mask, F3 yes, F3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
/// Of linear Rec. 709.
HWY_INLINE F luminance(F3 c) { return dot(c, set({0.2126f, 0.7152f, 0.0722f})); }

/// 1 / x, or 0 where x is too small to divide by.
HWY_INLINE F inverse_or_zero(F x) {
  return hn::IfThenElseZero(hn::Gt(x, hn::Set(kD, 1e-20f)), hn::Div(hn::Set(kD, 1.0f), x));
}

/// What lies at column x of row y and right of it; x and y may be in the border.
HWY_INLINE F load(const Plane& plane, int x, int y) { return hn::LoadU(kD, plane.row(y) + x); }
HWY_INLINE F3 load(const Planes3& planes, int x, int y) {
  return {load(planes[0], x, y), load(planes[1], x, y), load(planes[2], x, y)};
}
/// Writes the first `lanes` values.
HWY_INLINE void store(F value, Plane& plane, int x, int y, std::size_t lanes) {
  hn::BlendedStore(value, hn::FirstN(kD, lanes), kD, plane.row(y) + x);
}
HWY_INLINE void store(F3 value, Planes3& planes, int x, int y, std::size_t lanes) {
  store(value.x, planes[0], x, y, lanes);
  store(value.y, planes[1], x, y, lanes);
  store(value.z, planes[2], x, y, lanes);
}

/// e^x for x <= 0, for weights: relative error below 1.1e-4 down to x = -87, and exact at 0. Below that it
/// stays at 2^-126, so that a weight is never zero where its factors are not. 2^n comes from the exponent's
/// bits and 2^f, |f| <= 1/2, from the cubic of least relative error that is 1 at 0.
HWY_INLINE F exp_approx(F x) {
  const F y = hn::Max(hn::Mul(x, hn::Set(kD, 1.44269504f)), hn::Set(kD, -126.0f));
  const F shift = hn::Set(kD, 12582912.0f);  // 1.5 * 2^23: what is added to it is rounded to an integer
  const F shifted = hn::Add(y, shift);
  const F f = hn::Sub(y, hn::Sub(shifted, shift));
  F power = hn::MulAdd(hn::Set(kD, 0.055009029f), f, hn::Set(kD, 0.24221099f));
  power = hn::MulAdd(hn::MulAdd(power, f, hn::Set(kD, 0.69328291f)), f, hn::Set(kD, 1.0f));
  const hn::RebindToSigned<Floats> integers;
  const auto exponent = hn::ShiftLeft<23>(hn::BitCast(integers, shifted));
  return hn::BitCast(kD, hn::Add(hn::BitCast(integers, power), exponent));
}

/// Calls body(x, lanes) for the columns of a row, a vector at a time: `lanes` of it are inside the picture.
template <class Body>
HWY_INLINE void for_row(int width, const Body& body) {
  const int step = static_cast<int>(hn::Lanes(kD));
  for (int x = 0; x < width; x += step) body(x, static_cast<std::size_t>(std::min(step, width - x)));
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
