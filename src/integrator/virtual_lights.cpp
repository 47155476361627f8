#include "integrator/virtual_lights.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "light/direction_bins.h"
#include "light/emit.h"

namespace voxlume {
namespace {

/// Distances at which a direction's transmittance is remembered, evenly up to the reach.
constexpr int kDistances = 33;
constexpr float kUnit = 65535.0f;
/// Virtual lights that a sample of the picture takes.
constexpr int kTaken = 16;
/// Particles that are traced for a light at most: light may hardly meet matter.
constexpr int kMostParticlesPerLight = 64;
/// Scatterings of a particle where a path has no limit; what it carries then is little.
constexpr int kMostScatterings = 16;
/// A stream that no pixel has.
constexpr std::uint32_t kParticleStream = 0xFFFFFFFFu;

std::size_t row_of(std::size_t light, int bin) {
  return (light * DirectionBins::kCount + static_cast<std::size_t>(bin)) * kDistances;
}

/// Transmittance from a point along a direction, at evenly spaced distances.
void march_transmittance(const SceneView& scene, const VirtualLight& light, Vec3f direction, float reach_mm,
                         float step_mm, std::uint16_t* out) {
  const TrackRay run = ray_from(scene, light.p_index, light.matter.p_world, direction, reach_mm);
  const Box3f domain = scene.medium.grid.index_box();
  const float spacing_mm = reach_mm / (kDistances - 1);
  const int steps = std::max(1, static_cast<int>(std::ceil(spacing_mm / step_mm)));
  const float own_step_mm = spacing_mm / static_cast<float>(steps);
  float depth = 0;
  out[0] = static_cast<std::uint16_t>(kUnit);
  for (int i = 1; i < kDistances; ++i) {
    for (int step = 0; step < steps; ++step) {
      const float t =
          static_cast<float>(i - 1) * spacing_mm + (static_cast<float>(step) + 0.5f) * own_step_mm;
      if (!(t >= run.t_near && t < run.t_far)) continue;
      const Vec3f p = run.ray.origin_index + run.ray.direction_index * t;
      depth += extinction_at(scene.medium, min(max(p, domain.lower), domain.upper)) * own_step_mm;
    }
    out[i] =
        static_cast<std::uint16_t>(std::lround(std::exp(-depth * scene.medium.shadow_extinction) * kUnit));
  }
}

}  // namespace

VirtualLights::VirtualLights(const SceneView& scene, const SceneSphere& sphere,
                             const VirtualLightChoice& choice)
    : reach_mm_(2 * sphere.radius_mm), nearest_mm_(choice.nearest_mm) {
  trace(scene, sphere, choice);
  transmittance_.resize(row_of(lights_.size(), 0));
  parallel_for(static_cast<std::int64_t>(lights_.size()), 1, [&](std::int64_t i) {
    const auto light = static_cast<std::size_t>(i);
    for (int bin = 0; bin < DirectionBins::kCount; ++bin)
      march_transmittance(scene, lights_[light], DirectionBins::direction_in(bin, 0.5f, 0.5f), reach_mm_,
                          choice.step_mm, &transmittance_[row_of(light, bin)]);
  });
}

void VirtualLights::trace(const SceneView& scene, const SceneSphere& sphere,
                          const VirtualLightChoice& choice) {
  const int limit = choice.max_scatter > 0 ? choice.max_scatter - 1 : kMostScatterings;
  const auto wanted = static_cast<std::size_t>(limit > 0 ? choice.count : 0);
  const auto most = static_cast<std::uint32_t>(choice.count) * kMostParticlesPerLight;
  TrackingCounters counters;
  std::uint32_t particles = 0;
  for (; lights_.size() < wanted && particles < most; ++particles) {
    Rng rng(choice.seed, 0, kParticleStream, particles);
    const float u_pick = rng.next();
    const UnitPair start{rng.next(), rng.next()}, way{rng.next(), rng.next()};
    const Emission emission = sample_emission(scene.lights, sphere, u_pick, start, way);
    Vec3f flux = emission.flux, direction = emission.direction_world;
    const IndexRay first = to_index_ray(scene.medium.grid, emission.origin_world, direction);
    TrackRay ray = visible_part(scene, first, emission.origin_world, direction,
                                std::numeric_limits<float>::infinity(), !scene.clip_blocks_light);
    for (int depth = 0; depth < limit && max_component(flux) > 0 && ray.t_near < ray.t_far; ++depth) {
      const Collision collision = sample_free_flight(scene.medium, ray, rng, counters);
      if (!collision.real) break;
      ScatteringQuery query{collision.p_index, collision.value, -direction, false, true};
      query.u_surface = rng.next();
      query.u_lobe = rng.next();
      query.direction = {rng.next(), rng.next()};
      const Scattering at = scatter_at(scene, query);
      if (scene.clip_blocks_light && !scene.clip_world.contains(at.matter.p_world)) break;
      lights_.push_back({at.matter, at.choice, collision.p_index, query.wo, flux});
      if (!(at.turn.pdf > 0)) break;
      flux *= at.turn.value / at.turn.pdf;
      direction = at.turn.wi;
      ray = at.turn_ray;
    }
  }
  for (VirtualLight& light : lights_) light.flux *= 1.0f / static_cast<float>(particles);
}

VirtualLightsView VirtualLights::view() const {
  return {lights_.data(), static_cast<std::int32_t>(lights_.size()), transmittance_.data(), reach_mm_,
          nearest_mm_};
}

float virtual_transmittance(const VirtualLightsView& view, int light, Vec3f p_world, float u0,
                            float u1) noexcept {
  const Vec3f way = p_world - view.lights[light].matter.p_world;
  const float distance_mm = length(way);
  if (!(distance_mm > 0)) return 1;
  const DirectionBins::Place place = DirectionBins::place_of(way * (1 / distance_mm));
  const int bin = DirectionBins::bin_at(place.row - 0.5f + u0, place.column - 0.5f + u1);
  const std::uint16_t* row = view.transmittance + row_of(static_cast<std::size_t>(light), bin);
  const float at = std::min(distance_mm / view.reach_mm, 1.0f) * (kDistances - 1);
  const int before = std::min(static_cast<int>(at), kDistances - 2);
  const auto near = static_cast<float>(row[before]), far = static_cast<float>(row[before + 1]);
  return (near + (far - near) * (at - static_cast<float>(before))) * (1 / kUnit);
}

Vec3f light_of_virtual(const SceneView& scene, const ScatterKernel& kernel, Vec3f p_world,
                       Rng& rng) noexcept {
  const VirtualLightsView& view = scene.virtual_lights;
  const int taken = std::min(kTaken, view.count);
  const float u = rng.next(), u0 = rng.next(), u1 = rng.next();
  const auto count = static_cast<float>(view.count);
  Vec3f sum(0);
  for (int k = 0; k < taken; ++k) {
    const float share = (static_cast<float>(k) + u) / static_cast<float>(taken);
    const int i = std::min(static_cast<int>(share * count), view.count - 1);
    const VirtualLight& light = view.lights[i];
    const Vec3f way = p_world - light.matter.p_world;
    const float d2 = dot(way, way);
    if (!(d2 > 0)) continue;
    const Vec3f direction = way * (1 / std::sqrt(d2));
    const ScatterParts here = kernel.eval(-direction);
    const Vec3f value = here.diffuse + here.specular + here.phase;
    if (!(max_component(value) > 0)) continue;
    const ScatterParts there = ScatterKernel(scene, light.matter, light.choice, light.wo).eval(direction);
    const float falloff =
        virtual_transmittance(view, i, p_world, u0, u1) / std::max(d2, view.nearest_mm * view.nearest_mm);
    sum += value * (there.diffuse + there.specular + there.phase) * light.flux * falloff;
  }
  return taken > 0 ? sum * (count / static_cast<float>(taken)) : Vec3f(0);
}

}  // namespace voxlume
