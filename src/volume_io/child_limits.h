#pragma once
#include <cstdint>
#include <filesystem>

namespace voxlume {

/// Exit codes of the reading child; anything but 0 means that it sent no result.
inline constexpr int kChildFailed = 97;
inline constexpr int kChildOutOfMemory = 98;
inline constexpr int kChildSanitizerReport = 1;  ///< in builds with address or thread sanitizer

/// True in builds with address or thread sanitizer, where a crash of the child is a defect to be found.
bool has_sanitizer();

/// Called first in the child: silences the libraries, ends with the parent, takes back the parent's signal
/// handlers, and limits processor time and memory to what a header may need.
void enter_child_limits(const std::filesystem::path& path);

/// Raises the memory limit by the voxels and what the reader needs besides.
void allow_voxel_memory(std::uint64_t voxel_bytes, std::uint64_t working_bytes);

/// Seconds after which a child that says nothing is taken for hung: generous, growing with the file.
long wall_limit_seconds(const std::filesystem::path& path);

}  // namespace voxlume
