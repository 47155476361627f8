#pragma once
#include <algorithm>
#include <cmath>

#include "base/vec.h"

namespace voxlume {

// The colour spaces of FLIP (Andersson et al. 2020, section 4.1). XYZ is CIE XYZ over that of white, so that
// white is 1, 1, 1. RGB is linear Rec. 709 with white at x, y = 0.31271, 0.32902.

inline Vec3f xyz_from_rgb(Vec3f rgb) {
  return {dot(Vec3f(0.43389539f, 0.37624237f, 0.18986224f), rgb),
          dot(Vec3f(0.21263682f, 0.71518298f, 0.07218020f), rgb),
          dot(Vec3f(0.01775242f, 0.10946563f, 0.87278195f), rgb)};
}

/// The inverse of xyz_from_rgb.
inline Vec3f rgb_from_xyz(Vec3f xyz) {
  return {dot(Vec3f(3.08034199f, -1.53739897f, -0.54294302f), xyz),
          dot(Vec3f(-0.92117840f, 1.87592998f, 0.04524841f), xyz),
          dot(Vec3f(0.05288129f, -0.20401121f, 1.15112991f), xyz)};
}

/// YCxCz: achromatic, red-green, blue-yellow. Linear in XYZ.
inline Vec3f opponent_from_xyz(Vec3f xyz) {
  return {116 * xyz.y - 16, 500 * (xyz.x - xyz.y), 200 * (xyz.y - xyz.z)};
}

/// The inverse of opponent_from_xyz.
inline Vec3f xyz_from_opponent(Vec3f opponent) {
  const float y = (opponent.x + 16) / 116;
  return {y + opponent.y / 500, y, y - opponent.z / 200};
}

/// CIELAB with a and b times 0.01 L: colours seem less colourful in the dark (the Hunt effect). XYZ >= 0.
inline Vec3f hunt_lab_from_xyz(Vec3f xyz) {
  const auto curve = [](float t) {
    constexpr float kDelta = 6.0f / 29.0f;
    return t > kDelta * kDelta * kDelta ? std::cbrt(t) : t / (3 * kDelta * kDelta) + 4.0f / 29.0f;
  };
  const Vec3f f(curve(xyz.x), curve(xyz.y), curve(xyz.z));
  const float lightness = 116 * f.y - 16;
  return {lightness, 5 * (f.x - f.y) * lightness, 2 * (f.y - f.z) * lightness};
}

/// The distance for large differences of colour: |dL| + |(da, db)|.
inline float hyab(Vec3f lab, Vec3f other) {
  const Vec3f d = lab - other;
  return std::abs(d.x) + std::sqrt(d.y * d.y + d.z * d.z);
}

// The tone curve of HDR-FLIP, (n2 x^2 + n1 x) / (d2 x^2 + d1 x + d0): a fit of ACES, with the exposure in it.
inline constexpr double kCurveN2 = 0.9036, kCurveN1 = 0.018;
inline constexpr double kCurveD2 = 0.8748, kCurveD1 = 0.354, kCurveD0 = 0.14;

/// The tone curve clamped to [0,1]; linear >= 0. It is 1 from 13 on.
inline float flip_tone_curve(float linear) {
  const float x = std::min(linear, 100.0f);  // far above that the squares would overflow
  const float shown =
      x * (static_cast<float>(kCurveN2) * x + static_cast<float>(kCurveN1)) /
      (x * (static_cast<float>(kCurveD2) * x + static_cast<float>(kCurveD1)) + static_cast<float>(kCurveD0));
  return std::min(shown, 1.0f);
}

/// Where the tone curve reaches `shown`, in (0,1).
inline double inverse_flip_tone_curve(double shown) {
  const double a = kCurveN2 - shown * kCurveD2, b = kCurveN1 - shown * kCurveD1, c = -shown * kCurveD0;
  return (-b + std::sqrt(b * b - 4 * a * c)) / (2 * a);
}

}  // namespace voxlume
