#pragma once
#include <filesystem>
#include <vector>

namespace voxlume::server {

/// Writes files into a .zip as they are, without compression (pictures are compressed), under their own
/// names. Throws Error kInternal.
void write_zip(const std::vector<std::filesystem::path>& files, const std::filesystem::path& zip);

}  // namespace voxlume::server
