#pragma once
#include "denoise/denoiser.h"

namespace voxlume {

/// Intel Open Image Denoise (afra2024), a trained network, where the library is installed. It gets the
/// radiance of matter without background, and albedo and normal of the first scattering, times alpha and each
/// denoised first. Looks at one frame at a time. Throws Error kUnsupported where the library is not found.
std::unique_ptr<Denoiser> make_oidn();

}  // namespace voxlume
