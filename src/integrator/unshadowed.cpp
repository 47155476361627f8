#include "integrator/unshadowed.h"

#include <numbers>

#include "light/sample_light.h"

namespace voxlume {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

/// A light as a direction.
struct Glance {
  Vec3f wi;
  float irradiance;  ///< luminance; 0: the light does not shine here
};

Glance glance_at_rect(const Light& light, Vec3f p_world) noexcept {
  const RectFromPoint r = rect_from_point(light, p_world);
  const Vec3f to_center = light.position_mm - p_world;
  const float d2 = dot(to_center, to_center);
  if (!rect_emits_toward(light, r.height) || !(d2 > 1e-12f)) return {Vec3f(0), 0};
  const float distance = std::sqrt(d2);
  const float area = 4 * light.half_width_mm * light.half_height_mm;
  const float solid_angle = std::min(area * std::abs(r.height) / (d2 * distance), 2 * kPi);
  return {to_center * (1 / distance), luminance(light.emission) * solid_angle};
}

Glance glance_at(const Light& light, Vec3f p_world) noexcept {
  if (light.kind == LightKind::kRect) return glance_at_rect(light, p_world);
  const LightSample sample = sample_delta_light(light, p_world);
  return {sample.wi, sample.pdf > 0 ? luminance(sample.radiance) : 0};
}

}  // namespace

UnshadowedShading unshadowed_shading(const LightsView& lights, const ScatterKernel& kernel,
                                     Vec3f p_world) noexcept {
  const ScatterKernel::Albedo around = kernel.albedo();
  const UnshadowedShading albedo{around.diffuse, around.specular};
  float irradiances = lights.has_environment ? kPi * luminance(lights.environment_mean) : 0.0f;
  Vec3f diffuse = albedo.diffuse * irradiances, specular = albedo.specular * irradiances;
  for (int i = 0; i < lights.light_count; ++i) {
    const Glance glance = glance_at(lights.lights[i], p_world);
    if (!(glance.irradiance > 0)) continue;
    const ScatterParts h = kernel.eval(glance.wi);
    diffuse += (h.diffuse + h.phase) * (kPi * glance.irradiance);
    specular += h.specular * (kPi * glance.irradiance);
    irradiances += glance.irradiance;
  }
  if (!(irradiances > 0)) return albedo;
  return {diffuse * (1 / irradiances), specular * (1 / irradiances)};
}

}  // namespace voxlume
