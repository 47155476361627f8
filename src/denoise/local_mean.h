#pragma once
#include "denoise/plane.h"

namespace voxlume {

/// Means over (2 kRadius + 1)^2 pixels, or as many of them as are inside the picture.
class LocalMean {
 public:
  static constexpr int kRadius = 3;
  /// `out` has the size of `in` and may be `in` itself.
  void operator()(const Plane& in, Plane& out);

 private:
  Plane row_sums_;
};

}  // namespace voxlume
