#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>

#include "voxlume/volume.h"

namespace voxlume {

/// Throws Error kOutOfMemory when `bytes` exceeds `limit_bytes`, or what the machine has available when the
/// limit is 0. The message names size, type and both numbers.
void check_memory(const std::filesystem::path& path, const Volume& volume, std::uint64_t bytes,
                  std::uint64_t limit_bytes);

/// Zeroed page-aligned memory. Throws Error kOutOfMemory.
std::shared_ptr<void> allocate_voxels(const std::filesystem::path& path, std::uint64_t bytes);

}  // namespace voxlume
