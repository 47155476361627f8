#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/affine.h"
#include "base/box.h"
#include "base/voxel_type.h"
#include "voxlume/volume.h"

namespace voxlume {

/// A volume as kernels see it. p_index is integer at voxel centres; the field lives on [-1/2, n-1/2] and is
/// continued from the outermost voxel centres (clamped).
struct GridView {
  const void* voxels = nullptr;
  VoxelType type = VoxelType::kU8;
  std::int32_t size[3] = {0, 0, 0};
  std::int64_t stride_j = 0, stride_k = 0;  ///< in voxels; stride of i is 1
  Affinef index_from_world;                 ///< p_index from LPS mm
  Affinef world_from_index;
  Vec3f step_index;   ///< one smallest voxel spacing, along each index axis [index units]
  float step_mm = 1;  ///< the smallest voxel spacing

  /// The whole field's domain.
  Box3f index_box() const { return {Vec3f(-0.5f), Vec3f(size[0] - 0.5f, size[1] - 0.5f, size[2] - 0.5f)}; }
};

/// Calls f with a typed pointer to the voxels.
template <class F>
auto with_voxels(VoxelType type, const void* voxels, F&& f) {
  return with_voxel_type(type, [&](auto value) { return f(static_cast<const decltype(value)*>(voxels)); });
}

/// Builds the view of `volume`, which must outlive it.
GridView make_grid_view(const Volume& volume);

/// Physical placement of a volume in double precision: LPS mm from p_index.
Affined world_from_index(const Volume& volume);

/// The smallest axis-aligned LPS box that holds the whole domain of `volume` [mm].
Box3d world_bounds(const Volume& volume);

}  // namespace voxlume
