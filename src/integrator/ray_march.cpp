#include "integrator/ray_march.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "integrator/background.h"
#include "integrator/illustration.h"
#include "integrator/scattering.h"
#include "integrator/unshadowed.h"

namespace voxlume {
namespace {

/// What may be lost of a ray's light, once by its end and once by steps that are not lit.
constexpr float kNegligible = 1e-4f;
/// The optical depth where it is all that comes through.
constexpr double kOpaqueDepth = 9.2103404;

/// Points of a ray a step apart: the first of them at or behind t_near, the last before t_far.
struct Steps {
  float first, step_mm;  ///< mm along the ray
  std::int32_t count;

  /// `offset`, in [0, 1): of the first point, in steps.
  Steps(float t_near, float t_far, float offset, float step) noexcept
      : first(t_near + offset * step), step_mm(step) {
    const double steps = std::ceil((double{t_far} - double{first}) / step);
    // Twice, for the line of a shadow ray may be as long behind its origin as before it.
    count = static_cast<std::int32_t>(std::clamp(steps, 0.0, 2.0 * kMostMarchSteps));
  }
  float at(std::int32_t i) const noexcept { return first + static_cast<float>(i) * step_mm; }
};

/// A point of the ray that is inside the volume, whatever rounding says.
Vec3f point_on(const SceneView& scene, const TrackRay& track, float t) noexcept {
  const Vec3f p = track.ray.origin_index + track.ray.direction_index * t;
  return min(max(p, scene.domain_index.lower), scene.domain_index.upper);
}

/// Finds the importance of every point and returns the sum of its squares.
double importance_of_steps(const SceneView& scene, const TrackRay& track, const Steps& steps,
                           std::vector<float>& importance) {
  importance.resize(static_cast<std::size_t>(steps.count));
  double sum = 0;
  for (std::int32_t i = 0; i < steps.count; ++i) {
    const float g = importance_at(scene.visibility.importance, point_on(scene, track, steps.at(i)));
    importance[static_cast<std::size_t>(i)] = g;
    sum += double{g} * g;
  }
  return sum;
}

/// One camera sample.
class Marcher {
 public:
  Marcher(const SceneView& scene, const PrimaryRay& primary, TraceCounters& counters) noexcept
      : scene_(scene), primary_(primary), counters_(counters), rng_(primary.rng) {}

  PixelSample march() noexcept;
  RadianceParts parts() const noexcept;

 private:
  float jitter(float first) noexcept {
    if (!scene_.ray_march.jitter) return 0.5f;
    return first >= 0 ? first : rng_.next();
  }
  /// mu' / mu where squares of the importance of `before` steps and of those `beyond` have these sums.
  float fading(double before, double beyond, float g) const noexcept {
    const double unit = scene_.ray_march.counts_steps ? 1 : scene_.trackers.step_mm;
    return visibility_factor(scene_.visibility.weights, static_cast<float>(before * unit),
                             static_cast<float>(std::max(beyond, 0.0) * unit), g);
  }
  void shade(Vec3f p_index, float value, float mu_t, float t, float weight) noexcept;
  void add_lights(const MatterPoint& matter, const ScatterKernel& kernel, Vec3f p_index,
                  float weight) noexcept;
  void add_light(const LightSample& light, const MatterPoint& matter, const ScatterKernel& kernel,
                 Vec3f p_index, float weight) noexcept;
  float transmittance(const TrackRay& ray) noexcept;
  float faded_transmittance(const TrackRay& ray, const Steps& steps, double behind, double total,
                            const std::vector<float>& importance) noexcept;

  const SceneView& scene_;
  const PrimaryRay& primary_;
  TraceCounters& counters_;
  Rng rng_;
  // Sums over steps, of which there may be very many.
  Vec3d radiance_{0}, direct_diffuse_{0}, direct_specular_{0}, fx_diffuse_{0}, fx_specular_{0};
  Vec3d albedo_{0}, normal_{0};
  double shaded_ = 0, dense_ = 0;  ///< weights of steps that are lit, and of those that are dense
  double depth_mm_ = 0;
  Vec3f behind_{0};
  float alpha_ = 0;
};

PixelSample Marcher::march() noexcept {
  const TrackRay& track = primary_.track;
  const bool enters = primary_.enters;
  const float step_mm = scene_.trackers.step_mm;
  const Steps steps(track.t_near, enters ? track.t_far : track.t_near, jitter(primary_.first.u_collision),
                    step_mm);
  thread_local std::vector<float> importance;
  const double total = scene_.visibility.on ? importance_of_steps(scene_, track, steps, importance) : 0;
  const float least = kNegligible / static_cast<float>(std::max(steps.count, 1));
  double before = 0, left = 1;
  ++counters_.paths;
  for (std::int32_t i = 0; i < steps.count; ++i) {
    const float g = total > 0 ? importance[static_cast<std::size_t>(i)] : 0, g2 = g * g;
    const Vec3f p_index = point_on(scene_, track, steps.at(i));
    const float value = sample_trilinear(scene_.medium.grid, p_index);
    const float mu_t = extinction_of(scene_.medium, p_index, value);
    ++counters_.tracking_steps;
    if (mu_t > 0) {
      const float kept = total > 0 ? fading(before, total - before - double{g2}, g) : 1.0f;
      const float opacity = -std::expm1(-mu_t * kept * step_mm);
      const float weight = static_cast<float>(left) * opacity;
      if (weight > least) shade(p_index, value, mu_t, steps.at(i), weight);
      left *= 1.0 - double{opacity};
      if (left < kNegligible) {
        left = 0;
        break;
      }
    }
    before += double{g2};
  }
  // Too little for any step to be lit is nothing.
  if (!(shaded_ > 0)) left = 1;
  alpha_ = static_cast<float>(1 - left);
  if (left > 0) {
    const bool draws = blurs_background(scene_);
    const float u0 = draws ? rng_.next() : 0.0f, u1 = draws ? rng_.next() : 0.0f;
    behind_ = background_radiance(scene_, primary_.px, primary_.py, primary_.direction_world, u0, u1) *
              static_cast<float>(left);
  }
  PixelSample out;
  out.radiance = Vec3f(radiance_) + behind_;
  if (!(alpha_ > 0)) return out;
  out.alpha = alpha_;
  out.albedo = Vec3f(albedo_ / shaded_);
  out.normal = Vec3f(normal_ / shaded_);
  out.depth_mm = static_cast<float>(depth_mm_ / shaded_);
  return out;
}

/// Adds the light of a step that has `weight` of the ray's.
void Marcher::shade(Vec3f p_index, float value, float mu_t, float t, float weight) noexcept {
  // A choice between surface and medium by chance has the mean of both together, which is taken here.
  const MatterPoint matter = matter_at(scene_, p_index, value);
  const Vec3f wo = -primary_.direction_world;
  ++counters_.scatterings;
  shaded_ += weight;
  if (mu_t > scene_.dense_mu_t) dense_ += weight;
  depth_mm_ += double{weight} * t;
  albedo_ += Vec3d(matter.scatter.albedo * weight);
  normal_ += Vec3d(matter.scatter.normal * (matter.scatter.p_brdf * weight));
  if (scene_.illustration.on) {
    radiance_ += Vec3d(illustrated(scene_.illustration, matter, wo) * weight);
    return;
  }
  const ScatterKernel kernel(scene_, matter, wo);
  radiance_ += Vec3d((matter.emission + matter.scatter.albedo * scene_.ambient) * weight);
  if (scene_.keeps_parts) {
    const UnshadowedShading fx = unshadowed_shading(scene_.lights, kernel, matter.p_world);
    fx_diffuse_ += Vec3d(fx.diffuse * weight);
    fx_specular_ += Vec3d(fx.specular * weight);
  }
  add_lights(matter, kernel, p_index, weight);
}

void Marcher::add_lights(const MatterPoint& matter, const ScatterKernel& kernel, Vec3f p_index,
                         float weight) noexcept {
  const LightsView& lights = scene_.lights;
  for (int i = 0; i < lights.light_count; ++i) {
    const Light& light = lights.lights[i];
    if (light.kind == LightKind::kRect) {
      const float u0 = rng_.next(), u1 = rng_.next();
      add_light(sample_rect_light(light, matter.p_world, u0, u1), matter, kernel, p_index, weight);
    } else {
      add_light(sample_delta_light(light, matter.p_world), matter, kernel, p_index, weight);
    }
  }
  if (!lights.has_environment) return;
  const float u0 = rng_.next(), u1 = rng_.next();
  const EnvironmentSample e = sample_environment(lights.environment, u0, u1);
  const LightSample sky{e.wi, std::numeric_limits<float>::infinity(), e.radiance, e.pdf, false};
  add_light(sky, matter, kernel, p_index, weight);
}

void Marcher::add_light(const LightSample& light, const MatterPoint& matter, const ScatterKernel& kernel,
                        Vec3f p_index, float weight) noexcept {
  if (!(light.pdf > 0)) return;
  const ScatterParts h = kernel.eval(light.wi);
  const Vec3f value = h.diffuse + h.specular + h.phase;
  if (!(max_component(value * light.radiance) > 0)) return;
  const float arrives = transmittance(ray_from(scene_, p_index, matter.p_world, light.wi, light.distance_mm));
  const Vec3f arriving = light.radiance * (arrives * weight / light.pdf);
  radiance_ += Vec3d(value * arriving);
  if (!scene_.keeps_parts) return;
  direct_diffuse_ += Vec3d((h.diffuse + h.phase) * arriving);
  direct_specular_ += Vec3d(h.specular * arriving);
}

/// Of a shadow ray's part in the volume.
float Marcher::transmittance(const TrackRay& ray) noexcept {
  ++counters_.shadow_rays;
  if (!(ray.t_near < ray.t_far)) return 1;
  const float offset = jitter(-1), step_mm = scene_.trackers.step_mm;
  const Steps steps(ray.t_near, ray.t_far, offset, step_mm);
  if (scene_.visibility.on && scene_.visibility.lights != VisibilityLights::kOff) {
    // The line goes on behind the point that is lit, as for path tracing (find_light_importance).
    const Vec3f back_index = -ray.ray.direction_index;
    const Affinef& world = scene_.medium.grid.world_from_index;
    const TrackRay back =
        visible_part(scene_, {ray.ray.origin_index, back_index}, world.point(ray.ray.origin_index),
                     world.vector(back_index), std::numeric_limits<float>::infinity(), true);
    const float reach = back.t_near < back.t_far ? back.t_far : 0.0f;
    const Steps steps_back(-ray.t_near, reach, 1 - offset, step_mm);
    thread_local std::vector<float> importance;
    const double behind = importance_of_steps(scene_, back, steps_back, importance);
    const double total = behind + importance_of_steps(scene_, ray, steps, importance);
    if (total > 0) return faded_transmittance(ray, steps, behind, total, importance);
  }
  double depth = 0;
  for (std::int32_t i = 0; i < steps.count; ++i) {
    depth += double{extinction_at(scene_.medium, point_on(scene_, ray, steps.at(i)))} *
             (step_mm * scene_.medium.shadow_extinction);
    ++counters_.tracking_steps;
    if (depth > kOpaqueDepth) return 0;
  }
  return static_cast<float>(std::exp(-depth));
}

/// Of what has not faded, seen from the light: what lies nearer to the lit point, and behind it, is beyond.
float Marcher::faded_transmittance(const TrackRay& ray, const Steps& steps, double behind, double total,
                                   const std::vector<float>& importance) noexcept {
  double depth = 0, beyond = behind;
  for (std::int32_t i = 0; i < steps.count; ++i) {
    const float mu_t = extinction_at(scene_.medium, point_on(scene_, ray, steps.at(i)));
    ++counters_.tracking_steps;
    const float g = importance[static_cast<std::size_t>(i)];
    const double g2 = double{g} * g;
    if (mu_t > 0) {
      const float kept = fading(std::max(total - beyond - g2, 0.0), beyond, g);
      depth += double{mu_t} * kept * (steps.step_mm * scene_.medium.shadow_extinction);
      if (depth > kOpaqueDepth) return 0;
    }
    beyond += g2;
  }
  return static_cast<float>(std::exp(-depth));
}

RadianceParts Marcher::parts() const noexcept {
  RadianceParts parts;
  if (!(alpha_ > 0)) return parts;
  parts.fx_diffuse = Vec3f(fx_diffuse_);
  parts.fx_specular = Vec3f(fx_specular_);
  const Vec3f diffuse(direct_diffuse_), specular(direct_specular_);
  parts.later = Vec3f(radiance_);
  for (int c = 0; c < 3; ++c) {
    if (parts.fx_diffuse[c] > 0) parts.direct_diffuse[c] = diffuse[c];
    if (parts.fx_specular[c] > 0) parts.direct_specular[c] = specular[c];
    parts.later[c] = std::max(parts.later[c] - parts.direct_diffuse[c] - parts.direct_specular[c], 0.0f);
  }
  parts.behind = behind_;
  parts.dense = dense_ > 0.5 * shaded_;
  return parts;
}

}  // namespace

PixelSample march_camera_ray(const SceneView& scene, const PrimaryRay& primary, TraceCounters& counters,
                             RadianceParts* parts) noexcept {
  Marcher marcher(scene, primary, counters);
  const PixelSample out = marcher.march();
  if (parts != nullptr) *parts = marcher.parts();
  return out;
}

}  // namespace voxlume
