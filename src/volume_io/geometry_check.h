#pragma once
#include <array>
#include <filesystem>

#include "voxlume/volume.h"

namespace voxlume {

/// Checks what a header says of size and place: sizes >= 1 with a byte count below 2^62, spacing finite and >
/// 0, origin finite, direction regular. A direction within about one degree of orthonormal is replaced by the
/// nearest orthonormal one (with a warning when it is off by more than rounding). Throws Error kBadFormat
/// naming what was found.
void check_geometry(const std::filesystem::path& path, Volume& volume);

/// Splits the columns of a row-major 3x3 matrix (mm per voxel) into volume.spacing_mm and volume.direction.
void set_axes(Volume& volume, const std::array<double, 9>& mm_per_voxel);

}  // namespace voxlume
