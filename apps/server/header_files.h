#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace voxlume::server {

/// What a volume's text header (NRRD, MetaImage) names as files of its voxels, as written there; empty
/// where they are in the file itself, or it has no such header.
std::vector<std::string> files_named_in_header(const std::filesystem::path& path);

}  // namespace voxlume::server
