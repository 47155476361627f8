#pragma once
#include "integrator/scattering.h"
#include "light/lights_view.h"

namespace voxlume {

/// How matter would look if nothing stood between it and the lights, for lights of unit brightness: a white
/// Lambert surface that faces all of the light has 1. The phase function belongs to the diffuse part.
struct UnshadowedShading {
  Vec3f diffuse, specular;
};

/// pi times the mean of h over the lights, each weighted by the luminance of the irradiance that it would
/// give at `p_world` and seen in the direction of its centre; the environment counts by its mean, from all
/// around. Where there is no light it is the albedo.
UnshadowedShading unshadowed_shading(const LightsView& lights, const ScatterKernel& kernel,
                                     Vec3f p_world) noexcept;

}  // namespace voxlume
