#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "voxlume/volume_io.h"

namespace voxlume {

/// Gives zeroed memory for `bytes` of voxels; `working_bytes` is what the reader needs besides.
using AllocateVoxels = std::function<std::shared_ptr<void>(std::uint64_t bytes, std::uint64_t working_bytes)>;

/// Header, checks of geometry and memory, allocation, voxels: in that order, so that nothing is allocated on
/// the word of a header that cannot be. Everything thrown is an Error.
Volume read_staged(const std::filesystem::path& path, const ReadOptions& options,
                   const AllocateVoxels& allocate);

/// "NRRD", "DICOM", ...: what would read `path`, for messages.
std::string reader_name(const std::filesystem::path& path);

}  // namespace voxlume
