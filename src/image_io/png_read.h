#pragma once
#include <filesystem>

#include "image_io/image_io.h"

namespace voxlume {

/// Reads a PNG picture of 1 to 16 bits as linear premultiplied floats. Values are taken as sRGB whatever the
/// file says. Uses libpng itself: OpenImageIO's reader lets libpng write to standard error.
/// Throws Error: kFileNotFound, kBadFormat, kOutOfMemory.
Image read_png(const std::filesystem::path& path, const ImageReadOptions& options);

}  // namespace voxlume
