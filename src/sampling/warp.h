#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "sampling/elementary.h"
#include "sampling/logarithm.h"
#include "voxlume/scene.h"

namespace voxlume {

// Maps of the unit square. All u are uniform in [0, 1 - 2^-24]; every result is finite.

/// Density of uniform_sphere, 1/sr.
constexpr float kUniformSpherePdf = 0.25f * std::numbers::inv_pi_v<float>;

/// The unit vector at `versine` = 1 - cos(theta), in [0, 2], from +z and azimuth 2 pi u1. Unlike the cosine,
/// the versine keeps its relative precision near the axis.
inline Vec3f direction_from_versine(float versine, float u1) noexcept {
  const float sin_theta = std::sqrt(std::max(0.0f, versine * (2.0f - versine)));
  const SineCosine phi = sine_cosine_of_turns(u1);
  return {sin_theta * phi.cosine, sin_theta * phi.sine, 1.0f - versine};
}

/// Unit vector, uniform over the sphere.
inline Vec3f uniform_sphere(float u0, float u1) noexcept { return direction_from_versine(2.0f * u0, u1); }

/// Unit vector, uniform in solid angle over the cone about +z whose half angle has the cosine 1 -
/// versine_max.
inline Vec3f uniform_cone(float versine_max, float u0, float u1) noexcept {
  return direction_from_versine(versine_max * u0, u1);
}

struct DiskPoint {
  float x, y;
};

/// Uniform over the unit disk; keeps neighbours together (Shirley and Chiu 1997).
inline DiskPoint concentric_disk(float u0, float u1) noexcept {
  const float a = 2.0f * u0 - 1.0f;
  const float b = 2.0f * u1 - 1.0f;
  const bool a_leads = std::abs(a) > std::abs(b);
  const float radius = a_leads ? a : b;
  const float eighths = radius == 0.0f ? 0.0f : (a_leads ? b : a) / radius;
  const SineCosine phi = sine_cosine_of_turns(a_leads ? 0.125f * eighths : 0.25f - 0.125f * eighths);
  return {radius * phi.cosine, radius * phi.sine};
}

/// Unit vector about +z with density cosine_hemisphere_pdf (Malley's method).
inline Vec3f cosine_hemisphere(float u0, float u1) noexcept {
  const DiskPoint p = concentric_disk(u0, u1);
  return {p.x, p.y, std::sqrt(std::max(0.0f, 1.0f - p.x * p.x - p.y * p.y))};
}

/// Density of cosine_hemisphere, 1/sr; 0 below the hemisphere.
inline float cosine_hemisphere_pdf(float cos_theta) noexcept {
  return std::max(0.0f, cos_theta) * std::numbers::inv_pi_v<float>;
}

// Giles 2010, "Approximating the erfinv function", the single precision polynomials: in w - 2.5 for w below
// kErfSplit, else in sqrt(w) - 3, where w = -log(1 - x^2).
inline constexpr float kErfSplit = 5.0f;
inline constexpr float kErfCentre[9] = {2.81022636e-08f,  3.43273939e-07f, -3.5233877e-06f,
                                        -4.39150654e-06f, 0.00021858087f,  -0.00125372503f,
                                        -0.00417768164f,  0.246640727f,    1.50140941f};
inline constexpr float kErfTail[9] = {-0.000200214257f, 0.000100950558f, 0.00134934322f,
                                      -0.00367342844f,  0.00573950773f,  -0.0076224613f,
                                      0.00943887047f,   1.00167406f,     2.83297682f};

/// Inverse of erf for |x| <= 0.9999, relative error below 1e-6.
inline float inverse_erf(float x) noexcept {
  const float w = negative_log((1.0f - x) * (1.0f + x));
  const bool centre = w < kErfSplit;
  const float* polynomial = centre ? kErfCentre : kErfTail;
  const float v = centre ? w - 2.5f : std::sqrt(w) - 3.0f;
  float p = polynomial[0];
  for (int i = 1; i < 9; ++i) p = polynomial[i] + p * v;
  return p * x;
}

inline constexpr float kErfOfCut = 0.99730020393674f;  // erf(3 / sqrt 2)

/// Importance-samples one axis of the pixel filter: an offset from the pixel's centre in pixels, within
/// [-radius_px, radius_px]. The gaussian has sigma = radius_px / 3 and is cut at the radius exactly.
inline float sample_filter(PixelFilter filter, float radius_px, float u) noexcept {
  const float centred = 2.0f * u - 1.0f;
  if (filter == PixelFilter::kBox) return radius_px * centred;
  const float sigma = radius_px * (1.0f / 3.0f);
  const float offset = sigma * std::numbers::sqrt2_v<float> * inverse_erf(centred * kErfOfCut);
  return std::clamp(offset, -radius_px, radius_px);
}

}  // namespace voxlume
