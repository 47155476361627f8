#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace voxlume {

/// The type voxels have in the file, and keep in memory.
enum class VoxelType : std::uint8_t { kU8, kI8, kU16, kI16, kU32, kI32, kF32, kF64 };

/// Bytes of one voxel.
constexpr std::size_t voxel_bytes(VoxelType type) {
  switch (type) {
    case VoxelType::kU8:
    case VoxelType::kI8:
      return 1;
    case VoxelType::kU16:
    case VoxelType::kI16:
      return 2;
    case VoxelType::kF64:
      return 8;
    default:
      return 4;
  }
}

/// "u8", "i16", "f32", ...: the names used on the command line, in scenes and in `voxlume info`.
std::string_view voxel_type_name(VoxelType type);
/// The inverse of voxel_type_name. Throws Error kBadParameter for any other text.
VoxelType parse_voxel_type(std::string_view name);

/// A scalar volume as it stands in its file, placed in physical space. Physical space is LPS (x toward the
/// patient's left, y toward posterior, z toward the head), in millimetres, as DICOM and ITK have it.
struct Volume {
  std::array<std::int64_t, 3> size{0, 0, 0};  ///< voxels along index axes i, j, k; i is fastest in memory
  VoxelType type = VoxelType::kU8;
  std::array<double, 3> spacing_mm{1, 1, 1};  ///< > 0, between voxel centres
  std::array<double, 3> origin_mm{0, 0, 0};   ///< LPS position of the centre of voxel (0,0,0)
  /// Row-major 3x3; column a is the LPS direction of index axis a (unit length, orthonormal).
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
  /// size[0]*size[1]*size[2] voxels. Shared and never written after reading.
  std::shared_ptr<const void> voxels;

  std::string modality;  ///< "CT", "MR", ... where the file says so, else empty
  std::string format;    ///< what was read: "NRRD", "DICOM series", ...
  /// What the user should know about how the file was read (gantry tilt, missing slices, a chosen component).
  /// Each one line, without patient data.
  std::vector<std::string> warnings;

  std::size_t voxel_count() const { return static_cast<std::size_t>(size[0]) * size[1] * size[2]; }
  std::size_t byte_count() const { return voxel_count() * voxel_bytes(type); }
};

}  // namespace voxlume
