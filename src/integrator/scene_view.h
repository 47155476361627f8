#pragma once
#include <cstdint>

#include "camera/camera.h"
#include "light/lights_view.h"
#include "material/material.h"
#include "tracking/estimators.h"
#include "tracking/lanes.h"
#include "tracking/medium.h"
#include "visibility/importance.h"
#include "voxlume/scene.h"

namespace voxlume {

/// Colours laid over the transfer function's by a label volume.
struct LabelsView {
  GridView grid;                 ///< nearest lookup
  const Vec3f* color = nullptr;  ///< by label value; component x < 0: the label has no colour
  std::int32_t color_count = 0;  ///< 0: no labels
  float strength = 1;
};

/// F0 of a dielectric whose `specular` is 1.
inline constexpr float kMostDielectricF0 = 0.08f;

/// How matter scatters where no rule says otherwise.
struct ScatteringView {
  Shading shading = Shading::kCoexistence;
  SurfaceShareForm surface_share = SurfaceShareForm::kHybrid;
  float gradient_factor = 0.5f;
  bool opacity_modulated = true;
  float g = 0, alpha = 0.16f, f0 = 0.04f;
  float inverse_gradient_scale = 1;  ///< 1 / 99.9th percentile of the gradient magnitude [mm per data unit]
  /// Kind kBlinnPhong: the strength of highlights over the extinction's gradient [mm^2], and their exponent.
  float highlight_mm2 = 0, shininess = 40;
  bool particles = false;               ///< normalised lobes (material/particles.h), else the reciprocal BRDF
  const Material* materials = nullptr;  ///< the scene's own, then those that rules number from 0
};

/// A drawing in place of light transport.
struct IllustrationView {
  bool on = false;
  TransferView ramp;  ///< colours by the cosine between normal and light
  Vec3f to_light{0};  ///< unit
  float contour = 0, contour_width = 0;
  Vec3f contour_color{0};
};

/// What is known of the importance along the ray of every pixel's centre.
struct PixelListsView {
  struct Head {
    std::size_t first;
    std::int32_t count;
    float entry, exit, total;
  };
  const Head* heads = nullptr;  ///< by pixel, row by row
  const ImportanceSegment* pool = nullptr;
};

/// What hides the important fades (lerzer2025).
struct VisibilityView {
  bool on = false;
  ImportanceView importance;
  VisibilityWeights weights;
  PixelListsView pixels;
  VisibilityLights lights = VisibilityLights::kOff;
  std::int32_t light_samples = 200;
};

/// Steps along rays in place of flights (integrator/ray_march.h), trackers.step_mm long.
struct RayMarchView {
  bool on = false;
  bool jitter = true;  ///< rays begin anywhere in the first step, else in its middle
  bool counts_steps =
      false;  ///< importance is summed over steps: visibility.weights are per step, not per mm
};

struct VirtualLight;
/// Virtual point lights (integrator/virtual_lights.h).
struct VirtualLightsView {
  const VirtualLight* lights = nullptr;
  std::int32_t count = 0;
  const std::uint16_t* transmittance = nullptr;  ///< by light, direction and distance; 65535 is 1
  float reach_mm = 1;                            ///< the greatest of the distances
  float nearest_mm = 1;                          ///< nearer lights count as this far
};

enum class LightSampling { kMis, kLight, kDirection };

/// Everything a path needs, as plain data. Compiled once by CompiledScene, which owns what this points to.
struct SceneView {
  Medium medium;
  SimdTarget simd = SimdTarget::kScalar;        ///< the instruction set that tracks rays; kScalar: one by one
  TrackerChoice trackers;                       ///< of scalar code; vector code has the default ones only
  Extinction extinction = Extinction::kSingle;  ///< rgb: scalar code, with the default trackers
  Box3f domain_index;                           ///< the volume
  Box3f clip_world;                             ///< LPS mm; what is kept
  bool clip_blocks_light = false;               ///< what is cut away still attenuates light
  ScatteringView scattering;
  LabelsView labels;
  IllustrationView illustration;
  VisibilityView visibility;
  RayMarchView ray_march;

  LightsView lights;
  VirtualLightsView virtual_lights;  ///< what they give is added at a path's first scattering
  Vec3f ambient{0};                  ///< radiance added unshadowed at every scattering (xu2024 6.1)
  CameraView camera;
  BackgroundKind background = BackgroundKind::kColor;
  Vec3f background_color{0};

  std::int32_t width = 0, height = 0;
  PixelFilter filter = PixelFilter::kGaussian;
  float filter_radius_px = 1.5f;
  Sampler sampler = Sampler::kSobol;
  std::uint64_t seed = 0;
  std::uint32_t frame = 0;
  std::int32_t max_scatter = 2;    ///< 0: no limit
  std::int32_t light_samples = 1;  ///< at the first scattering; later ones take one
  float shadow_roulette = 0;       ///< times the path's first shadow ray; 0: every shadow ray is cast
  LightSampling light_sampling = LightSampling::kMis;
  bool matter_emits = false;
  bool shades_singly = false;  ///< matter is not everywhere alike: shaded by scalar code
  bool keeps_parts = false;    ///< paths keep their RadianceParts
  float dense_mu_t = 0;        ///< [1/mm]; matter that is denser stands for the pixel (xu2024 5.2)
  /// Whether a flight after the last scattering can meet anything that emits.
  bool last_flight_collects = true;
};

/// The part of a ray up to t_max [mm] that is inside the volume and, if `clipped`, inside the clip box. None:
/// t_near >= t_far.
inline TrackRay visible_part(const SceneView& scene, const IndexRay& ray, Vec3f origin_world,
                             Vec3f direction_world, float t_max, bool clipped) noexcept {
  Interval<float> run = clip_ray(scene.domain_index, ray.origin_index, ray.direction_index, 0.0f, t_max);
  if (!run.empty() && clipped)
    run = clip_ray(scene.clip_world, origin_world, direction_world, run.t_near, run.t_far);
  return {ray, run.t_near, run.t_far};
}

}  // namespace voxlume
