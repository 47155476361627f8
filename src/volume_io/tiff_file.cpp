#include "volume_io/tiff_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <vector>

#include "base/fail.h"

namespace voxlume {
namespace {

thread_local std::string last_message;

void keep_message(const char*, const char* format, std::va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof(text), format, arguments);
  last_message = text;
}

[[noreturn]] void fail_type(const std::filesystem::path& path, int bits, int sample_format) {
  const char* kind = sample_format == SAMPLEFORMAT_IEEEFP       ? "floating point"
                     : sample_format >= SAMPLEFORMAT_COMPLEXINT ? "complex"
                                                                : "integer";
  fail(ErrorCode::kUnsupported, path,
       fmt::format("{}-bit {} pixels; expected 8, 16 or 32-bit integers or 32 or 64-bit floating point", bits,
                   kind));
}

VoxelType pixel_type(const std::filesystem::path& path, int bits, int sample_format) {
  const bool is_signed = sample_format == SAMPLEFORMAT_INT;
  if (sample_format == SAMPLEFORMAT_IEEEFP) {
    if (bits == 32) return VoxelType::kF32;
    if (bits == 64) return VoxelType::kF64;
  } else if (sample_format == SAMPLEFORMAT_UINT || sample_format == SAMPLEFORMAT_VOID || is_signed) {
    if (bits == 8) return is_signed ? VoxelType::kI8 : VoxelType::kU8;
    if (bits == 16) return is_signed ? VoxelType::kI16 : VoxelType::kU16;
    if (bits == 32) return is_signed ? VoxelType::kI32 : VoxelType::kU32;
  }
  fail_type(path, bits, sample_format);
}

[[noreturn]] void fail_data(const std::filesystem::path& path) {
  fail(ErrorCode::kBadFormat, path, "the pixels cannot be read" + tiff_message());
}

void read_tiles(TIFF* tiff, const std::filesystem::path& path, const TiffPage& page, unsigned char* out) {
  std::uint32_t tile_width = 0;
  std::uint32_t tile_height = 0;
  TIFFGetField(tiff, TIFFTAG_TILEWIDTH, &tile_width);
  TIFFGetField(tiff, TIFFTAG_TILELENGTH, &tile_height);
  const std::size_t pixel = voxel_bytes(page.type);
  const tmsize_t tile_bytes = TIFFTileSize(tiff);
  if (tile_bytes <= 0 ||
      static_cast<std::uint64_t>(tile_bytes) != std::uint64_t{tile_width} * tile_height * pixel) {
    fail_data(path);
  }
  std::vector<unsigned char> tile(static_cast<std::size_t>(tile_bytes));
  for (std::uint64_t y = 0; y < page.height; y += tile_height) {
    for (std::uint64_t x = 0; x < page.width; x += tile_width) {
      const ttile_t index =
          TIFFComputeTile(tiff, static_cast<std::uint32_t>(x), static_cast<std::uint32_t>(y), 0, 0);
      if (TIFFReadEncodedTile(tiff, index, tile.data(), tile_bytes) != tile_bytes) fail_data(path);
      const std::size_t columns = std::min<std::uint64_t>(tile_width, page.width - x);
      const std::size_t rows = std::min<std::uint64_t>(tile_height, page.height - y);
      for (std::size_t r = 0; r < rows; ++r) {
        std::memcpy(out + ((y + r) * page.width + x) * pixel, tile.data() + r * tile_width * pixel,
                    columns * pixel);
      }
    }
  }
}

}  // namespace

TiffFile open_tiff(const std::filesystem::path& path) {
  TIFFSetErrorHandler(keep_message);
  TIFFSetWarningHandler(nullptr);
  last_message.clear();
  // m: no memory mapping, so that a file cut short while it is read gives an error, not a signal.
  TiffFile tiff(TIFFOpen(path.c_str(), "rm"));
  if (!tiff) fail(ErrorCode::kBadFormat, path, "not a readable TIFF file" + tiff_message());
  return tiff;
}

std::string tiff_message() { return last_message.empty() ? "" : " (" + one_line(last_message) + ")"; }

TiffPage tiff_page(TIFF* tiff, const std::filesystem::path& path) {
  TiffPage page;
  std::uint16_t bits = 1;
  std::uint16_t samples = 1;
  std::uint16_t sample_format = SAMPLEFORMAT_UINT;
  TIFFGetField(tiff, TIFFTAG_IMAGEWIDTH, &page.width);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &page.height);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_BITSPERSAMPLE, &bits);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLESPERPIXEL, &samples);
  TIFFGetFieldDefaulted(tiff, TIFFTAG_SAMPLEFORMAT, &sample_format);
  if (page.width == 0 || page.height == 0) {
    fail(ErrorCode::kBadFormat, path, fmt::format("a page of {}x{} pixels", page.width, page.height));
  }
  if (samples != 1) {
    fail(ErrorCode::kUnsupported, path,
         fmt::format("{} channels per pixel ({}); expected one; extract one channel first, with 3D Slicer or "
                     "ImageJ for instance",
                     samples, samples == 3 || samples == 4 ? "RGB" : "vector"));
  }
  page.type = pixel_type(path, bits, sample_format);
  return page;
}

void read_tiff_page(TIFF* tiff, const std::filesystem::path& path, const TiffPage& page, void* voxels) {
  auto* out = static_cast<unsigned char*>(voxels);
  if (TIFFIsTiled(tiff)) return read_tiles(tiff, path, page, out);
  std::uint32_t rows_per_strip = 0;
  TIFFGetFieldDefaulted(tiff, TIFFTAG_ROWSPERSTRIP, &rows_per_strip);
  rows_per_strip = std::clamp(rows_per_strip, 1u, page.height);
  const std::uint64_t row_bytes = std::uint64_t{page.width} * voxel_bytes(page.type);
  if (static_cast<std::uint64_t>(TIFFScanlineSize(tiff)) != row_bytes) fail_data(path);
  for (std::uint64_t row = 0, strip = 0; row < page.height; row += rows_per_strip, ++strip) {
    const auto bytes =
        static_cast<tmsize_t>(row_bytes * std::min<std::uint64_t>(rows_per_strip, page.height - row));
    if (TIFFReadEncodedStrip(tiff, static_cast<std::uint32_t>(strip), out + row * row_bytes, bytes) !=
        bytes) {
      fail_data(path);
    }
  }
}

}  // namespace voxlume
