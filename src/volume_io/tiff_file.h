#pragma once
#include <tiffio.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "voxlume/volume.h"

namespace voxlume {

struct TiffClose {
  void operator()(TIFF* tiff) const { TIFFClose(tiff); }
};
using TiffFile = std::unique_ptr<TIFF, TiffClose>;

/// Opens for reading. libtiff's messages are kept for tiff_message() instead of being printed.
/// Throws Error kBadFormat with libtiff's reason.
TiffFile open_tiff(const std::filesystem::path& path);

/// The last thing libtiff said in this thread, as " (...)"; empty when it said nothing.
std::string tiff_message();

struct TiffPage {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  VoxelType type = VoxelType::kU8;
  bool operator==(const TiffPage&) const = default;
  std::uint64_t bytes() const { return std::uint64_t{width} * height * voxel_bytes(type); }
};

/// Size and type of the current page. Throws Error kUnsupported for more than one channel or a type voxlume
/// lacks.
TiffPage tiff_page(TIFF* tiff, const std::filesystem::path& path);

/// Reads the current page into `voxels` (page.bytes()). Throws Error kBadFormat when data are missing or
/// damaged.
void read_tiff_page(TIFF* tiff, const std::filesystem::path& path, const TiffPage& page, void* voxels);

/// What the descriptions of ImageJ and OME say about the stack, else the resolution tags.
struct TiffStackInfo {
  std::array<double, 3> spacing_mm{1, 1, 1};
  std::int64_t slices = 0;  ///< of an ImageJ stack; 0 when not said
  std::int64_t channels = 1;
  std::int64_t frames = 1;  ///< time steps
  std::string warning;      ///< what was assumed about the spacing; may be empty
};
TiffStackInfo tiff_stack_info(TIFF* tiff);

}  // namespace voxlume
