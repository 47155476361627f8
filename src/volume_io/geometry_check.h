#pragma once
#include <array>
#include <cstdint>
#include <filesystem>

#include "voxlume/volume.h"

namespace voxlume {

/// Most voxels along one axis: the integers that a float counts one by one, since places in a volume are
/// floats.
inline constexpr std::int64_t kMaxAxisVoxels = std::int64_t{1} << 24;

/// Checks what a header says of size and place: sizes from 1 to kMaxAxisVoxels with at most 2^60 bytes,
/// spacing finite and > 0, origin finite, direction regular. A direction within about one degree of
/// orthonormal is replaced by the nearest orthonormal one (with a warning when it is off by more than
/// rounding). Throws Error kBadFormat naming what was found, kUnsupported for an axis that is too long.
void check_geometry(const std::filesystem::path& path, Volume& volume);

/// Splits the columns of a row-major 3x3 matrix (mm per voxel) into volume.spacing_mm and volume.direction.
void set_axes(Volume& volume, const std::array<double, 9>& mm_per_voxel);

}  // namespace voxlume
