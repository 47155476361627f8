#pragma once
#include "denoise/denoiser.h"

namespace voxlume {

/// The edge-avoiding a-trous filter (dammertz2010): five levels of 5 x 5 pixels, 1, 2, 4, 8 and 16 apart.
/// What differences in colour are tolerated halves from level to level. Looks at one frame at a time.
std::unique_ptr<Denoiser> make_atrous();

}  // namespace voxlume
