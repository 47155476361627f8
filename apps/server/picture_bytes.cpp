#include "server/picture_bytes.h"

#include <png.h>
#include <turbojpeg.h>
#include <zlib.h>

#include <csetjmp>
#include <memory>
#include <vector>

#include "voxlume/error.h"

namespace voxlume::server {
namespace {

constexpr int kJpegQuality = 88;  // of 100; coarser blocks show in smooth shading

[[noreturn]] void fail(const std::string& message) {
  throw Error(ErrorCode::kInternal, "", "a picture cannot be coded: " + message);
}

void append(png_structp png, png_bytep bytes, png_size_t count) {
  // libpng is C: an exception must not pass through it.
  try {
    static_cast<std::string*>(png_get_io_ptr(png))->append(reinterpret_cast<const char*>(bytes), count);
  } catch (...) {
    png_error(png, "out of memory");
  }
}

void ignore_warning(png_structp, png_const_charp) {}

/// libpng reports errors by a jump back into this function, which owns nothing.
bool write_png(png_structp png, png_infop info, const Image8& picture, png_bytepp rows, std::string& out) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, &out, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(picture.width), static_cast<png_uint_32>(picture.height),
               8, picture.channels == 4 ? PNG_COLOR_TYPE_RGB_ALPHA : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  // Differences of neighbours and runs of zeros: several times as fast as searching, and not much larger.
  png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_compression_level(png, 1);
  png_set_compression_strategy(png, Z_RLE);
  png_set_rows(png, info, rows);
  png_write_png(png, info, PNG_TRANSFORM_IDENTITY, nullptr);
  return true;
}

}  // namespace

std::string png_bytes(const Image8& picture) {
  std::vector<png_bytep> rows(static_cast<std::size_t>(picture.height));
  const std::size_t row_bytes = static_cast<std::size_t>(picture.width) * picture.channels;
  for (std::size_t y = 0; y < rows.size(); ++y)
    rows[y] = const_cast<png_bytep>(picture.values.data() + y * row_bytes);
  std::string out;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, ignore_warning);
  png_infop info = png == nullptr ? nullptr : png_create_info_struct(png);
  const bool written = info != nullptr && write_png(png, info, picture, rows.data(), out);
  png_destroy_write_struct(&png, &info);
  if (!written) fail("PNG");
  return out;
}

std::string jpeg_bytes(const Image8& picture) {
  const std::unique_ptr<void, int (*)(tjhandle)> coder(tjInitCompress(), tjDestroy);
  if (!coder) fail("JPEG");
  std::string out(tjBufSize(picture.width, picture.height, TJSAMP_420), '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(out.data());
  unsigned long size = out.size();
  if (tjCompress2(coder.get(), picture.values.data(), picture.width, 0, picture.height, TJPF_RGB, &bytes,
                  &size, TJSAMP_420, kJpegQuality, TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0)
    fail(tjGetErrorStr2(coder.get()));
  out.resize(size);
  return out;
}

}  // namespace voxlume::server
