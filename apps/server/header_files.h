#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace voxlume::server {

// Files that are read when another one is opened.

/// What a volume's text header (NRRD, MetaImage) names as files of its voxels, as written there; empty
/// where they are in the file itself, or it has no such header.
std::vector<std::string> files_named_in_header(const std::filesystem::path& path);

/// The symbolic links in a folder that lead to files: its slices, if it is a series.
std::vector<std::filesystem::path> links_in_folder(const std::filesystem::path& folder);

}  // namespace voxlume::server
