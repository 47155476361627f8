#pragma once
#include "denoise/denoiser.h"

namespace voxlume {

/// A joint bilateral filter (petschnigg2004, eisemann2004): the mean of 7 x 7 pixels' colours, weighted by a
/// Gaussian of their distance and by how alike their guides are. Looks at one frame at a time.
std::unique_ptr<Denoiser> make_bilateral();

}  // namespace voxlume
