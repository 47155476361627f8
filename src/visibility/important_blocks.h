#pragma once
#include <cstdint>
#include <vector>

#include "visibility/importance.h"

namespace voxlume {

/// Blocks of cells near which something may be important, to be walked along a ray.
class ImportantBlocks {
 public:
  explicit ImportantBlocks(const ImportanceCellsView& cells);

  /// The part of a line, given in index space, from t_near to t_far that has all of it that may be important,
  /// were its points up to half a voxel elsewhere; empty (t_near > t_far) where there is none.
  Interval<float> part_of(Vec3f origin_index, Vec3f direction_index, float t_near, float t_far) const;

 private:
  std::int32_t count_[3];
  std::int32_t side_;               ///< of a block [voxels]
  std::vector<std::uint8_t> near_;  ///< by block, row by row
};

}  // namespace voxlume
