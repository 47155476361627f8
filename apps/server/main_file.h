#pragma once
#include <filesystem>

namespace voxlume::server {

/// What a file or the files of a folder are together: the file; the scene or the volume among them (a header,
/// where its voxels are in another file), or the folder itself where they are the slices of a volume (DICOM,
/// TIFF). Throws Error: kUnsupported where they are several things, kFileNotFound where a header's voxels are
/// missing.
std::filesystem::path main_file(const std::filesystem::path& path);

}  // namespace voxlume::server
