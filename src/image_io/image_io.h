#pragma once
#include <cstdint>
#include <filesystem>
#include <vector>

#include "voxlume/image.h"

namespace voxlume {

/// Writes R, G, B, A, every layer and the metadata as float32 OpenEXR (zip compression). Written aside and
/// renamed. Throws Error: kBadParameter when the picture is empty or a layer's size is wrong, kFileNotFound,
/// kInternal.
void write_exr(const Image& image, const std::filesystem::path& path);

/// Writes an 8-bit sRGB PNG with straight alpha and the metadata as text. Written aside and renamed.
/// Throws as write_exr.
void write_png(const Image8& image, const std::filesystem::path& path);

struct ImageReadOptions {
  /// Refuse pictures whose decoded values need more than this; 0 takes the memory the machine has available.
  std::uint64_t memory_limit_bytes = 0;
};

/// Reads an OpenEXR, Radiance HDR or PNG picture, told apart by its first bytes, as linear premultiplied
/// floats. PNG is decoded from sRGB. Of an EXR the first part's data window is read; channels called R, G, B,
/// A (or Y, for grey) are the colour, the others become layers, "x.y" channel y of layer x, and attributes
/// called "voxlume:..." are the metadata. Values may be negative or not finite.
/// Throws Error: kFileNotFound, kBadFormat, kUnsupported (deep or complex pictures), kOutOfMemory.
Image read_image(const std::filesystem::path& path, const ImageReadOptions& options = {});

/// Reads an environment: as read_image, without alpha and layers.
/// Throws Error as well: kBadFormat when the width is not twice the height, or a texel is negative or not
/// finite.
EnvironmentImage read_environment(const std::filesystem::path& path, const ImageReadOptions& options = {});

}  // namespace voxlume
