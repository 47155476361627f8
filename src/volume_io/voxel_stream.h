#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>

#include "base/progress.h"
#include "volume_io/volume_reader.h"
#include "voxlume/volume.h"

namespace voxlume {

// `progress`, which may be empty, hears of the share of the voxels that is there.

/// Reads `bytes` bytes from `offset_bytes` of the file into `voxels`.
/// Throws Error kBadFormat ("expected N bytes of voxels, file has M") when the file is too short.
void read_plain(const std::filesystem::path& path, std::uint64_t offset_bytes, void* voxels,
                std::uint64_t bytes, const Progress& progress = {});

/// Inflates the zlib or gzip stream (members may be concatenated) that starts at `offset_bytes`, drops its
/// first `skip_bytes` and reads the next `bytes` into `voxels`. The stream's checksum is verified. Throws
/// Error kBadFormat when the stream is damaged or too short.
void read_deflated(const std::filesystem::path& path, std::uint64_t offset_bytes, std::uint64_t skip_bytes,
                   void* voxels, std::uint64_t bytes, const Progress& progress = {});

/// The first `bytes` inflated bytes of a gzip file; the checksum is not verified.
/// Throws Error kBadFormat when the stream is damaged or shorter.
void read_deflated_start(const std::filesystem::path& path, void* start, std::uint64_t bytes);

/// True for a file that begins with gzip's magic number.
bool starts_with_gzip(const std::filesystem::path& path);

/// Reads `count` numbers written as text, separated by blanks, from `offset_bytes` on.
/// Throws Error kBadFormat at text that is not a number, is out of the type's range, or ends early.
void read_text(const std::filesystem::path& path, std::uint64_t offset_bytes, VoxelType type, void* voxels,
               std::uint64_t count, const Progress& progress = {});

/// Reverses the bytes of each of the `count` values of `value_bytes` (1, 2, 4 or 8) bytes.
void swap_bytes(void* voxels, std::uint64_t count, std::size_t value_bytes);

/// Throws Error kBadFormat when `file_bytes` of any compressed data cannot inflate to `voxel_bytes`
/// (deflate reaches 1032:1 at most).
void check_deflated_size(const std::filesystem::path& path, std::uint64_t file_bytes,
                         std::uint64_t voxel_bytes);

}  // namespace voxlume
