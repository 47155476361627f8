#pragma once
#include "base/vec.h"
#include "integrator/scatter_point.h"

namespace voxlume {

/// What a drawing (xu2025 Fig. 8) shows of matter seen along wo: its albedo times the ramp's colour for the
/// cosine between normal and light, weighted by the surface's share (the rest has the ramp's middle, cosine
/// 0), toward the contour's colour where the surface is seen edge on.
Vec3f illustrated(const IllustrationView& illustration, const MatterPoint& matter, Vec3f wo) noexcept;

}  // namespace voxlume
