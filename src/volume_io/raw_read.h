#pragma once
#include <filesystem>

#include "base/progress.h"
#include "voxlume/volume_io.h"

namespace voxlume {

/// Reads headerless voxels. Little-endian aligned voxels are mapped from the file, not copied (map_voxels).
/// Throws Error kBadFormat naming both sizes when the file is too
/// short, kBadParameter for a specification that cannot be. `progress` may be empty.
Volume read_raw(const std::filesystem::path& path, const RawSpec& spec, std::uint64_t memory_limit_bytes,
                const Progress& progress = {});

}  // namespace voxlume
