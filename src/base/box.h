#pragma once
#include <limits>

#include "base/vec.h"

namespace voxlume {

/// Axis-aligned box; empty when lower > upper on some axis.
template <class T>
struct Box3 {
  Vec3<T> lower{std::numeric_limits<T>::max()};
  Vec3<T> upper{std::numeric_limits<T>::lowest()};

  constexpr bool empty() const { return lower.x > upper.x || lower.y > upper.y || lower.z > upper.z; }
  constexpr void extend(Vec3<T> p) {
    lower = min(lower, p);
    upper = max(upper, p);
  }
  constexpr Vec3<T> center() const { return (lower + upper) * T(0.5); }
  constexpr Vec3<T> extent() const { return upper - lower; }
  constexpr bool contains(Vec3<T> p) const {
    return p.x >= lower.x && p.y >= lower.y && p.z >= lower.z && p.x <= upper.x && p.y <= upper.y &&
           p.z <= upper.z;
  }
  friend constexpr Box3 intersect(const Box3& a, const Box3& b) {
    return {max(a.lower, b.lower), min(a.upper, b.upper)};
  }
  friend constexpr bool operator==(const Box3&, const Box3&) = default;
};

using Box3f = Box3<float>;
using Box3d = Box3<double>;

/// The part [t_near, t_far] of a ray; empty when t_near >= t_far.
template <class T>
struct Interval {
  T t_near, t_far;
  constexpr bool empty() const { return !(t_near < t_far); }
};

/// Where origin + t*direction is inside `box`, cut to [t_min, t_max]. Zero direction components are allowed.
template <class T>
constexpr Interval<T> clip_ray(const Box3<T>& box, Vec3<T> origin, Vec3<T> direction, T t_min, T t_max) {
  for (int a = 0; a < 3; ++a) {
    if (direction[a] == T(0)) {
      if (origin[a] < box.lower[a] || origin[a] > box.upper[a]) return {T(1), T(0)};
      continue;
    }
    const T inverse = T(1) / direction[a];
    T t0 = (box.lower[a] - origin[a]) * inverse;
    T t1 = (box.upper[a] - origin[a]) * inverse;
    if (t0 > t1) {
      const T swap = t0;
      t0 = t1;
      t1 = swap;
    }
    if (t0 > t_min) t_min = t0;
    if (t1 < t_max) t_max = t1;
  }
  return {t_min, t_max};
}

}  // namespace voxlume
