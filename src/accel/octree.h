#pragma once
#include <vector>

#include "accel/octree_view.h"
#include "grid/value_range.h"
#include "transfer/transfer_function.h"

namespace voxlume {

/// When a walk of an octree changes its level: in expected tentative collisions over the edge of a finest
/// cell. Any values give the same picture, at another speed.
struct OctreeThresholds {
  float climb = 0.1f;    ///< >= 0; nodes with less are left for their parents
  float descend = 1.0f;  ///< >= 0; nodes with more are left for their parts
};

/// A complete octree of majorants of one volume under one transfer function.
class MajorantOctree {
 public:
  /// `cell_voxels` >= 1 is the finest cell's edge.
  MajorantOctree(const GridView& grid, int cell_voxels);
  MajorantOctree(const MajorantOctree&) = delete;
  MajorantOctree(MajorantOctree&&) = default;

  /// Recomputes every majorant: of a finest cell the exact supremum of mu_t over its value range times
  /// kMajorantSafety, of a node the greatest of its parts'.
  void update(const TransferFunction& transfer);

  OctreeView view() const;
  /// The edge of a finest cell [mm]; of a cube with the same mean chord where voxels are no cubes.
  float cell_mm() const { return cell_mm_; }

 private:
  struct Level {
    std::int32_t count[3];
    std::vector<float> mu_maj;
  };
  void reduce(int level);

  ValueRangeGrid ranges_;
  Box3f domain_;
  float cell_mm_;
  std::vector<Level> levels_;
  std::vector<OctreeLevel> level_views_;
};

/// A MajorantOctree that is walked as xu2024 does.
class SkippingOctree : public MajorantOctree {
 public:
  using MajorantOctree::MajorantOctree;
  SkippingOctreeView view() const { return {MajorantOctree::view()}; }
};

/// A MajorantOctree that is walked as xu2025 does.
class ThresholdOctree : public MajorantOctree {
 public:
  ThresholdOctree(const GridView& grid, int cell_voxels, OctreeThresholds thresholds = {})
      : MajorantOctree(grid, cell_voxels), thresholds_(thresholds) {}
  ThresholdOctreeView view() const {
    return {MajorantOctree::view(), thresholds_.climb / cell_mm(), thresholds_.descend / cell_mm()};
  }

 private:
  OctreeThresholds thresholds_;
};

/// The finest cell of an octree with 2^level of them along the volume's longest axis (the paper's leaf
/// level).
int octree_cell_voxels(const GridView& grid, int level);

}  // namespace voxlume
