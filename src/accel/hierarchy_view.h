#pragma once
#include <bit>
#include <cstdint>

#include "accel/block_walk.h"

namespace voxlume {

inline constexpr std::uint32_t kLevelMask = 7;

/// Majorants of aligned blocks of cells. Cell (i,j,k), each index from -1 to count inclusive, covers p_index
/// [i*c, (i+1)*c] per axis; the cells outside [0, count) continue their neighbours, so that a ray in the
/// domain [-1/2, n-1/2] never leaves the table. One word tells a cell's majorant [1/mm], and in its three
/// lowest bits the level l of the block of 2^l cells a side, aligned to 2^l, that the cell is part of and
/// that has this majorant as a whole.
struct HierarchyView {
  const std::uint32_t* words = nullptr;  ///< of cell (0,0,0); i fastest
  std::int32_t stride_j = 0, stride_k = 0;
  std::int32_t count[3] = {0, 0, 0};
  float cell_voxels = 1, cells_per_voxel = 1;
  Box3f domain;  ///< index space

  float find_block(const std::int32_t (&cell)[3], int& level) const noexcept {
    const std::uint32_t word =
        words[cell[2] * std::int64_t{stride_k} + cell[1] * std::int64_t{stride_j} + cell[0]];
    level = static_cast<int>(word & kLevelMask);
    return std::bit_cast<float>(word & ~kLevelMask);
  }
};

using HierarchyRay = BlockRay;

/// Prepares `origin + t * direction`, 0 <= t <= length_mm, for a walk of `view`.
inline HierarchyRay make_hierarchy_ray(const HierarchyView& view, Vec3f origin, Vec3f direction,
                                       float length_mm) noexcept {
  return make_block_ray(view.domain, origin, direction, length_mm);
}

/// Walks the blocks that a ray crosses. The vector tracker does the same arithmetic in the same order.
using HierarchyWalk = BlockWalk<HierarchyView>;

}  // namespace voxlume
