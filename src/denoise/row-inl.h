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
HWY_INLINE F3 sub(F3 a, F3 b) { return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)}; }
HWY_INLINE F3 scale(F3 a, F s) { return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)}; }
HWY_INLINE F dot(F3 a, F3 b) { return hn::MulAdd(a.x, b.x, hn::MulAdd(a.y, b.y, hn::Mul(a.z, b.z))); }
/// Of linear Rec. 709.
HWY_INLINE F luminance(F3 c) { return dot(c, set({0.2126f, 0.7152f, 0.0722f})); }

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
