#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "render/frame_files.h"

namespace voxlume::cli {

enum class PictureFormat { kPng, kExr };

/// The format of a picture by its extension, in any case. Throws Error kUnsupported, naming `flag`, for
/// another one.
PictureFormat picture_format(const std::filesystem::path& path, const std::string& flag);

/// Throws Error kBadParameter, naming `flag`, unless a file could be written at `path`: its folder exists and
/// is writable, and it is no folder itself.
void check_writable(const std::filesystem::path& path, const std::string& flag);

/// Throws Error kBadParameter, naming `flag`, when `output` is the same file as one of `inputs` (by whatever
/// name).
void check_not_input(const std::filesystem::path& output, const std::vector<std::string>& inputs,
                     const std::string& flag);

/// The frames that --frames means: "A:B" with either side optional, or "A"; empty means all. Throws Error
/// kBadParameter, naming the flag, unless they are within `all`.
FrameRange frame_range(const std::string& text, const FrameRange& all);

}  // namespace voxlume::cli
