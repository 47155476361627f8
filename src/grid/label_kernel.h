#pragma once
#include <cmath>

#include "grid/grid_view.h"

namespace voxlume {

/// The kernel that smooths labels, along an axis: (1 - (t/reach)^2)^3 for |t| < reach [voxels], much like a
/// Gaussian of standard deviation reach/3, which ends smoothly. Normals and outlines of labels use the same.
inline float label_weight(float t, float reach) noexcept {
  const float u = t / reach;
  const float rest = std::max(1 - u * u, 0.0f);
  return rest * rest * rest;
}

/// 4 voxels. Where voxels are longer along one axis than along others it reaches over fewer of them, so that
/// it is rounder in space; over less than 2.5 the stairs would show, over more than 5 it would take too long.
inline Vec3f label_kernel_reach(const GridView& grid) noexcept {
  constexpr float kReach = 4.0f, kLeastReach = 2.5f, kMostReach = 5;
  const Vec3f per_mm = grid.step_index;
  const float mean = std::cbrt(per_mm.x * per_mm.y * per_mm.z);
  return min(max(per_mm * (kReach / mean), Vec3f(kLeastReach)), Vec3f(kMostReach));
}

/// Voxels whose trilinear weight along one axis is less than this do not decide the vote of label_outline.h.
inline constexpr double kLeastVote = 0.0015;
/// The most voxels along an axis that a kernel around any coordinate reaches.
inline constexpr int kMostLabelTaps = 11;

}  // namespace voxlume
