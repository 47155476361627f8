#pragma once
#include <cstdint>

#include "voxlume/volume.h"

namespace voxlume {

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
