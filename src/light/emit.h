#pragma once
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "light/compile_lights.h"
#include "light/sample_light.h"
#include "sampling/sobol.h"
#include "sampling/warp.h"

namespace voxlume {

/// Light that sets out toward a sphere. What n of them bring to a surface, divided by n, is on average the
/// flux that the lights send through it, without anything in between.
struct Emission {
  Vec3f origin_world, direction_world;  ///< LPS mm; unit
  Vec3f flux;                           ///< radiance times area times solid angle, over the density; 0: none
};

/// From a point to the sphere, over the directions that meet it; where the point is inside, over all. `rate`
/// times their solid angle is the flux.
inline Emission emit_from_point(Vec3f origin, const SceneSphere& sphere, Vec3f rate, float u0,
                                float u1) noexcept {
  const Vec3f to_center = sphere.center_mm - origin;
  const float d2 = dot(to_center, to_center), r2 = sphere.radius_mm * sphere.radius_mm;
  const bool inside = d2 <= r2;
  const float versine = inside ? 2.0f : (r2 / d2) / (1.0f + std::sqrt(1.0f - r2 / d2));
  const Frame frame(inside ? Vec3f(0, 0, 1) : normalize(to_center));
  return {origin, frame.to_world(uniform_cone(versine, u0, u1)),
          rate * (2 * std::numbers::pi_v<float> * versine)};
}

/// Along -to_light, spread over the disk that the sphere shows there. `rate` is per unit of its area.
inline Emission emit_from_afar(Vec3f to_light, const SceneSphere& sphere, Vec3f rate, float u0,
                               float u1) noexcept {
  const float radius = sphere.radius_mm;
  const DiskPoint p = concentric_disk(u0, u1);
  const Vec3f offset = Frame(to_light).to_world(Vec3f(p.x * radius, p.y * radius, radius));
  return {sphere.center_mm + offset, -to_light, rate * (std::numbers::pi_v<float> * radius * radius)};
}

/// Draws light from one light, by the probabilities of sample_light.
inline Emission sample_emission(const LightsView& view, const SceneSphere& sphere, float u_pick,
                                UnitPair start, UnitPair way) noexcept {
  if (view.pick.count == 0) return {Vec3f(0), Vec3f(0, 0, 1), Vec3f(0)};
  const BinSample pick = sample_bin(view.pick, u_pick);
  if (pick.index == view.light_count) {
    const EnvironmentSample e = sample_environment(view.environment, start.u0, start.u1);
    return emit_from_afar(e.wi, sphere, e.radiance * (1 / (e.pdf * pick.probability)), way.u0, way.u1);
  }
  const Light& light = view.lights[pick.index];
  const Vec3f rate = light.emission * (1 / pick.probability);
  if (light.kind == LightKind::kDirectional)
    return emit_from_afar(light.direction, sphere, rate, way.u0, way.u1);
  if (light.kind == LightKind::kPoint)
    return emit_from_point(light.position_mm, sphere, rate, way.u0, way.u1);
  const Vec3f origin = light.position_mm + light.axis_x * ((2 * start.u0 - 1) * light.half_width_mm) +
                       light.axis_y * ((2 * start.u1 - 1) * light.half_height_mm);
  Emission out = emit_from_point(origin, sphere, rate, way.u0, way.u1);
  const float cosine = dot(out.direction_world, light.direction);
  const float area = 4 * light.half_width_mm * light.half_height_mm;
  out.flux *= area * (light.two_sided ? std::abs(cosine) : std::max(cosine, 0.0f));
  return out;
}

}  // namespace voxlume
