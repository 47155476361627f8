#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "voxlume/volume.h"

namespace voxlume {

/// A place in a file where voxels stand as memory needs them: uncompressed, in the machine's byte order, one
/// after another.
struct VoxelsInFile {
  std::filesystem::path path;
  std::uint64_t offset_bytes = 0;
};

/// True when voxels at this offset can be used where they are mapped: kernels read typed pointers, so the
/// offset must be a multiple of the voxel's size.
bool is_aligned(std::uint64_t offset_bytes, VoxelType type);

/// Maps the voxels of `volume` (size and type) read-only from the file. Pages are read when they are touched
/// and can be dropped again; the file may be removed or replaced, but must not be changed in place: what is
/// cut off ends the process with SIGBUS when it is touched.
///
/// Throws Error kFileNotFound when the file cannot be opened, kBadFormat when it is no regular file or too
/// short, kOutOfMemory when the address space is.
std::shared_ptr<const void> map_voxels(const VoxelsInFile& place, const Volume& volume);

}  // namespace voxlume
