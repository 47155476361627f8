#pragma once
#include <cstdint>
#include <filesystem>

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

/// Calls `use` with a value of the C++ type of `type`: use(std::uint8_t{}), use(float{}), ...
template <typename Use>
auto with_voxel_type(VoxelType type, Use&& use) {
  switch (type) {
    case VoxelType::kU8:
      return use(std::uint8_t{});
    case VoxelType::kI8:
      return use(std::int8_t{});
    case VoxelType::kU16:
      return use(std::uint16_t{});
    case VoxelType::kI16:
      return use(std::int16_t{});
    case VoxelType::kU32:
      return use(std::uint32_t{});
    case VoxelType::kI32:
      return use(std::int32_t{});
    case VoxelType::kF32:
      return use(float{});
    default:
      return use(double{});
  }
}

}  // namespace voxlume
