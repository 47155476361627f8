#pragma once
#include <cstdint>
#include <filesystem>

#include "base/voxel_type.h"
#include "volume_io/volume_reader.h"
#include "voxlume/volume.h"

namespace voxlume {

/// out[i] = in[i] * slope + intercept, rounded to nearest and clamped for integer `out_type`. The ranges may
/// overlap when `in` ends where `out` ends (values are read before they are overwritten) or both start
/// together and have the same width.
void rescale_voxels(const void* in, VoxelType in_type, void* out, VoxelType out_type, std::uint64_t count,
                    double slope, double intercept);

/// Turns `count` 64-bit integers into i32 in place, in the first half of `voxels`.
/// Throws Error kUnsupported naming the first value that does not fit.
void narrow_wide_integers(const std::filesystem::path& path, WideInteger from, void* voxels,
                          std::uint64_t count);

}  // namespace voxlume
