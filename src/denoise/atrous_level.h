#pragma once
#include "denoise/guides.h"
#include "denoise/signal.h"

namespace voxlume {

/// What the difference in luminance between two pixels is measured by.
enum class LuminanceStop {
  kVariance,  ///< the standard deviation (schied2017 eq. 5); filters the variance with the signal (its eq. 2)
  kLuminance,  ///< the luminance itself; the variance is neither read nor written
};

/// One level of the edge-avoiding a-trous wavelet transform (dammertz2010 eq. 5-9, schied2017 eq. 1-5): 5 x 5
/// taps of the B3 spline, `step` pixels apart, weighted by the guides and by
/// exp(-|Y - Y'| / (sigma G)), G the 3 x 3 Gaussian mean of what `stop` names, weighted by alpha. `step` <=
/// Plane::kBorder / 2. `out` has the size of `in` and is another.
void filter_level(const Signal& in, const Guides& guides, int step, LuminanceStop stop, float sigma,
                  Signal& out);

}  // namespace voxlume
