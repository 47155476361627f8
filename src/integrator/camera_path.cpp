#include "integrator/camera_path.h"

#include <limits>

#include "integrator/background.h"
#include "integrator/illustration.h"
#include "integrator/unshadowed.h"
#include "integrator/virtual_lights.h"
#include "integrator/visibility.h"

namespace voxlume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Scatterings before Russian roulette may end an unlimited path.
constexpr int kRouletteDepth = 4;
/// Where nothing absorbs, a path survives its n-th scattering with probability 1 - kEnding / n: light comes
/// back from deep matter after n scatterings in proportion to n^-1.5, and weights that grow like n^kEnding,
/// kEnding < 1/2, keep its variance finite, where any constant probability below 1 does not.
constexpr float kEnding = 0.25f;
/// A path that carries at least this share of what it began with is spared otherwise: ending it as soon as it
/// carries less than all takes 1.3 times the work to the same error in the peer scene.
constexpr float kSparedThroughput = 1.0f / 3;

/// After the last scattering a direction only adds to what the light samples found: following every other one
/// takes about 0.9 of the time to the same error where lights are several, and costs nothing elsewhere.
/// Lights in a mirror and most of the environment are found by directions alone.
constexpr float kLastFlightShare = 0.5f;
constexpr float kGlossyAlpha = 0.1f;

/// Veach's power heuristic (beta = 2) for a technique of density `pdf` beside one of density `other`.
float power_heuristic(float pdf, float other) noexcept {
  const float ratio = other / pdf;
  return 1.0f / (1.0f + ratio * ratio);
}

}  // namespace

CameraPath::Wait CameraPath::begin(const SceneView& scene, const PrimaryRay& primary,
                                   TraceCounters& counters) noexcept {
  rng_ = primary.rng;
  first_ = primary.first;
  px_ = primary.px;
  py_ = primary.py;
  origin_world_ = primary.origin_world;
  direction_world_ = primary.direction_world;
  ray_ = primary.track;
  direction_pdf_ = 0;
  throughput_ = Vec3f(1);
  radiance_ = Vec3f(0);
  depth_ = 0;
  first_unshadowed_ = 0;
  out_ = {};
  if (scene.keeps_parts) first_light_ = {};
  on_light_ray_ = false;
  eye_list_ = scene.visibility.on ? list_at(scene, px_, py_) : SegmentListView{};
  ++counters.paths;
  return primary.enters ? Wait::kFlight : end_flight(scene, {}, counters);
}

/// At the first scattering a stratified number, if there is one; later the stream's.
float CameraPath::draw(float first) noexcept { return depth_ == 0 && first >= 0 ? first : rng_.next(); }

UnitPair CameraPath::draw(UnitPair first) noexcept {
  const float u0 = draw(first.u0), u1 = draw(first.u1);
  return {u0, u1};
}

/// From the last scattering in the direction drawn there.
TrackRay CameraPath::turned_ray() const noexcept {
  TrackRay ray = turn_ray_;
  if (depth_ == 1) {
    ray.u_collision = first_.u_next_collision;
    ray.u_depth = first_.u_next_depth;
  }
  return ray;
}

CameraPath::Wait CameraPath::fly(const SceneView& scene, TraceCounters& counters) noexcept {
  ray_ = turned_ray();
  return enters() ? Wait::kFlight : end_flight(scene, {}, counters);
}

/// Whether matter that the camera's flight collides with is one of the parts that fade: collisions with mu'
/// are those with mu, each kept with probability mu' / mu.
bool CameraPath::fades(const SceneView& scene, const Collision& collision) noexcept {
  if (depth_ > 0 || !(eye_list_.total > 0)) return false;
  const float kept = visibility_factor(scene.visibility.weights, eye_list_, collision.t_mm,
                                       importance_at(scene.visibility.importance, collision.p_index));
  return kept < 1 && rng_.next() >= kept;
}

/// Goes on from a collision that counts for nothing.
CameraPath::Wait CameraPath::fly_on(const Collision& collision) noexcept {
  ray_.t_near = collision.t_mm;
  ray_.u_collision = ray_.u_depth = -1;
  return Wait::kFlight;
}

/// Waits for the transmittance of the shadow ray: of the matter as it is, or, where some of it fades, found
/// by flights from collision to collision.
CameraPath::Wait CameraPath::cross_shadow(const SceneView& scene) noexcept {
  const VisibilityView& visibility = scene.visibility;
  const bool fades = visibility.on && (visibility.lights == VisibilityLights::kAll ||
                                       (visibility.lights == VisibilityLights::kFirst && depth_ == 0));
  if (!fades || !(max_component(unshadowed_) > 0)) return Wait::kTransmittance;
  light_list_ = find_light_importance(scene, ray_, rng_, light_segments_);
  if (!(light_list_.total > 0)) return Wait::kTransmittance;
  on_light_ray_ = true;
  light_transmittance_ = 1;
  return Wait::kFlight;
}

/// Ratio tracking of the matter that has not faded, whose tentative collisions are those with all of it.
CameraPath::Wait CameraPath::end_light_flight(const SceneView& scene, const Collision& collision,
                                              TraceCounters& counters) noexcept {
  if (collision.real) {
    const float kept = visibility_factor(scene.visibility.weights, light_list_, ray_.t_far - collision.t_mm,
                                         importance_at(scene.visibility.importance, collision.p_index));
    light_transmittance_ *= 1.0f - kept * scene.medium.shadow_extinction;
    if (light_transmittance_ < kRouletteTransmittance)
      light_transmittance_ =
          rng_.next() * kRouletteTransmittance < light_transmittance_ ? kRouletteTransmittance : 0.0f;
    if (light_transmittance_ > 0) return fly_on(collision);
  }
  on_light_ray_ = false;
  return end_shadow_ray(scene, light_transmittance_, counters);
}

CameraPath::Wait CameraPath::end() noexcept {
  out_.radiance = radiance_;
  return Wait::kNothing;
}

void CameraPath::weigh_flight(Vec3f weight) noexcept {
  if (on_light_ray_) return weigh_shadow_ray(weight);
  throughput_ *= weight;
  first_light_.weight *= weight;
}

void CameraPath::weigh_shadow_ray(Vec3f transmittance) noexcept {
  unshadowed_ *= transmittance;
  first_light_.arriving *= transmittance;
}

CameraPath::Wait CameraPath::end_flight(const SceneView& scene, const Collision& collision,
                                        TraceCounters& counters) noexcept {
  if (on_light_ray_) return end_light_flight(scene, collision, counters);
  if (collision.real && fades(scene, collision)) return fly_on(collision);
  if (depth_ > 0) {
    const Vec3f met = met_emitters(scene, collision);
    radiance_ += throughput_ * met;
    if (scene.keeps_parts && depth_ == 1) add_first(met * first_light_.weight);
  }
  if (!collision.real) {
    if (depth_ == 0) radiance_ = throughput_ * background(scene);
    return end();
  }
  if (scattered_out(scene) && !scene.matter_emits) return end();
  if (depth_ == 0) out_.depth_mm = collision.t_mm;
  ask(scene, collision);
  return Wait::kScattering;
}

/// Draws what the scattering at a collision takes.
void CameraPath::ask(const SceneView& scene, const Collision& collision) noexcept {
  const bool goes_on = !scattered_out(scene) && !scene.illustration.on;
  query_ = {collision.p_index, collision.value, -direction_world_,
            goes_on && scene.light_sampling != LightSampling::kDirection && scene.lights.pick.count > 0,
            goes_on && (!scatters_last(scene) || scene.last_flight_collects)};
  if (scene.scattering.shading == Shading::kExposureRender) query_.u_surface = rng_.next();
  if (query_.samples_light) {
    light_samples_left_ = light_samples(scene);
    // Of several, the first stratum; the numbers of the others follow.
    query_.u_pick = draw(first_.u_light);
    query_.u_light = query_.u_pick / static_cast<float>(light_samples_left_);
    query_.light = draw(first_.light);
  }
  if (query_.turns) {
    query_.u_lobe = draw(first_.u_lobe);
    query_.direction = draw(first_.direction);
  }
}

CameraPath::Wait CameraPath::end_scattering(const SceneView& scene, const Scattering& scattering,
                                            TraceCounters& counters) noexcept {
  const MatterPoint& matter = scattering.matter;
  // Matter that is cut away absorbs light that reaches it (only when it blocks light at all).
  if (scene.clip_blocks_light && !scene.clip_world.contains(matter.p_world) && depth_ > 0) return end();

  matter_ = matter;
  radiance_ += throughput_ * matter.emission;
  if (depth_ == 0) {
    out_.alpha = 1;
    out_.albedo = matter.scatter.albedo;
    out_.normal = matter.scatter.normal * scattering.surface_share;
    first_light_.dense =
        scene.keeps_parts && extinction_of(scene.medium, query_.p_index, query_.value) > scene.dense_mu_t;
  }
  if (scene.illustration.on) {
    radiance_ = throughput_ * illustrated(scene.illustration, matter, -direction_world_);
    return end();
  }
  if (scattered_out(scene)) return end();

  choice_ = scattering.choice;
  turn_ = scattering.turn;
  turn_ray_ = scattering.turn_ray;
  meets_rect_ = scattering.turn_meets_rect;
  if (scene.keeps_parts && depth_ == 0)
    first_light_.fx = unshadowed_shading(scene.lights, kernel(scene), matter_.p_world);
  ++counters.scatterings;
  radiance_ += throughput_ * matter_.scatter.albedo * scene.ambient;
  if (depth_ == 0 && scene.virtual_lights.count > 0)
    radiance_ += throughput_ * light_of_virtual(scene, kernel(scene), matter_.p_world, rng_);
  if (!query_.samples_light) return turn(scene, counters);
  --light_samples_left_;
  if (cast(scene, scattering.light, scattering.toward_light, scattering.light_ray, counters)) {
    if (depth_ == 0) ray_.u_depth = first_.u_shadow_depth;
    if (enters()) return cross_shadow(scene);
    radiance_ += unshadowed_;
    if (scene.keeps_parts && depth_ == 0) add_first(first_light_.arriving);
  }
  return next_light_sample(scene, counters);
}

/// Light met along a sampled direction before its collision: lights have no body, they only add.
Vec3f CameraPath::met_emitters(const SceneView& scene, const Collision& collision) const noexcept {
  Vec3f met(0);
  if (scene.light_sampling == LightSampling::kLight) return met;
  if (meets_rect_)
    visit_rect_hits(scene.lights, origin_world_, direction_world_, collision.t_mm,
                    [&](const LightHit& hit) { met += weighted(scene, hit); });
  if (!collision.real) met += weighted(scene, environment_hit(scene.lights, origin_world_, direction_world_));
  return met;
}

/// What a light met by a sampled direction adds to the path's throughput, beside what light samples find of
/// it.
Vec3f CameraPath::weighted(const SceneView& scene, const LightHit& hit) const noexcept {
  const float weight = scene.light_sampling == LightSampling::kDirection
                           ? 1.0f
                           : power_heuristic(direction_pdf_, hit.pdf * hit_samples_);
  return hit.radiance * weight;
}

/// Adds light that arrives at the first scattering from the direction under way.
void CameraPath::add_first(Vec3f light) noexcept {
  first_light_.diffuse += (first_light_.now.diffuse + first_light_.now.phase) * light;
  first_light_.specular += first_light_.now.specular * light;
}

RadianceParts CameraPath::parts() const noexcept {
  RadianceParts parts;
  if (!(out_.alpha > 0)) return parts;
  parts.fx_diffuse = first_light_.fx.diffuse;
  parts.fx_specular = first_light_.fx.specular;
  parts.later = out_.radiance;
  for (int c = 0; c < 3; ++c) {
    if (parts.fx_diffuse[c] > 0) parts.direct_diffuse[c] = first_light_.diffuse[c];
    if (parts.fx_specular[c] > 0) parts.direct_specular[c] = first_light_.specular[c];
    parts.later[c] = std::max(parts.later[c] - parts.direct_diffuse[c] - parts.direct_specular[c], 0.0f);
  }
  parts.dense = first_light_.dense;
  return parts;
}

/// What a camera ray that meets nothing sees.
Vec3f CameraPath::background(const SceneView& scene) noexcept {
  const bool draws = blurs_background(scene);
  const float u0 = draws ? rng_.next() : 0.0f, u1 = draws ? rng_.next() : 0.0f;
  return background_radiance(scene, px_, py_, direction_world_, u0, u1);
}

/// Next-event estimation: light from a sampled emitter, scattered back along the path. False: there is none,
/// else what remains is its shadow.
bool CameraPath::cast(const SceneView& scene, const LightSample& light, const ScatterValue& scattered,
                      const TrackRay& ray, TraceCounters& counters) noexcept {
  if (!(light.pdf > 0) || !(max_component(scattered.value * light.radiance) > 0)) return false;
  const float pdf = light.pdf * static_cast<float>(light_samples(scene));
  const float weight = light.delta || scene.light_sampling == LightSampling::kLight
                           ? 1.0f
                           : power_heuristic(pdf, scattered.pdf * flight_share(scene));
  unshadowed_ = throughput_ * scattered.value * light.radiance * (weight / pdf);
  const float boost = shadow_ray_boost(scene);
  if (!(boost > 0)) return false;
  unshadowed_ *= boost;
  if (scene.keeps_parts && depth_ == 0) {
    first_light_.now = kernel(scene).eval(light.wi);
    first_light_.arriving = throughput_ * light.radiance * (weight / pdf * boost);
  }
  ++counters.shadow_rays;
  ray_ = ray;
  return true;
}

/// Light samples beyond the first.
CameraPath::Wait CameraPath::next_light_sample(const SceneView& scene, TraceCounters& counters) noexcept {
  const auto count = static_cast<float>(light_samples(scene));
  while (light_samples_left_ > 0) {
    const auto stratum = static_cast<float>(light_samples_left_--);
    const float u0 = rng_.next(), u1 = rng_.next();
    const LightSample light =
        sample_light(scene.lights, matter_.p_world, (stratum + query_.u_pick) / count, u0, u1);
    const TrackRay ray = ray_from(scene, query_.p_index, matter_.p_world, light.wi, light.distance_mm);
    const ScatterParts h = kernel(scene).eval(light.wi);
    if (!cast(scene, light, {h.diffuse + h.specular + h.phase, h.pdf}, ray, counters)) continue;
    if (enters()) return cross_shadow(scene);
    radiance_ += unshadowed_;
    if (scene.keeps_parts && depth_ == 0) add_first(first_light_.arriving);
  }
  return turn(scene, counters);
}

CameraPath::Wait CameraPath::end_shadow_ray(const SceneView& scene, float transmittance,
                                            TraceCounters& counters) noexcept {
  radiance_ += unshadowed_ * transmittance;
  const bool of_first = depth_ == 0 || (depth_ == 1 && scattered_out(scene));
  if (scene.keeps_parts && of_first) add_first(first_light_.arriving * transmittance);
  return scattered_out(scene) ? end() : next_light_sample(scene, counters);
}

/// The probability of following the direction that is drawn at the present scattering.
float CameraPath::flight_share(const SceneView& scene) const noexcept {
  const bool glossy = choice_.specular > 0 && matter_.scatter.alpha < kGlossyAlpha;
  const bool needed = glossy || scene.lights.has_environment || scene.light_sampling != LightSampling::kMis;
  return scatters_last(scene) && !needed ? kLastFlightShare : 1.0f;
}

/// Russian roulette for shadow rays, in proportion to what they can add: what a ray that is cast counts for,
/// 0 for one that is not. The measure is the path's own first one, so that nothing depends on how bright the
/// lights are.
float CameraPath::shadow_ray_boost(const SceneView& scene) noexcept {
  if (!(scene.shadow_roulette > 0)) return 1;
  const float size = max_component(unshadowed_);
  if (!(first_unshadowed_ > 0)) first_unshadowed_ = size;
  const float threshold = scene.shadow_roulette * first_unshadowed_;
  if (!(size < threshold)) return 1;
  return rng_.next() * threshold < size ? threshold / size : 0.0f;
}

/// Turns the path at a scattering, unless it is absorbed or nothing can come of it.
CameraPath::Wait CameraPath::turn(const SceneView& scene, TraceCounters& counters) noexcept {
  if (!query_.turns || !(turn_.pdf > 0)) return end();
  // After the last scattering a direction only adds to what the light samples found; with less than certainty
  // it is one technique of the heuristic that takes `share` samples.
  const float share = flight_share(scene);
  if (share < 1 && rng_.next() >= share) return end();
  if (scene.keeps_parts && depth_ == 0) {
    first_light_.now = kernel(scene).eval(turn_.wi);
    first_light_.weight = throughput_ * (1 / (turn_.pdf * share));
  }
  throughput_ *= turn_.value / (turn_.pdf * share);
  origin_world_ = matter_.p_world;
  direction_world_ = turn_.wi;
  direction_pdf_ = turn_.pdf;
  hit_samples_ = static_cast<float>(light_samples(scene)) / share;
  if (!(max_component(throughput_) > 0) || !survives()) return end();
  ++depth_;
  return scattered_out(scene) && !scene.matter_emits ? reach_lights(scene, counters) : fly(scene, counters);
}

/// After the last scattering it does not matter where a flight ends, but what reaches it: an estimate of the
/// transmittance tells with less variance.
CameraPath::Wait CameraPath::reach_lights(const SceneView& scene, TraceCounters& counters) noexcept {
  if (meets_rect_) return fly(scene, counters);  // light at its own distance takes a flight
  const Vec3f met = weighted(scene, environment_hit(scene.lights, origin_world_, direction_world_));
  unshadowed_ = throughput_ * met;
  first_light_.arriving = met * first_light_.weight;
  if (!(max_component(unshadowed_) > 0)) return end();
  ray_ = turned_ray();
  return enters() ? Wait::kTransmittance : end_shadow_ray(scene, 1, counters);
}

/// Russian roulette, whatever the scattering limit.
bool CameraPath::survives() noexcept {
  if (depth_ < kRouletteDepth) return true;
  const float probability =
      std::min(1.0f - kEnding / static_cast<float>(depth_), max_component(throughput_) / kSparedThroughput);
  if (rng_.next() >= probability) return false;
  throughput_ *= 1.0f / probability;
  return true;
}

}  // namespace voxlume
