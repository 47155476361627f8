#pragma once
#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace voxlume {

// The interface of two dielectrics. eta is the index beyond the interface over the index on wo's side; the
// cosine is the one to the normal on wo's side, in [0,1].

/// The smallest index that bends light. Below it half vectors, which are found from wo + eta wi, drown in
/// rounding.
constexpr float kMinIor = 1.001f;

/// Cosine of the refracted direction to the normal beyond; 0 when reflection is total.
template <class T>
T refracted_cosine(T cosine, T eta) noexcept {
  return std::sqrt(std::max(T(0), T(1) - (T(1) - cosine) * (T(1) + cosine) / (eta * eta)));
}

/// Fresnel's reflectance of unpolarised light, exact; 1 when reflection is total. eta != 1.
template <class T>
T fresnel_dielectric(T cosine, T eta) noexcept {
  const T beyond = refracted_cosine(cosine, eta);
  if (!(beyond > T(0))) return T(1);
  const T parallel = (eta * cosine - beyond) / (eta * cosine + beyond);
  const T perpendicular = (cosine - eta * beyond) / (cosine + eta * beyond);
  return T(0.5) * (parallel * parallel + perpendicular * perpendicular);
}

/// The direction in which light beyond the interface comes to leave along wo, by Snell's law about the half
/// vector h on wo's side. Grazing when reflection is total.
template <class T>
Vec3<T> refract(Vec3<T> wo, Vec3<T> h, T eta) noexcept {
  const T cosine = dot(wo, h);
  return h * (cosine / eta - refracted_cosine(cosine, eta)) - wo * (T(1) / eta);
}

}  // namespace voxlume
