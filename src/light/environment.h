#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "light/lights_view.h"
#include "sampling/warp.h"

namespace voxlume {

// Within a texel the density is constant in solid angle, as the radiance is: radiance / pdf does not vary
// over it, and the poles are no special case. Rows of the lower half are measured from their own pole for
// precision.

/// A direction, what comes from there, and the density of sample_environment, 1/sr.
struct EnvironmentSample {
  Vec3f wi;
  Vec3f radiance;
  float pdf;
};

/// Solid angle of one texel of a row, sr.
inline float texel_solid_angle(const EnvironmentView& e, int row) noexcept {
  const int from_pole = 2 * row >= e.height ? e.height - 1 - row : row;
  return (e.cap_versine[from_pole + 1] - e.cap_versine[from_pole]) * (2.0f * std::numbers::pi_v<float>) /
         static_cast<float>(e.width);
}

inline Vec3f texel_radiance(const EnvironmentView& e, int column, int row) noexcept {
  return e.scale * e.texels[static_cast<std::size_t>(row) * static_cast<std::size_t>(e.width) +
                            static_cast<std::size_t>(column)];
}

/// Radiance from `direction` (unit, toward the environment) and the density of sampling it.
inline EnvironmentSample eval_environment(const EnvironmentView& e, Vec3f direction) noexcept {
  if (e.width == 0) return {direction, e.scale, kUniformSpherePdf};
  const Vec3f d(dot(direction, e.axis_x), dot(direction, e.axis_y), dot(direction, e.axis_z));
  const float u = 0.5f + 0.5f * std::numbers::inv_pi_v<float> * std::atan2(d.x, d.y);
  const float v = std::numbers::inv_pi_v<float> * std::atan2(std::sqrt(d.x * d.x + d.y * d.y), d.z);
  const int column = std::min(static_cast<int>(u * static_cast<float>(e.width)), e.width - 1);
  const int row = std::min(static_cast<int>(v * static_cast<float>(e.height)), e.height - 1);
  return {direction, texel_radiance(e, column, row),
          texel_probability(e.choice, column, row) / texel_solid_angle(e, row)};
}

/// Draws a direction in proportion to the luminance of the radiance.
inline EnvironmentSample sample_environment(const EnvironmentView& e, float u0, float u1) noexcept {
  if (e.width == 0) return {uniform_sphere(u0, u1), e.scale, kUniformSpherePdf};
  const TexelSample t = sample_texel(e.choice, u0, u1);
  const bool south = 2 * t.row >= e.height;
  const int from_pole = south ? e.height - 1 - t.row : t.row;
  const float cap0 = e.cap_versine[from_pole], cap1 = e.cap_versine[from_pole + 1];
  const float versine = cap0 + (cap1 - cap0) * t.row_offset;
  // direction_from_versine turns from +x; u = 0.5 is +y and u grows toward +x.
  const float u = (static_cast<float>(t.column) + t.column_offset) / static_cast<float>(e.width);
  const Vec3f d = direction_from_versine(versine, 0.75f - u);
  return {normalize(e.axis_x * d.x + e.axis_y * d.y + e.axis_z * (south ? -d.z : d.z)),
          texel_radiance(e, t.column, t.row), t.probability / texel_solid_angle(e, t.row)};
}

}  // namespace voxlume
