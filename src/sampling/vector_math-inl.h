// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_SAMPLING_VECTOR_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_SAMPLING_VECTOR_MATH_INL_H_
#undef VOXLUME_SAMPLING_VECTOR_MATH_INL_H_
#else
#define VOXLUME_SAMPLING_VECTOR_MATH_INL_H_
#endif

#include <hwy/highway.h>

#include "base/affine.h"
#include "base/vec.h"
#include "sampling/elementary.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// Twins of base/vec.h and sampling/elementary.h. F is a vector of floats, one a lane.

template <class F>
F broadcast(float x) {
  return hn::Set(hn::DFromV<F>(), x);
}
/// std::min and std::max, in zeros and NaN too.
template <class F>
F lesser(F a, F b) {
  return hn::IfThenElse(hn::Lt(b, a), b, a);
}
template <class F>
F greater(F a, F b) {
  return hn::IfThenElse(hn::Lt(a, b), b, a);
}
template <class F>
F clamped(F x, float lower, float upper) {
  return lesser(greater(x, broadcast<F>(lower)), broadcast<F>(upper));
}

/// Vec3.
template <class F>
struct Vector3 {
  F x, y, z;
};
template <class F>
HWY_INLINE Vector3<F> operator+(Vector3<F> a, Vector3<F> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class F>
HWY_INLINE Vector3<F> operator-(Vector3<F> a, Vector3<F> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class F>
HWY_INLINE Vector3<F> operator*(Vector3<F> a, F s) {
  return {a.x * s, a.y * s, a.z * s};
}
template <class F>
HWY_INLINE Vector3<F> operator/(Vector3<F> a, F s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class F>
HWY_INLINE Vector3<F> operator-(Vector3<F> a) {
  return {hn::Neg(a.x), hn::Neg(a.y), hn::Neg(a.z)};
}
template <class F>
HWY_INLINE F dot(Vector3<F> a, Vector3<F> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
HWY_INLINE Vector3<F> cross(Vector3<F> a, Vector3<F> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F>
HWY_INLINE F length(Vector3<F> v) {
  return hn::Sqrt(dot(v, v));
}
template <class F>
HWY_INLINE Vector3<F> normalize(Vector3<F> v) {
  return v * (broadcast<F>(1.0f) / length(v));
}
template <class F>
HWY_INLINE F luminance(Vector3<F> rgb) {
  return broadcast<F>(0.2126f) * rgb.x + broadcast<F>(0.7152f) * rgb.y + broadcast<F>(0.0722f) * rgb.z;
}
template <class F>
Vector3<F> broadcast(Vec3f v) {
  return {broadcast<F>(v.x), broadcast<F>(v.y), broadcast<F>(v.z)};
}
template <class M, class F>
Vector3<F> choose(M mask, Vector3<F> yes, Vector3<F> no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}
template <class M, class F>
Vector3<F> choose_or_zero(M mask, Vector3<F> v) {
  return {hn::IfThenElseZero(mask, v.x), hn::IfThenElseZero(mask, v.y), hn::IfThenElseZero(mask, v.z)};
}
/// Affinef::vector and Affinef::point.
template <class F>
Vector3<F> mapped_vector(const Affinef& map, Vector3<F> v) {
  return broadcast<F>(map.column_x) * v.x + broadcast<F>(map.column_y) * v.y +
         broadcast<F>(map.column_z) * v.z;
}
template <class F>
Vector3<F> mapped_point(const Affinef& map, Vector3<F> p) {
  return mapped_vector(map, p) + broadcast<F>(map.translation);
}

/// Frame.
template <class F>
struct VectorFrame {
  Vector3<F> x, y, z;
};
template <class F>
HWY_INLINE VectorFrame<F> vector_frame(Vector3<F> n) {
  const F one = broadcast<F>(1.0f);
  const F sign = hn::CopySign(one, n.z);
  const F a = broadcast<F>(-1.0f) / (sign + n.z);
  const F b = n.x * n.y * a;
  return {{one + sign * n.x * n.x * a, sign * b, hn::Neg(sign) * n.x},
          {b, sign + n.y * n.y * a, hn::Neg(n.y)},
          n};
}
template <class F>
HWY_INLINE Vector3<F> to_world(const VectorFrame<F>& frame, Vector3<F> local) {
  return frame.x * local.x + frame.y * local.y + frame.z * local.z;
}
template <class F>
HWY_INLINE Vector3<F> to_local(const VectorFrame<F>& frame, Vector3<F> world) {
  return {dot(frame.x, world), dot(frame.y, world), dot(frame.z, world)};
}

/// sine_cosine_of_turns.
template <class F>
void vector_sine_cosine_of_turns(F turns, F& sine, F& cosine) {
  const hn::DFromV<F> d;
  const hn::RebindToSigned<decltype(d)> di;
  const auto quarter = hn::ConvertTo(di, broadcast<F>(4.0f) * turns + broadcast<F>(4.5f)) - hn::Set(di, 4);
  const F x = (turns - broadcast<F>(0.25f) * hn::ConvertTo(d, quarter)) * broadcast<F>(kTwoPi), x2 = x * x;
  F s = broadcast<F>(kSinePolynomial[0]), c = broadcast<F>(kCosinePolynomial[0]);
  for (int i = 1; i < 3; ++i) {
    s = s * x2 + broadcast<F>(kSinePolynomial[i]);
    c = c * x2 + broadcast<F>(kCosinePolynomial[i]);
  }
  s = (s * x2) * x + x;
  c = ((c * x2) * x2 - broadcast<F>(0.5f) * x2) + broadcast<F>(1.0f);
  const auto swapped = hn::RebindMask(d, hn::TestBit(quarter, hn::Set(di, 1)));
  const auto sign = [&](auto n) { return hn::BitCast(d, hn::ShiftLeft<30>(hn::And(n, hn::Set(di, 2)))); };
  sine = hn::Xor(hn::IfThenElse(swapped, c, s), sign(quarter));
  cosine = hn::Xor(hn::IfThenElse(swapped, s, c), sign(quarter + hn::Set(di, 1)));
}

/// one_minus_exp.
template <class F>
F vector_one_minus_exp(F x) {
  const hn::DFromV<F> d;
  const hn::RebindToSigned<decltype(d)> di;
  const F end = broadcast<F>(kExpEnd), one = broadcast<F>(1.0f);
  const F within = hn::IfThenElse(hn::Lt(x, end), x, end);
  const auto halvings = hn::ConvertTo(di, within * broadcast<F>(kLog2OfE) + broadcast<F>(0.5f));
  const F n = hn::ConvertTo(d, halvings);
  const F r = (n * broadcast<F>(kExpLn2High) - within) + n * broadcast<F>(kExpLn2Low);
  F p = broadcast<F>(kExpPolynomial[0]);
  for (int i = 1; i < 6; ++i) p = p * r + broadcast<F>(kExpPolynomial[i]);
  const F expm1 = (p * r) * r + r;
  const F scale = hn::BitCast(d, hn::ShiftLeft<23>(hn::Set(di, 127) - halvings));
  return (one - scale) - scale * expm1;
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
