#pragma once
#include <vector>

#include "accel/octree.h"
#include "accel/residency_view.h"

namespace voxlume {

/// The sparse octree of ResidencyView, of one volume under one transfer function.
class ResidencyOctree {
 public:
  /// `brick_voxels` >= 1 is a brick's edge.
  ResidencyOctree(const GridView& grid, int brick_voxels) : bricks_(grid, brick_voxels) {}

  /// Builds the tree anew.
  void update(const TransferFunction& transfer);

  ResidencyView view() const;

 private:
  MajorantOctree bricks_;
  std::vector<ResidencyNode> nodes_;
};

/// A brick's edge when the user names none: 4 voxels up to 2^24 voxels, 8 above.
int default_brick_voxels(const GridView& grid);

}  // namespace voxlume
