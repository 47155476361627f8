#pragma once
#include "denoise/guides.h"

namespace voxlume {

/// How much the light has changed since the frame before, from samples that were shaded again (schied2018
/// sections 4.2 and 4.3).
class TemporalGradient {
 public:
  /// 0 (nothing changed) to 1 (all of it) for each 3 x 3 pixels: |d| / max(now, before), both filtered by
  /// five levels of 3 x 3 taps, 1, 2, .. 16 strata apart, that stop at edges of depth and luminance; of that
  /// the largest of 3 x 3. The frame has gradients.
  const Plane& operator()(const DenoiseFrame& frame, const Guides& guides);

  /// Of the samples and pixels of each stratum.
  struct Strata {
    Plane difference, larger;   ///< now - before and max(now, before); 0 where not valid
    Plane luminance, variance;  ///< of the colours of pixels
  };

 private:
  Plane depth_mm_;
  Plane depth_rate_;  ///< as Guides::depth_rate, for strata side by side
  Plane change_;
  std::array<Strata, 2> strata_;
};

}  // namespace voxlume
