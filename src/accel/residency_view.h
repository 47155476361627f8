#pragma once
#include <cstdint>

#include "accel/block_walk.h"

namespace voxlume {

/// A node of ResidencyView. What is not resident (no visible value) has neither majorant nor children.
struct ResidencyNode {
  float mu_maj = 0;            ///< 1/mm; of a leaf, which is one brick
  std::uint32_t children = 0;  ///< the first of 8 nodes, by the cell's lower bits (i lowest); 0: none
};

/// After Herzberger et al. 2024, "Residency Octree", with all data in memory: a sparse octree whose nodes
/// tell whether anything in them is resident, which here is whether anything is visible. Rays look nodes up
/// from the root, leave out what is not resident and go through the others' bricks.
struct ResidencyView : CellGrid {
  const ResidencyNode* nodes = nullptr;  ///< the root first
  std::int32_t top_level = 0;            ///< of the root; bricks are level 0

  float find_block(const std::int32_t (&cell)[3], int& level) const noexcept {
    std::int32_t at[3];
    clamp_cell(cell, at);
    level = top_level;
    const ResidencyNode* node = nodes;
    while (node->children != 0) {
      --level;
      node = nodes + node->children +
             ((at[2] >> level & 1) << 2 | (at[1] >> level & 1) << 1 | (at[0] >> level & 1));
    }
    return node->mu_maj;
  }
};

using ResidencyWalk = BlockWalk<ResidencyView>;

}  // namespace voxlume
