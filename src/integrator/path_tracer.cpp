#include "integrator/path_tracer.h"

#include <limits>

#include "integrator/scatter_point.h"
#include "light/sample_light.h"
#include "sampling/warp.h"
#include "tracking/tracking.h"

namespace voxlume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Scatterings before Russian roulette may end an unlimited path.
constexpr int kRouletteDepth = 4;
/// Below 1, so that paths in matter that absorbs nothing end after some thousand scatterings.
constexpr float kMaxSurvival = 0.999f;

/// Veach's power heuristic (beta = 2) for a technique of density `pdf` beside one of density `other`.
float power_heuristic(float pdf, float other) noexcept {
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

/// The state of one path between two scatterings.
struct Path {
  Vec3f origin_world, direction_world;
  Vec3f throughput{1};
  float direction_pdf = 0;  ///< with which the direction was sampled; 0 for the camera's
};

class PathTracer {
 public:
  PathTracer(const SceneView& scene, Rng& rng, TraceCounters& counters) noexcept
      : scene_(scene), rng_(rng), counters_(counters) {}

  PixelSample trace(float px, float py) noexcept;

 private:
  /// Where a ray is inside the visible region, or, for light that what is cut away blocks, inside the volume.
  Interval<float> inside(const IndexRay& ray, Vec3f origin_world, Vec3f direction_world,
                         bool clipped) const noexcept {
    const Interval<float> volume =
        clip_ray(scene_.domain_index, ray.origin_index, ray.direction_index, 0.0f, kInfinity);
    if (volume.empty() || !clipped) return volume;
    return clip_ray(scene_.clip_world, origin_world, direction_world, volume.t_near, volume.t_far);
  }
  bool light_is_clipped() const noexcept { return !scene_.clip_blocks_light; }

  Collision fly(const Path& path) noexcept;
  void collect_emitters(const Path& path, const Collision& collision) noexcept;
  Vec3f direct_light(const ScatterPoint& point, Vec3f p_world, Vec3f wo) noexcept;
  bool scatter(Path& path, const ScatterPoint& point, Vec3f p_world) noexcept;
  bool survives(Path& path, int depth) noexcept;
  Vec3f background(float px, float py, Vec3f direction) noexcept;

  const SceneView& scene_;
  Rng& rng_;
  TraceCounters& counters_;
  Vec3f radiance_{0};
};

Collision PathTracer::fly(const Path& path) noexcept {
  const IndexRay ray = to_index_ray(scene_.medium.grid, path.origin_world, path.direction_world);
  const bool camera_ray = path.direction_pdf == 0;
  const Interval<float> run =
      inside(ray, path.origin_world, path.direction_world, camera_ray || light_is_clipped());
  if (run.empty()) return {};
  TrackingCounters tracking;
  const Collision collision = sample_free_flight(scene_.medium, ray, run.t_near, run.t_far, rng_, tracking);
  counters_.tracking_steps += tracking.steps;
  counters_.majorant_violations += tracking.majorant_violations;
  return collision;
}

/// Light met along a sampled direction before its collision: lights have no body, they only add.
void PathTracer::collect_emitters(const Path& path, const Collision& collision) noexcept {
  if (scene_.light_sampling == LightSampling::kLight) return;
  const auto add = [&](const LightHit& hit) {
    const float weight = scene_.light_sampling == LightSampling::kDirection
                             ? 1.0f
                             : power_heuristic(path.direction_pdf, hit.pdf);
    radiance_ += path.throughput * hit.radiance * weight;
  };
  visit_rect_hits(scene_.lights, path.origin_world, path.direction_world, collision.t_mm, add);
  if (!collision.real) add(environment_hit(scene_.lights, path.direction_world));
}

/// Next-event estimation: light from one sampled emitter, scattered toward wo.
Vec3f PathTracer::direct_light(const ScatterPoint& point, Vec3f p_world, Vec3f wo) noexcept {
  const float u_pick = rng_.next(), u0 = rng_.next(), u1 = rng_.next();
  const LightSample light = sample_light(scene_.lights, p_world, u_pick, u0, u1);
  if (!(light.pdf > 0)) return Vec3f(0);
  const ScatterValue scattered = eval_scatter(point, wo, light.wi);
  if (!(max_component(scattered.value * light.radiance) > 0)) return Vec3f(0);

  const IndexRay ray = to_index_ray(scene_.medium.grid, p_world, light.wi);
  const Interval<float> run = inside(ray, p_world, light.wi, light_is_clipped());
  float transmittance = 1;
  if (!run.empty() && run.t_near < light.distance_mm) {
    TrackingCounters tracking;
    transmittance = estimate_transmittance(scene_.medium, ray, run.t_near,
                                           std::min(run.t_far, light.distance_mm), rng_, tracking);
    counters_.tracking_steps += tracking.steps;
    counters_.majorant_violations += tracking.majorant_violations;
  }
  ++counters_.shadow_rays;
  const float weight = light.delta || scene_.light_sampling == LightSampling::kLight
                           ? 1.0f
                           : power_heuristic(light.pdf, scattered.pdf);
  return scattered.value * light.radiance * (transmittance * weight / light.pdf);
}

/// Turns the path at a scattering; false when it is absorbed.
bool PathTracer::scatter(Path& path, const ScatterPoint& point, Vec3f p_world) noexcept {
  const float u_lobe = rng_.next(), u0 = rng_.next(), u1 = rng_.next();
  const ScatterSample sample = sample_scatter(point, -path.direction_world, u_lobe, u0, u1);
  if (!(sample.pdf > 0)) return false;
  path.throughput *= sample.value / sample.pdf;
  path.origin_world = p_world;
  path.direction_world = sample.wi;
  path.direction_pdf = sample.pdf;
  return max_component(path.throughput) > 0;
}

/// Russian roulette for paths without a scattering limit.
bool PathTracer::survives(Path& path, int depth) noexcept {
  if (scene_.max_scatter > 0 || depth < kRouletteDepth) return true;
  const float probability = std::min(kMaxSurvival, max_component(path.throughput));
  if (rng_.next() >= probability) return false;
  path.throughput *= 1.0f / probability;
  return true;
}

/// What a camera ray that meets nothing sees.
Vec3f PathTracer::background(float px, float py, Vec3f direction) noexcept {
  switch (scene_.background) {
    case BackgroundKind::kTransparent:
      return Vec3f(0);
    case BackgroundKind::kColor:
      return scene_.background_color;
    case BackgroundKind::kEnvironment:
      break;
  }
  if (scene_.camera.background_versine > 0) {
    const float u0 = rng_.next(), u1 = rng_.next();
    direction = background_direction(scene_.camera, px, py, u0, u1);
  }
  return environment_hit(scene_.lights, direction).radiance;
}

PixelSample PathTracer::trace(float px, float py) noexcept {
  const float u_lens0 = rng_.next(), u_lens1 = rng_.next();
  const CameraRay camera = camera_ray(scene_.camera, px, py, u_lens0, u_lens1);
  Path path{camera.origin, camera.direction};
  PixelSample out{};
  for (int depth = 0;; ++depth) {
    const Collision collision = fly(path);
    if (depth > 0) collect_emitters(path, collision);
    if (!collision.real) {
      if (depth == 0) radiance_ = background(px, py, path.direction_world);
      break;
    }
    const Vec3f p_world = path.origin_world + path.direction_world * collision.t_mm;
    // Matter that is cut away absorbs light that reaches it (only when it blocks light at all).
    if (scene_.clip_blocks_light && !scene_.clip_world.contains(p_world) && depth > 0) break;

    MatterPoint matter = matter_at(scene_, collision.p_index, collision.value);
    radiance_ += path.throughput * matter.emission;
    if (depth == 0) {
      out.alpha = 1;
      out.depth_mm = collision.t_mm;
      out.albedo = matter.scatter.albedo;
      out.normal = matter.scatter.normal * matter.scatter.p_brdf;
    }
    if (scene_.max_scatter > 0 && depth == scene_.max_scatter) break;

    // Exposure Render decides at every event whether it is a surface or a medium (xu2024 eq. 4, without the
    // division by the probability of the choice, which would double the scattered energy).
    if (scene_.scattering.shading == Shading::kExposureRender)
      matter.scatter.p_brdf = rng_.next() < matter.scatter.p_brdf ? 1.0f : 0.0f;
    ++counters_.scatterings;
    radiance_ += path.throughput * matter.scatter.albedo * scene_.ambient;
    if (scene_.light_sampling != LightSampling::kDirection)
      radiance_ += path.throughput * direct_light(matter.scatter, p_world, -path.direction_world);
    if (!scatter(path, matter.scatter, p_world) || !survives(path, depth)) break;
  }
  out.radiance = radiance_;
  return out;
}

}  // namespace

PixelSample trace_camera_sample(const SceneView& scene, int x, int y, std::uint32_t sample,
                                TraceCounters& counters) noexcept {
  const std::uint32_t pixel =
      static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(scene.width) + static_cast<std::uint32_t>(x);
  Rng rng(scene.seed, scene.frame, pixel, sample);
  const float px = x + 0.5f + sample_filter(scene.filter, scene.filter_radius_px, rng.next());
  const float py = y + 0.5f + sample_filter(scene.filter, scene.filter_radius_px, rng.next());
  ++counters.paths;
  return PathTracer(scene, rng, counters).trace(px, py);
}

void render_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end, Film& film,
                 TraceCounters& counters) {
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x)
      for (int sample = sample_begin; sample < sample_end; ++sample)
        film.add(x, y, trace_camera_sample(scene, x, y, static_cast<std::uint32_t>(sample), counters));
}

}  // namespace voxlume
