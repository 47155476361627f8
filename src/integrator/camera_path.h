#pragma once
#include <vector>

#include "film/film.h"
#include "film/trace_counters.h"
#include "integrator/primary_ray.h"
#include "integrator/scattering.h"
#include "integrator/scene_view.h"
#include "integrator/unshadowed.h"
#include "tracking/tracking.h"

namespace voxlume {

/// One camera sample of a pixel: an unbiased estimate of its radiance. Scattering positions by delta
/// tracking, direct light by next-event estimation with ratio-tracked shadow rays, combined with direction
/// sampling by the power heuristic; after the last allowed scattering the sampled direction still collects
/// light that reaches it unscattered.
///
/// A path stops wherever a ray is to be tracked or a collision to be shaded and goes on with what was found,
/// so that one thread can follow many paths at once.
class CameraPath {
 public:
  /// What a path waits for; kNothing when it has ended.
  enum class Wait { kNothing, kFlight, kTransmittance, kScattering };

  /// Begins a sample.
  Wait begin(const SceneView& scene, const PrimaryRay& primary, TraceCounters& counters) noexcept;
  /// Where channels have extinctions of their own, before end_flight: what the flight multiplies the
  /// throughput by.
  void weigh_flight(Vec3f weight) noexcept;
  /// The same before end_shadow_ray, which then takes a transmittance of 1.
  void weigh_shadow_ray(Vec3f transmittance) noexcept;
  /// What the path carries along the flight, which may be that of a shadow ray.
  const Vec3f& carried() const noexcept { return on_light_ray_ ? unshadowed_ : throughput_; }

  /// Goes on from kFlight.
  Wait end_flight(const SceneView& scene, const Collision& collision, TraceCounters& counters) noexcept;
  /// Goes on from kTransmittance, with an unbiased estimate of it.
  Wait end_shadow_ray(const SceneView& scene, float transmittance, TraceCounters& counters) noexcept;

  /// Goes on from kScattering, with scatter_at(query()).
  Wait end_scattering(const SceneView& scene, const Scattering& scattering, TraceCounters& counters) noexcept;

  /// The collision to shade.
  const ScatteringQuery& query() const noexcept { return query_; }
  /// The ray to track, and its random stream, from which the tracker draws.
  const TrackRay& ray() const noexcept { return ray_; }
  Rng& rng() noexcept { return rng_; }
  /// The result, once nothing is waited for.
  const PixelSample& sample() const noexcept { return out_; }
  /// What its radiance is made of; only if the scene keeps parts.
  RadianceParts parts() const noexcept;

 private:
  float draw(float first) noexcept;
  UnitPair draw(UnitPair first) noexcept;
  /// Whether the path has made all the scatterings it may.
  bool scattered_out(const SceneView& scene) const noexcept {
    return scene.max_scatter > 0 && depth_ == scene.max_scatter;
  }
  /// Whether one more makes it so.
  bool scatters_last(const SceneView& scene) const noexcept {
    return scene.max_scatter > 0 && depth_ + 1 == scene.max_scatter;
  }
  bool enters() const noexcept { return ray_.t_near < ray_.t_far; }
  TrackRay turned_ray() const noexcept;
  Wait fly(const SceneView& scene, TraceCounters& counters) noexcept;
  bool fades(const SceneView& scene, const Collision& collision) noexcept;
  Wait fly_on(const Collision& collision) noexcept;
  Wait cross_shadow(const SceneView& scene) noexcept;
  Wait end_light_flight(const SceneView& scene, const Collision& collision, TraceCounters& counters) noexcept;
  Wait end() noexcept;
  Vec3f weighted(const SceneView& scene, const LightHit& hit) const noexcept;
  Vec3f met_emitters(const SceneView& scene, const Collision& collision) const noexcept;
  Vec3f background(const SceneView& scene) noexcept;
  void ask(const SceneView& scene, const Collision& collision) noexcept;
  void add_first(Vec3f light) noexcept;
  Wait next_light_sample(const SceneView& scene, TraceCounters& counters) noexcept;
  bool cast(const SceneView& scene, const LightSample& light, const ScatterValue& scattered,
            const TrackRay& ray, TraceCounters& counters) noexcept;
  int light_samples(const SceneView& scene) const noexcept { return depth_ == 0 ? scene.light_samples : 1; }
  float flight_share(const SceneView& scene) const noexcept;
  Wait turn(const SceneView& scene, TraceCounters& counters) noexcept;
  Wait reach_lights(const SceneView& scene, TraceCounters& counters) noexcept;
  bool survives() noexcept;
  float shadow_ray_boost(const SceneView& scene) noexcept;
  ScatterKernel kernel(const SceneView& scene) const noexcept {
    return {scene, matter_, choice_, -direction_world_};
  }

  Rng rng_;
  TrackRay ray_;
  FirstNumbers first_;
  float px_ = 0, py_ = 0;
  Vec3f origin_world_, direction_world_;
  Vec3f throughput_;
  float direction_pdf_ = 0;  ///< with which the direction was sampled; 0 for the camera's
  int depth_ = 0;            ///< scatterings so far
  ScatteringQuery query_{};  ///< of the present scattering, as what follows
  MatterPoint matter_{};
  ScatterChoice choice_{};
  ScatterSample turn_{};
  TrackRay turn_ray_;
  bool meets_rect_ = false;  ///< whether any rect light shines against it
  int light_samples_left_ = 0;
  /// Light samples taken where the present direction was drawn, over the probability of following that.
  float hit_samples_ = 1;
  SegmentListView eye_list_;   ///< what is important on the camera's ray
  bool on_light_ray_ = false;  ///< whether the flight under way is along a shadow ray
  float light_transmittance_ = 1;
  SegmentListView light_list_;  ///< in light_segments_
  std::vector<ImportanceSegment> light_segments_;
  Vec3f unshadowed_;            ///< radiance that the shadow ray's transmittance scales
  float first_unshadowed_ = 0;  ///< of the path's first shadow ray; 0 before that
  Vec3f radiance_;
  PixelSample out_;

  /// Of the first scattering, for RadianceParts.
  struct FirstLight {
    UnshadowedShading fx;
    Vec3f diffuse, specular;  ///< sums of h_k E_k over the techniques (xu2024 section 5.1)
    ScatterParts now;         ///< h_k of the direction under way
    Vec3f weight;             ///< of light met there, where a path follows it
    Vec3f arriving;           ///< E_k of the shadow ray under way, without its transmittance
    bool dense;
  } first_light_{};
};

}  // namespace voxlume
