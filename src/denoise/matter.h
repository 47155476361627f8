#pragma once
#include "denoise/frame.h"

namespace voxlume {

/// What scattered, not multiplied by alpha.
struct Matter {
  Planes3 radiance;  ///< mean over the samples that scattered
  Plane samples;     ///< how many those are; 0: `radiance` is not known

  /// Makes the planes anew when they have another size.
  void resize(int width, int height);
};

/// Sets out.radiance to matter times out.alpha. A pixel that has alpha but no matter takes the mean of those
/// around it (5 x 5), by their samples.
void compose(const Matter& matter, DenoisedFrame& out);

}  // namespace voxlume
