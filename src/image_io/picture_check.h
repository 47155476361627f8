#pragma once
#include <cstdint>
#include <filesystem>

#include "image_io/image_io.h"

namespace voxlume {

// What is looked at before a file is handed to the library that decodes it.

enum class PictureFormat { kExr, kHdr, kPng };

/// Told by the file's first bytes. Throws Error kFileNotFound, kBadFormat.
PictureFormat picture_format(const std::filesystem::path& path);

/// Throws Error kBadFormat unless a picture of this size can be in the file, kOutOfMemory unless it can be in
/// memory.
void check_picture_size(const std::filesystem::path& path, std::int64_t width, std::int64_t height,
                        std::int64_t channels, const ImageReadOptions& options);

/// Throws Error kBadFormat when an attribute in the header of an OpenEXR file claims more bytes than the file
/// has; OpenEXR would take up to 2 GiB for it.
void check_exr_header(const std::filesystem::path& path);

}  // namespace voxlume
