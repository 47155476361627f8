#pragma once
#include <cmath>
#include <limits>

#include "base/vec.h"
#include "light/environment.h"
#include "light/environment_guide.h"
#include "light/lights_view.h"
#include "light/rect_light.h"

namespace voxlume {

/// Light chosen for a point: the contribution is value(wi) * radiance * transmittance / pdf.
struct LightSample {
  Vec3f wi;           ///< unit, toward the light
  float distance_mm;  ///< to the light; infinity for environment and directional lights
  Vec3f radiance;     ///< toward the point; of delta lights the irradiance on a plane that faces them
  float pdf;   ///< density per sr times the probability of the light; of delta lights the latter; 0: no light
  bool delta;  ///< no direction sampling finds it
};

/// Light met along a direction.
struct LightHit {
  Vec3f radiance;
  float
      pdf;  ///< density with which sample_light, from the ray's origin, chooses this direction on this light
};

inline LightSample no_light() noexcept {
  return {Vec3f(0.0f, 0.0f, 1.0f), std::numeric_limits<float>::infinity(), Vec3f(0.0f), 0.0f, false};
}

/// Draws a point of one rect light. pdf without the probability of the light.
inline LightSample sample_rect_light(const Light& light, Vec3f p_world, float u0, float u1) noexcept {
  const RectFromPoint r = rect_from_point(light, p_world);
  if (!rect_emits_toward(light, r.height)) return no_light();
  const RectTechnique technique = rect_technique(r);
  const RectPoint q = sample_rect(r, technique, u0, u1);
  if (q.x < r.x0 || q.x > r.x1 || q.y < r.y0 || q.y > r.y1) return no_light();
  const Vec3f to_light = light.axis_x * q.x + light.axis_y * q.y - light.direction * r.height;
  const float distance_mm = length(to_light);
  return {to_light * (1.0f / distance_mm), distance_mm, light.emission, rect_pdf(r, technique, distance_mm),
          false};
}

/// Draws from a point or directional light.
inline LightSample sample_delta_light(const Light& light, Vec3f p_world) noexcept {
  if (light.kind == LightKind::kDirectional)
    return {light.direction, std::numeric_limits<float>::infinity(), light.emission, 1.0f, true};
  const Vec3f to_light = light.position_mm - p_world;
  const float d2 = dot(to_light, to_light);
  if (!(d2 > 1e-12f)) return no_light();
  const float distance_mm = std::sqrt(d2);
  return {to_light * (1.0f / distance_mm), distance_mm, light.emission * (1.0f / d2), 1.0f, true};
}

/// Draws one light, by probabilities that are the same for all points, and a direction on it.
inline LightSample sample_light(const LightsView& view, Vec3f p_world, float u_pick, float u0,
                                float u1) noexcept {
  if (view.pick.count == 0) return no_light();
  const BinSample pick = sample_bin(view.pick, u_pick);
  LightSample sample;
  if (pick.index == view.light_count) {
    const EnvironmentSample e =
        view.guide.cdf == nullptr ? sample_environment(view.environment, u0, u1)
                                  : sample_environment_guided(view.environment, view.guide, p_world, u0, u1);
    sample = {e.wi, std::numeric_limits<float>::infinity(), e.radiance, e.pdf, false};
  } else {
    const Light& light = view.lights[pick.index];
    sample = light.kind == LightKind::kRect ? sample_rect_light(light, p_world, u0, u1)
                                            : sample_delta_light(light, p_world);
  }
  sample.pdf *= pick.probability;
  return sample;
}

/// The probability with which sample_light takes the environment.
inline float environment_probability(const LightsView& view) noexcept {
  return view.pick.count == 0 ? 0.0f : bin_probability(view.pick, view.light_count);
}

/// What a ray from p_world that escapes collects from the environment. `direction` is unit.
inline LightHit environment_hit(const LightsView& view, Vec3f p_world, Vec3f direction) noexcept {
  if (!view.has_environment) return {Vec3f(0.0f), 0.0f};
  const EnvironmentSample e = view.guide.cdf == nullptr
                                  ? eval_environment(view.environment, direction)
                                  : eval_environment_guided(view.environment, view.guide, p_world, direction);
  return {e.radiance, e.pdf * environment_probability(view)};
}

/// Calls visit(LightHit) for every rect light that shines against the ray at a distance in (0, t_max). Rect
/// lights do not block rays: each adds its radiance, attenuated up to its distance.
template <class Visit>
void visit_rect_hits(const LightsView& view, Vec3f origin, Vec3f direction, float t_max, Visit&& visit) {
  for (int i = 0; i < view.rect_count; ++i) {
    const Light& light = view.lights[i];
    const RectFromPoint r = rect_from_point(light, origin);
    if (!rect_emits_toward(light, r.height)) continue;
    const float t = -r.height / dot(direction, light.direction);
    if (!(t > 0.0f && t < t_max)) continue;
    const float x = t * dot(direction, light.axis_x);
    const float y = t * dot(direction, light.axis_y);
    if (x < r.x0 || x > r.x1 || y < r.y0 || y > r.y1) continue;
    visit(LightHit{light.emission, rect_pdf(r, rect_technique(r), t) * bin_probability(view.pick, i)});
  }
}

/// Whether any rect light shines against the ray, however far.
inline bool meets_rect_light(const LightsView& view, Vec3f origin, Vec3f direction) noexcept {
  bool meets = false;
  visit_rect_hits(view, origin, direction, std::numeric_limits<float>::infinity(),
                  [&](const LightHit&) { meets = true; });
  return meets;
}

}  // namespace voxlume
