#include <fmt/format.h>

#include "base/fail.h"
#include "volume_io/tiff_file.h"
#include "volume_io/volume_writers.h"

namespace voxlume {
namespace {

std::uint16_t sample_format(VoxelType type) {
  switch (type) {
    case VoxelType::kI8:
    case VoxelType::kI16:
    case VoxelType::kI32:
      return SAMPLEFORMAT_INT;
    case VoxelType::kF32:
    case VoxelType::kF64:
      return SAMPLEFORMAT_IEEEFP;
    default:
      return SAMPLEFORMAT_UINT;
  }
}

void set_fields(TIFF* tiff, const Volume& volume, const std::string& description) {
  const auto width = static_cast<std::uint32_t>(volume.size[0]);
  const auto height = static_cast<std::uint32_t>(volume.size[1]);
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, width);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, height);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, static_cast<int>(8 * voxel_bytes(volume.type)));
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, 1);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, static_cast<int>(sample_format(volume.type)));
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, PHOTOMETRIC_MINISBLACK);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, height);
  TIFFSetField(tiff, TIFFTAG_RESOLUTIONUNIT, RESUNIT_NONE);
  TIFFSetField(tiff, TIFFTAG_XRESOLUTION, 1 / volume.spacing_mm[0]);
  TIFFSetField(tiff, TIFFTAG_YRESOLUTION, 1 / volume.spacing_mm[1]);
  if (!description.empty()) TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, description.c_str());
}

}  // namespace

void write_tiff(const Volume& volume, const std::filesystem::path& path) {
  constexpr std::uint64_t kClassicLimit = 4'000'000'000;  // offsets are 32 bits
  TIFFSetErrorHandler(nullptr);
  TIFFSetWarningHandler(nullptr);
  const TiffFile tiff(TIFFOpen(path.c_str(), volume.byte_count() < kClassicLimit ? "w" : "w8"));
  if (!tiff) fail(ErrorCode::kInternal, path, "this file cannot be created");
  const std::string description = fmt::format("ImageJ=1.11a\nimages={0}\nslices={0}\nunit=mm\nspacing={1}\n",
                                              volume.size[2], volume.spacing_mm[2]);
  const std::uint64_t page_bytes = volume.byte_count() / static_cast<std::uint64_t>(volume.size[2]);
  const auto* voxels = static_cast<const unsigned char*>(volume.voxels.get());
  for (std::int64_t z = 0; z < volume.size[2]; ++z) {
    set_fields(tiff.get(), volume, z == 0 ? description : "");
    // libtiff does not change the data, its interface only lacks the const.
    void* page = const_cast<unsigned char*>(voxels + static_cast<std::uint64_t>(z) * page_bytes);
    const auto bytes = static_cast<tmsize_t>(page_bytes);
    if (TIFFWriteEncodedStrip(tiff.get(), 0, page, bytes) != bytes || !TIFFWriteDirectory(tiff.get())) {
      fail(ErrorCode::kInternal, path, fmt::format("page {} cannot be written (disk full?)", z));
    }
  }
}

}  // namespace voxlume
