#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "volume_io/file_map.h"
#include "voxlume/volume_io.h"

namespace voxlume {

/// Gives zeroed memory for `bytes` of voxels; `working_bytes` is what the reader needs besides.
using AllocateVoxels = std::function<std::shared_ptr<void>(std::uint64_t bytes, std::uint64_t working_bytes)>;

/// A volume, either with its voxels or with the place in a file from where they are to be mapped.
struct StagedVolume {
  Volume volume;  ///< voxels is null when they are in a file
  std::optional<VoxelsInFile> in_file;
};

/// Header, checks of geometry and memory, allocation, voxels: in that order, so that nothing is allocated on
/// the word of a header that cannot be. Voxels that the file has as they are needed are left there.
/// Everything thrown is an Error.
StagedVolume read_staged(const std::filesystem::path& path, const ReadOptions& options,
                         const AllocateVoxels& allocate);

/// "NRRD", "DICOM", ...: what would read `path`, for messages.
std::string reader_name(const std::filesystem::path& path);

}  // namespace voxlume
