#pragma once
#include <filesystem>
#include <string>

namespace voxlume {

/// One text of the metadata that write_exr and write_png put into a picture ("voxlume:digest"), without
/// reading its pixels; empty where the file has none of that name, is damaged or is no EXR or PNG picture.
/// Throws Error kFileNotFound when it cannot be read.
std::string picture_text(const std::filesystem::path& path, const std::string& name);

}  // namespace voxlume
