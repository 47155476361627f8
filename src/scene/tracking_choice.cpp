#include "scene/tracking_choice.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "integrator/ray_march.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

bool has_default_trackers(const RenderDescription& render) {
  return render.transmittance == TransmittanceEstimator::kRatio &&
         render.free_flight == FreeFlightSampling::kDelta;
}

/// Whether rays are marched in steps.
bool marches(const RenderDescription& render) {
  return render.integrator != Integrator::kPath && render.integrator != Integrator::kAr2t;
}

bool follows_camera(const SceneDescription& scene) {
  return scene.environment->attached_to == Attachment::kCamera ||
         std::any_of(scene.lights->begin(), scene.lights->end(),
                     [](const LightDescription& light) { return light.attached_to == Attachment::kCamera; });
}

}  // namespace

AcceleratorChoice accelerator_choice(const SceneDescription& scene, const GridView& grid) {
  const RenderDescription& render = scene.render;
  AcceleratorChoice choice;
  choice.cell_voxels = render.macrocell_voxels;
  choice.costs.lookup = static_cast<float>(render.lookup_cost);
  choice.thresholds = {static_cast<float>(render.hierarchy_thresholds[0]),
                       static_cast<float>(render.hierarchy_thresholds[1])};
  if (render.accelerator == "none") {
    choice.kind = AcceleratorKind::kMacrocell;
    choice.cell_voxels = std::max({grid.size[0], grid.size[1], grid.size[2], 1});
  } else if (render.accelerator == "macrocell") {
    choice.kind = AcceleratorKind::kMacrocell;
  } else if (render.accelerator == "octree") {
    choice.kind = AcceleratorKind::kSkippingOctree;
  } else if (render.accelerator == "residency") {
    choice.kind = AcceleratorKind::kResidency;
  } else if (render.accelerator != "auto" && render.accelerator != "hierarchy") {
    throw Error(ErrorCode::kBadParameter, "/render/accelerator",
                "unknown \"" + render.accelerator +
                    "\"; expected auto, none, macrocell, octree, hierarchy or residency");
  } else if (render.hierarchy_rule == "thresholds") {
    choice.kind = AcceleratorKind::kThresholdOctree;
  } else if (render.hierarchy_rule != "cost") {
    throw Error(ErrorCode::kBadParameter, "/render/hierarchy_rule",
                "unknown \"" + render.hierarchy_rule + "\"; expected cost or thresholds");
  }
  if (!scene.transfer.rules.empty() || render.integrator == Integrator::kAr2t) {
    if (choice.kind != AcceleratorKind::kMacrocell && choice.kind != AcceleratorKind::kHierarchy)
      throw Error(ErrorCode::kUnsupported, "/render/accelerator",
                  "rules need auto, hierarchy (by cost), macrocell or none");
    if (!has_default_trackers(render))
      throw Error(ErrorCode::kUnsupported, "/render/transmittance",
                  "rules need transmittance ratio and free_flight delta");
  }
  // The estimators that need the cells' minima.
  if (!has_default_trackers(render)) {
    if (render.accelerator == "auto") choice.kind = AcceleratorKind::kMacrocell;
    if (choice.kind != AcceleratorKind::kMacrocell)
      throw Error(ErrorCode::kUnsupported, "/render/accelerator",
                  "the chosen transmittance or free_flight needs auto, none or macrocell, found \"" +
                      render.accelerator + "\"");
    choice.minima = CellMinima::kKept;
  }
  return choice;
}

void check_trackers(const SceneDescription& scene) {
  const RenderDescription& render = scene.render;
  if (marches(render) && !(has_default_trackers(render) && render.extinction == Extinction::kSingle))
    throw Error(ErrorCode::kUnsupported, "/render/integrator",
                std::string(enum_word(render.integrator)) +
                    " needs transmittance ratio, free_flight delta and extinction single");
  if (has_default_trackers(render)) return;
  if (scene.material.self_occlusion < 1)
    throw Error(ErrorCode::kUnsupported, "/material/self_occlusion",
                "below 1 needs transmittance ratio and free_flight delta");
  if (render.extinction == Extinction::kRgb)
    throw Error(ErrorCode::kUnsupported, "/render/extinction",
                "rgb needs transmittance ratio and free_flight delta");
}

TrackerChoice tracker_choice(const RenderDescription& render, const GridView& grid) {
  TrackerChoice choice{render.transmittance, render.free_flight};
  if (marches(render)) choice.step_mm = static_cast<float>(render.march_step_voxels) * grid.step_mm;
  return choice;
}

void check_march_steps(const RenderDescription& render, const GridView& grid) {
  if (!marches(render)) return;
  const Vec3f diagonal(static_cast<float>(grid.size[0]), static_cast<float>(grid.size[1]),
                       static_cast<float>(grid.size[2]));
  const double steps =
      length(grid.world_from_index.vector(diagonal)) / (render.march_step_voxels * grid.step_mm);
  if (steps > kMostMarchSteps)
    throw Error(ErrorCode::kBadParameter, "/render/march_step_voxels",
                fmt::format("{} makes {:.0f} steps from corner to corner of the volume; expected at most {}",
                            render.march_step_voxels, steps, kMostMarchSteps));
}

RayMarchView ray_march_choice(const SceneDescription& scene) {
  RayMarchView out;
  out.on = scene.render.integrator == Integrator::kRayMarch;
  out.jitter = scene.render.march_jitter;
  out.counts_steps = out.on && scene.visibility && scene.visibility->sums == ImportanceSums::kDiscrete;
  return out;
}

EnvironmentSamples environment_samples(const RenderDescription& render, LightSampling sampling) {
  if (render.integrator == Integrator::kExposureRender) return EnvironmentSamples::kUniform;
  return sampling == LightSampling::kMis && !marches(render) ? EnvironmentSamples::kExcess
                                                             : EnvironmentSamples::kWhole;
}

bool same_light(const SceneDescription& a, const SceneDescription& b) {
  const auto of_light = [&](SceneDescription scene) {
    scene.image = {};
    scene.render.frame = 0;
    scene.background.reset();
    scene.animation.reset();
    if (!follows_camera(scene)) scene.camera = {};
    return scene;
  };
  return of_light(a) == of_light(b);
}

bool same_importance(const SceneDescription& a, const SceneDescription& b) {
  if (!a.visibility || !b.visibility) return false;
  const auto all = [](const SceneDescription& s) {
    return std::tie(s.visibility->important, s.visibility->lookup, s.proxies);
  };
  return all(a) == all(b);
}

bool same_pixel_lists(const SceneDescription& a, const SceneDescription& b) {
  if (!same_importance(a, b)) return false;
  const auto all = [](const SceneDescription& s) {
    return std::tie(s.visibility->ray_samples, s.visibility->ray_passes, s.camera, s.clip, s.image.width,
                    s.image.height, s.render.seed);
  };
  return all(a) == all(b);
}

}  // namespace voxlume
