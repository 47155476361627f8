#pragma once
#include <cstdint>

#include "accel/block_walk.h"

namespace voxlume {

/// One level of an octree that is stored whole: majorants [1/mm], i fastest.
struct OctreeLevel {
  const float* mu_maj = nullptr;
  std::int32_t count_i = 0;
  std::int64_t count_ij = 0;
};

/// A complete octree of majorants. Level 0 are the finest cells; a node of level l covers 2^l cells a side,
/// and its majorant is the greatest of its parts'. The last level is one node.
struct OctreeView : CellGrid {
  const OctreeLevel* levels = nullptr;
  std::int32_t top_level = 0;

  /// Of the node of `level` that holds a cell inside the grid.
  float node(int level, const std::int32_t (&cell)[3]) const noexcept {
    const OctreeLevel& l = levels[level];
    return l.mu_maj[(cell[2] >> level) * l.count_ij + std::int64_t{cell[1] >> level} * l.count_i +
                    (cell[0] >> level)];
  }
};

/// xu2024 section 4.3: cell by cell through what is visible; empty nodes are left as a whole.
struct SkippingOctreeView : OctreeView {
  float find_block(const std::int32_t (&cell)[3], int& level) const noexcept {
    std::int32_t at[3];
    clamp_cell(cell, at);
    level = 0;
    const float mu_maj = node(0, at);
    if (mu_maj > 0) return mu_maj;
    while (level < top_level && !(node(level + 1, at) > 0)) ++level;
    return 0;
  }
};

/// xu2025 section 4: goes on at the level of the node before, climbs from empty nodes to empty parents and
/// from thin ones (majorant below `climb`) to parents that are not dense (not above `descend`), and descends
/// into dense ones.
struct ThresholdOctreeView : OctreeView {
  float climb = 0, descend = 0;  ///< 1/mm; mu1 and mu2 of the paper

  float find_block(const std::int32_t (&cell)[3], int& level) const noexcept {
    std::int32_t at[3];
    clamp_cell(cell, at);
    float mu_maj = node(level, at);
    // A parent is at least as dense as its children, so that no node is met twice whatever the thresholds.
    for (;;) {
      if (mu_maj > descend && level > 0) {
        mu_maj = node(--level, at);
        continue;
      }
      if (level == top_level) return mu_maj;
      const float parent = node(level + 1, at);
      const bool up = mu_maj > 0 ? mu_maj < climb && !(parent > descend) : !(parent > 0);
      if (!up) return mu_maj;
      mu_maj = parent;
      ++level;
    }
  }
};

using SkippingOctreeWalk = BlockWalk<SkippingOctreeView>;
using ThresholdOctreeWalk = BlockWalk<ThresholdOctreeView>;

}  // namespace voxlume
