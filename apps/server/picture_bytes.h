#pragma once
#include <string>

#include "voxlume/image.h"

namespace voxlume::server {

/// A picture as PNG, coded for speed. Throws Error kInternal.
std::string png_bytes(const Image8& picture);

/// A picture of three channels as JPEG. Throws Error kInternal.
std::string jpeg_bytes(const Image8& picture);

}  // namespace voxlume::server
