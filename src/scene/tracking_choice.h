#pragma once
#include "accel/accelerator.h"
#include "integrator/scene_view.h"
#include "light/compile_lights.h"
#include "tracking/estimators.h"
#include "voxlume/scene.h"

namespace voxlume {

// What a scene's words about rendering ask of accelerator, trackers and light samples.

/// The structure that a scene asks for. Throws Error kBadParameter for words it does not know, kUnsupported
/// for what does not go together.
AcceleratorChoice accelerator_choice(const SceneDescription& scene, const GridView& grid);

/// Throws Error kUnsupported where the trackers or the integrator do not go together with the rest.
void check_trackers(const SceneDescription& scene);

/// The trackers that a scene asks for, which check_trackers accepts.
TrackerChoice tracker_choice(const RenderDescription& render, const GridView& grid);

/// Throws Error kBadParameter where an integrator that marches would take more than a million steps from
/// corner to corner of the volume.
void check_march_steps(const RenderDescription& render, const GridView& grid);

/// Whether rays are marched for what is scattered once, and how.
RayMarchView ray_march_choice(const SceneDescription& scene);

/// What light samples are drawn for, by integrator and techniques.
EnvironmentSamples environment_samples(const RenderDescription& render, LightSampling sampling);

/// Whether all that tables of how light spreads depend on is the same in both: everything but the picture
/// and, unless lights are attached to it, the camera.
bool same_light(const SceneDescription& a, const SceneDescription& b);

/// Whether what is important is so at every point of the volume.
bool same_importance(const SceneDescription& a, const SceneDescription& b);

/// Whether it also lies on every pixel's ray where it did, and is looked for there in the same way.
bool same_pixel_lists(const SceneDescription& a, const SceneDescription& b);

}  // namespace voxlume
