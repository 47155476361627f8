#pragma once
#include <algorithm>

#include "grid/grid_view.h"

namespace voxlume {

/// sample_trilinear of typed voxels.
template <class T>
inline float interpolate(const T* voxels, const GridView& grid, Vec3f p_index) noexcept {
  std::int64_t base[3];
  std::int64_t next[3];
  float f[3];
  const std::int64_t stride[3] = {1, grid.stride_j, grid.stride_k};
  for (int a = 0; a < 3; ++a) {
    const float last = static_cast<float>(grid.size[a] - 1);
    const float p = std::clamp(p_index[a], 0.0f, last);
    const std::int32_t i = std::min(static_cast<std::int32_t>(p), std::max(grid.size[a] - 2, 0));
    f[a] = p - static_cast<float>(i);
    base[a] = i * stride[a];
    next[a] = i + 1 < grid.size[a] ? stride[a] : 0;
  }
  const T* v = voxels + base[0] + base[1] + base[2];
  const auto row = [&](std::int64_t offset) {
    const float lower = static_cast<float>(v[offset]);
    return lower + f[0] * (static_cast<float>(v[offset + next[0]]) - lower);
  };
  const float v00 = row(0), v10 = row(next[1]);
  const float v01 = row(next[2]), v11 = row(next[1] + next[2]);
  const float v0 = v00 + f[1] * (v10 - v00);
  const float v1 = v01 + f[1] * (v11 - v01);
  return v0 + f[2] * (v1 - v0);
}

/// The data at p_index, interpolated from the 8 voxels around it. Outside the voxel centres it is continued
/// from the nearest ones. NaN where a voxel it touches is NaN.
inline float sample_trilinear(const GridView& grid, Vec3f p_index) noexcept {
  return with_voxels(grid.type, grid.voxels,
                     [&](const auto* voxels) { return interpolate(voxels, grid, p_index); });
}

/// The place in memory of the voxel nearest to p_index.
inline std::int64_t nearest_voxel(const GridView& grid, Vec3f p_index) noexcept {
  std::int64_t at = 0;
  const std::int64_t stride[3] = {1, grid.stride_j, grid.stride_k};
  for (int a = 0; a < 3; ++a) {
    const float p = std::clamp(p_index[a] + 0.5f, 0.0f, static_cast<float>(grid.size[a] - 1));
    at += static_cast<std::int64_t>(p) * stride[a];
  }
  return at;
}

/// The voxel nearest to p_index: what discrete data (labels) is looked up with.
inline float sample_nearest(const GridView& grid, Vec3f p_index) noexcept {
  const std::int64_t at = nearest_voxel(grid, p_index);
  return with_voxels(grid.type, grid.voxels, [&](const auto* v) { return static_cast<float>(v[at]); });
}

/// Gradient of the interpolated data in LPS [data units per mm]: central differences over one smallest voxel
/// spacing on either side (Exposure Render's stencil).
inline Vec3f sample_gradient(const GridView& grid, Vec3f p_index) noexcept {
  Vec3f along;  // derivative along each index axis, per mm
  with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    for (int a = 0; a < 3; ++a) {
      Vec3f offset;
      offset[a] = grid.step_index[a];
      along[a] = (interpolate(voxels, grid, p_index + offset) - interpolate(voxels, grid, p_index - offset)) /
                 (2.0f * grid.step_mm);
    }
  });
  // The index axes are orthogonal, so their unit directions carry the derivatives over; step_index/step_mm is
  // one over the axis' spacing.
  return grid.world_from_index.vector(along * grid.step_index) / grid.step_mm;
}

}  // namespace voxlume
