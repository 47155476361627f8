#pragma once
#include "base/box.h"

namespace voxlume {

/// A run of a ray through one cell.
struct MajorantSegment {
  float t_near, t_far;  ///< mm
  float mu_maj;         ///< >= mu_t of every point of `cell`
  float mu_min = 0;     ///< <= mu_t of every point of `cell`; 0 where no minima are kept
  Box3f cell;           ///< index space; look-ups clamp to it, so that rounding never leaves the cell's range
};

}  // namespace voxlume
