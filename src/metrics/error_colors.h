#pragma once
#include <array>
#include <cstdint>

#include "metrics/flip.h"
#include "voxlume/image.h"

namespace voxlume {

/// The colour of an error in [0,1] (clamped), sRGB-encoded: from black by way of violet, red and orange to
/// pale yellow. CIE lightness rises in proportion to the error, from 0 to 97, so that the map reads the same
/// in grey.
std::array<std::uint8_t, 3> error_color(float error);

/// A map of errors for display, three channels.
Image8 error_colors(const FlipError& error);

}  // namespace voxlume
