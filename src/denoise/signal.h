#pragma once
#include "denoise/frame.h"

namespace voxlume {

/// What filters of matter's colour carry from one to the next. They keep colours premultiplied, and use the
/// quotient: sum w radiance / sum w alpha is a mean of colours in which a pixel weighs as much as it has
/// matter, and empty ones nothing.
struct Signal {
  Planes3 radiance;  ///< premultiplied by alpha
  Plane alpha;
  Plane luminance;  ///< of radiance / alpha; 0 without matter
  Plane variance;   ///< of `luminance`

  void resize(int width, int height);
};

/// frame.radiance and frame.alpha with their luminance; variance is left as it is.
void load_signal(const DenoiseFrame& frame, Signal& out);

/// Takes noise out of alpha: the mean over 5 x 5 pixels, each weighted by how well chance alone explains that
/// it differs, exp(-(a - a')^2 / (4 m (1 - m) / n)). m is the mean of alpha there and n the pixel's count:
/// how many samples alpha is the mean of. `counts` is zero in the border and where alpha is not known.
void filter_alpha(const Plane& alpha, const Plane& counts, Plane& out);

/// The denoised frame of a filtered signal: its colours, as much of them as out.alpha has.
void compose(const Signal& colors, DenoisedFrame& out);

}  // namespace voxlume
