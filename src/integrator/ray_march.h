#pragma once
#include "film/film.h"
#include "film/trace_counters.h"
#include "integrator/primary_ray.h"
#include "integrator/scene_view.h"

namespace voxlume {

/// Steps from corner to corner of a volume beyond which nothing is marched.
inline constexpr int kMostMarchSteps = 1000000;

/// One camera sample by emission-absorption ray marching with single scattering, as Ament et al. 2017
/// ("Extinction-optimized volume illumination") has it and lerzer2025 section 6.2 compares with it. Steps of
/// scene.trackers.step_mm have opacity 1 - exp(-mu_t step) and are composited front to back; a ray ends, as
/// if opaque, where less than 1e-4 comes through, and steps that weigh less than 1e-4 together are not lit.
/// Every delta light, and one sample of every rectangular light and of the environment, lights a step
/// through a shadow ray of the same steps. What hides the important fades by a first pass along the ray
/// (lerzer2025 eq. 4), and along shadow rays too, as visibility.lights says.
///
/// Without jitter, and with delta lights alone, nothing is random but the place in the pixel. `parts`, if not
/// null, takes what the radiance is made of.
PixelSample march_camera_ray(const SceneView& scene, const PrimaryRay& primary, TraceCounters& counters,
                             RadianceParts* parts) noexcept;

}  // namespace voxlume
