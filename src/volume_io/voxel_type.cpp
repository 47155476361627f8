#include <fmt/format.h>

#include "voxlume/error.h"
#include "voxlume/volume.h"

namespace voxlume {
namespace {

constexpr std::string_view kNames[] = {"u8", "i8", "u16", "i16", "u32", "i32", "f32", "f64"};

}  // namespace

std::string_view voxel_type_name(VoxelType type) { return kNames[static_cast<std::size_t>(type)]; }

VoxelType parse_voxel_type(std::string_view name) {
  for (std::size_t i = 0; i < std::size(kNames); ++i) {
    if (kNames[i] == name) return static_cast<VoxelType>(i);
  }
  throw Error(
      ErrorCode::kBadParameter, "",
      fmt::format("voxel type \"{}\"; expected u8, i8, u16, i16, u32, i32, f32 or f64", name.substr(0, 40)));
}

}  // namespace voxlume
