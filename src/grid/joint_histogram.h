#pragma once
#include <cstdint>
#include <vector>

#include "voxlume/volume.h"

namespace voxlume {

/// A volume whose values are counted.
struct JointVolume {
  const Volume& volume;
  bool nearest = false;        ///< whole numbers, looked up without interpolation
  float lower = 0, upper = 0;  ///< of its finite values
};

/// How often values of two volumes are found at the same place.
struct JointHistogram {
  /// Bins of equal width from `lower` to `upper`; of labels each has its own where there are not too many.
  struct Axis {
    double lower = 0, upper = 1;
    int bins = 1;
  };
  Axis x, y;
  std::vector<std::uint32_t> counts;  ///< x.bins of the lowest y, then those of the next
};

/// Looks both volumes up at the voxel centres of `over`, at most about `most_samples` of them, evenly spread
/// whatever the numbers are. Places outside either volume, or where a value is not finite, do not count.
JointHistogram joint_histogram(const Volume& over, const JointVolume& x, const JointVolume& y,
                               std::int64_t most_samples = std::int64_t{1} << 21);

}  // namespace voxlume
