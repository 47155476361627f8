#pragma once
#include <cstdint>
#include <vector>

#include "base/progress.h"
#include "grid/grid_view.h"

namespace voxlume {

/// What the data looks like; the base of automatic choices and of `voxlume info`.
struct VolumeStatistics {
  float lower = 0, upper = 0;          ///< least and greatest finite value; 0, 0 when there is none
  std::uint64_t nonfinite_voxels = 0;  ///< NaN or infinite
  /// 99.9th percentile of the gradient magnitude [data units per mm] over the voxels where it is not zero, so
  /// that padding changes nothing: what the surface share's gradient is divided by. At least the smallest
  /// positive float, so that it can be divided by; 1 when there is no gradient.
  float gradient_p999 = 1;
  /// Sorted (value, count) histogram: exact for integers of up to 16 bits, else to within 2^-16 of the range.
  std::vector<std::pair<float, std::uint64_t>> histogram;

  /// The smallest value that at least `fraction` in [0,1] of the finite voxels do not exceed.
  float percentile(double fraction) const;
};

/// Exact for any size, on all threads. Comes past every voxel once, types wider than 16 bits twice.
/// `progress` may be empty.
VolumeStatistics compute_statistics(const GridView& grid, const Progress& progress = {});

}  // namespace voxlume
