#pragma once
#include <cmath>
#include <numbers>

#include "light/compile_lights.h"
#include "light/sample_light.h"

namespace voxlume::test {

inline EnvironmentDescription no_environment() {
  EnvironmentDescription out;
  out.intensity = 0;
  return out;
}

inline LightDescription rect(Double3 position, Double3 target, double width, double height,
                             double radiance = 1) {
  LightDescription out;
  out.kind = LightKind::kRect;
  out.position_mm = position;
  out.target_mm = target;
  out.size_mm = {width, height};
  out.intensity = radiance;
  return out;
}

inline LightDescription point(Double3 position, double intensity) {
  LightDescription out;
  out.kind = LightKind::kPoint;
  out.position_mm = position;
  out.intensity = intensity;
  return out;
}

inline LightDescription directional(Double3 direction, double irradiance) {
  LightDescription out;
  out.direction = direction;
  out.intensity = irradiance;
  return out;
}

inline Lights compile(const std::vector<LightDescription>& lights,
                      const EnvironmentDescription& environment = no_environment(),
                      const EnvironmentImage* image = nullptr,
                      EnvironmentSamples samples = EnvironmentSamples::kWhole) {
  return Lights(lights, environment, image, ViewFrame{}, SceneSphere{{0, 0, 0}, 100}, samples);
}

/// A 32 x 16 sky: dim noise, bright poles, a black patch, and one texel (column 21, row 4) like a sun.
inline EnvironmentImage sky() {
  EnvironmentImage out{32, 16, std::vector<float>(3 * 32 * 16)};
  for (int row = 0; row < 16; ++row)
    for (int column = 0; column < 32; ++column) {
      const auto i = static_cast<std::size_t>(3 * (row * 32 + column));
      for (std::size_t c = 0; c < 3; ++c)
        out.rgb[i + c] = 0.2f + 0.1f * static_cast<float>(std::sin(double(i + 2 * c)));
      if (row == 0 || row == 15) out.rgb[i] = out.rgb[i + 1] = out.rgb[i + 2] = 20.0f;
      if (row >= 9 && row < 12 && column < 8) out.rgb[i] = out.rgb[i + 1] = out.rgb[i + 2] = 0.0f;
      if (row == 4 && column == 21) out.rgb[i] = out.rgb[i + 1] = out.rgb[i + 2] = 300.0f;
    }
  return out;
}

/// Irradiance (double precision) at the origin on the plane of unit normal n by a rect of unit radiance that
/// lies wholly above it and faces it: Lambert's polygon formula.
inline double rect_irradiance(const Light& light, Vec3d p, Vec3d n) {
  const Vec3d c = Vec3d(light.position_mm) - p;
  const Vec3d x = Vec3d(light.axis_x) * double{light.half_width_mm},
              y = Vec3d(light.axis_y) * double{light.half_height_mm};
  const Vec3d corners[] = {normalize(c - x - y), normalize(c + x - y), normalize(c + x + y),
                           normalize(c - x + y)};
  double sum = 0;
  for (int i = 0; i < 4; ++i) {
    const Vec3d a = corners[i], b = corners[(i + 1) % 4];
    const Vec3d edge = cross(a, b);
    sum += std::atan2(length(edge), dot(a, b)) * dot(normalize(edge), n);
  }
  return std::abs(sum) / 2;
}

}  // namespace voxlume::test
