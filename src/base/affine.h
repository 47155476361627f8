#pragma once
#include "base/vec.h"

namespace voxlume {

/// p -> linear * p + translation. Columns of the linear part are the images of the axes.
template <class T>
struct Affine {
  Vec3<T> column_x{1, 0, 0}, column_y{0, 1, 0}, column_z{0, 0, 1};
  Vec3<T> translation{0, 0, 0};

  Affine() = default;
  Affine(Vec3<T> cx, Vec3<T> cy, Vec3<T> cz, Vec3<T> t)
      : column_x(cx), column_y(cy), column_z(cz), translation(t) {}
  template <class U>
  explicit Affine(const Affine<U>& o)
      : column_x(o.column_x), column_y(o.column_y), column_z(o.column_z), translation(o.translation) {}

  constexpr Vec3<T> point(Vec3<T> p) const { return vector(p) + translation; }
  constexpr Vec3<T> vector(Vec3<T> v) const { return column_x * v.x + column_y * v.y + column_z * v.z; }

  constexpr T determinant() const { return dot(column_x, cross(column_y, column_z)); }
  /// Requires determinant() != 0.
  constexpr Affine inverse() const {
    const T scale = T(1) / determinant();
    const Vec3<T> r0 = cross(column_y, column_z) * scale;
    const Vec3<T> r1 = cross(column_z, column_x) * scale;
    const Vec3<T> r2 = cross(column_x, column_y) * scale;
    Affine out({r0.x, r1.x, r2.x}, {r0.y, r1.y, r2.y}, {r0.z, r1.z, r2.z}, Vec3<T>(0));
    out.translation = -out.vector(translation);
    return out;
  }
};

using Affinef = Affine<float>;
using Affined = Affine<double>;

}  // namespace voxlume
