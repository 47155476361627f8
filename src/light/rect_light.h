#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "light/lights_view.h"

namespace voxlume {

// Uniform sampling of the solid angle of a rectangle (Urena, Fajardo and King 2013).
// The angles of the original enter as their cosines and sines and the solid angle comes from a formula
// without differences, because sums of four arc cosines minus 2 pi keep too few digits in float.

/// A rect light as a point sees it: the point is the origin, the light spans [x0,x1] x [y0,y1] in its own
/// axes, and the point is `height` in front of its plane (negative: behind).
struct RectFromPoint {
  float x0, x1, y0, y1, height;
};

inline RectFromPoint rect_from_point(const Light& light, Vec3f p_world) noexcept {
  const Vec3f to_centre = light.position_mm - p_world;
  const float x = dot(to_centre, light.axis_x);
  const float y = dot(to_centre, light.axis_y);
  return {x - light.half_width_mm, x + light.half_width_mm, y - light.half_height_mm,
          y + light.half_height_mm, -dot(to_centre, light.direction)};
}

/// Whether a point at that height gets light.
inline bool rect_emits_toward(const Light& light, float height) noexcept {
  return light.two_sided ? height != 0.0f : height > 0.0f;
}

/// Solid angle in sr, [0, 2 pi]: two triangles by van Oosterom and Strackee 1983.
inline float rect_solid_angle(const RectFromPoint& r) noexcept {
  const float z = r.height;
  const Vec3f a(r.x0, r.y0, z), b(r.x1, r.y0, z), c(r.x1, r.y1, z), d(r.x0, r.y1, z);
  const float la = length(a), lb = length(b), lc = length(c), ld = length(d);
  const float volume = std::abs(z) * (r.x1 - r.x0) * (r.y1 - r.y0);
  const float abc = la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(a, c) * lb;
  const float acd = la * lc * ld + dot(a, c) * ld + dot(c, d) * la + dot(a, d) * lc;
  return 2.0f * (std::atan2(volume, abc) + std::atan2(volume, acd));
}

/// How a rect is sampled from a point. Far away by its area, which takes no trigonometry; nearer by its solid
/// angle; close to its plane, where the area's density has no bound, by the hemisphere toward it.
enum class RectSampling { kArea, kSolidAngle, kHemisphere };

/// Far is a centre at least this many half diagonals away: seen from the front its density then varies
/// by a quarter at most.
constexpr float kFarHalfDiagonals = 2.5f;

/// How a rect is sampled from a point, and the part of the density that does not depend on the direction.
struct RectTechnique {
  RectSampling sampling;
  float solid_angle;  ///< sr; 0 for kArea
};

inline RectTechnique rect_technique(const RectFromPoint& r) noexcept {
  const Vec3f twice_centre(r.x0 + r.x1, r.y0 + r.y1, 2.0f * r.height),
      diagonal(r.x1 - r.x0, r.y1 - r.y0, 0.0f);
  const float far2 = kFarHalfDiagonals * kFarHalfDiagonals;
  if (dot(twice_centre, twice_centre) > far2 * dot(diagonal, diagonal)) return {RectSampling::kArea, 0.0f};
  const float solid_angle = rect_solid_angle(r);
  // Too small for floats: seen from its own plane.
  if (solid_angle < 1e-4f) return {RectSampling::kArea, 0.0f};
  return {solid_angle > 6.2f ? RectSampling::kHemisphere : RectSampling::kSolidAngle, solid_angle};
}

/// Density (1/sr) of sampling the rect's point at distance `distance_mm`.
inline float rect_pdf(const RectFromPoint& r, const RectTechnique& technique, float distance_mm) noexcept {
  switch (technique.sampling) {
    case RectSampling::kSolidAngle:
      return 1.0f / technique.solid_angle;
    case RectSampling::kHemisphere:
      return 0.5f * std::numbers::inv_pi_v<float>;
    case RectSampling::kArea:
      break;
  }
  const float area = (r.x1 - r.x0) * (r.y1 - r.y0);
  return distance_mm * distance_mm * distance_mm / (std::abs(r.height) * area);
}

struct RectPoint {
  float x, y;  ///< in the axes of RectFromPoint
};

/// Where the direction that u0, u1 stand for, uniform over the hemisphere toward the rect's plane, meets that
/// plane: not always inside the rect.
inline RectPoint sample_rect_hemisphere(const RectFromPoint& r, float u0, float u1) noexcept {
  const float cosine = 1.0f - u0;  // never 0
  const float radius = std::abs(r.height) * std::sqrt(u0 * (1.0f + cosine)) / cosine;
  const float phi = 2.0f * std::numbers::pi_v<float> * u1;
  return {radius * std::cos(phi), radius * std::sin(phi)};
}

/// The point of the rect that u0, u1 stand for, uniform in solid angle.
inline RectPoint sample_rect_solid_angle(const RectFromPoint& r, float solid_angle, float u0,
                                         float u1) noexcept {
  const float z2 = r.height * r.height;
  const float ry0 = std::sqrt(z2 + r.y0 * r.y0), ry1 = std::sqrt(z2 + r.y1 * r.y1);
  const float d00 = std::sqrt(z2 + r.x0 * r.x0 + r.y0 * r.y0);
  const float d01 = std::sqrt(z2 + r.x0 * r.x0 + r.y1 * r.y1);
  const float scale = 1.0f / (ry0 * ry1 * (z2 + r.x0 * r.x0));
  // k = 2 pi - g2 - g3 of the interior angles at x0, and a = k + u S.
  const float cos_k = -(r.x0 * r.x0 * r.y0 * r.y1 + z2 * d00 * d01) * scale;
  const float sin_k = -std::abs(r.height) * r.x0 * (r.y1 * d00 - r.y0 * d01) * scale;
  const float cos_s = std::cos(u0 * solid_angle), sin_s = std::sin(u0 * solid_angle);
  const float cos_a = cos_k * cos_s - sin_k * sin_s;
  const float sin_a = sin_k * cos_s + cos_k * sin_s;
  // The original's f = m / sin a, multiplied out so that sin a = 0 (x = 0) is no special case.
  const float m = -(cos_a * r.y0 / ry0 + r.y1 / ry1);
  const float root = m * m - (z2 / (ry0 * ry0)) * sin_a * sin_a;
  const float x_raw =
      std::abs(r.height) * std::copysign(sin_a, sin_a * m) / std::sqrt(std::max(root, 1e-20f));
  const float x = std::clamp(x_raw, r.x0, r.x1);

  const float d2 = x * x + z2;
  const float h0 = r.y0 / std::sqrt(d2 + r.y0 * r.y0);
  const float h1 = r.y1 / std::sqrt(d2 + r.y1 * r.y1);
  const float h = h0 + u1 * (h1 - h0);
  const float y_raw = h * std::sqrt(d2) / std::sqrt(std::max((1.0f - h) * (1.0f + h), 1e-20f));
  return {x, std::clamp(y_raw, r.y0, r.y1)};
}

/// The point of the rect that u0, u1 stand for, with density rect_pdf; outside the rect: none.
inline RectPoint sample_rect(const RectFromPoint& r, const RectTechnique& technique, float u0,
                             float u1) noexcept {
  switch (technique.sampling) {
    case RectSampling::kSolidAngle:
      return sample_rect_solid_angle(r, technique.solid_angle, u0, u1);
    case RectSampling::kHemisphere:
      return sample_rect_hemisphere(r, u0, u1);
    case RectSampling::kArea:
      break;
  }
  return {r.x0 + u0 * (r.x1 - r.x0), r.y0 + u1 * (r.y1 - r.y0)};
}

}  // namespace voxlume
