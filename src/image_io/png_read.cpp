#include "image_io/png_read.h"

#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstdio>
#include <string>
#include <vector>

#include "base/fail.h"
#include "image_io/picture_check.h"
#include "tonemap/srgb.h"

namespace voxlume {
namespace {

constexpr png_uint_32 kMaxSide = 65536;

// An open PNG file. libpng reports errors by a jump, so that whatever calls it must own nothing.
class PngReader {
 public:
  explicit PngReader(const std::filesystem::path& path) : path_(path), file_(std::fopen(path.c_str(), "rb")) {
    if (file_ == nullptr) fail(ErrorCode::kFileNotFound, path, "cannot be read");
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, on_error, on_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ != nullptr) return;
    close();
    fail(ErrorCode::kOutOfMemory, path, "does not fit in memory");
  }
  ~PngReader() { close(); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  /// Runs `step`, which calls libpng and holds nothing that needs a destructor.
  template <class Step>
  void run(Step step) {
    if (!returns(step)) fail(ErrorCode::kBadFormat, path_, std::string("cannot be read: ") + message_);
  }

  png_structp png() { return png_; }
  png_infop info() { return info_; }
  std::FILE* file() { return file_; }

 private:
  template <class Step>
  bool returns(Step& step) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    step();
    return true;
  }

  [[noreturn]] static void on_error(png_structp png, png_const_charp message) {
    auto* reader = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(reader->message_, sizeof(reader->message_), "%s", message);
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp, png_const_charp) {}

  void close() {
    png_destroy_read_struct(&png_, &info_, nullptr);
    std::fclose(file_);
  }

  std::filesystem::path path_;
  std::FILE* file_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  char message_[200] = "";
};

// Reads the header and asks for RGBA of 8 or 16 bits in the machine's byte order.
void read_header(PngReader& reader) {
  reader.run([&] {
    const png_structp png = reader.png();
    png_init_io(png, reader.file());
    png_set_user_limits(png, kMaxSide, kMaxSide);
    // No memory for text, profiles and the like, whose sizes the file chooses.
    png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, -1);
    png_read_info(png, reader.info());
    png_set_expand(png);
    png_set_gray_to_rgb(png);
    png_set_add_alpha(png, 0xffff, PNG_FILLER_AFTER);
    if constexpr (std::endian::native == std::endian::little) png_set_swap(png);
    png_set_interlace_handling(png);
    png_read_update_info(png, reader.info());
  });
}

// Four values a pixel.
template <class Value>
std::vector<Value> read_values(PngReader& reader, std::size_t width, std::size_t height) {
  std::vector<Value> values(4 * width * height);
  std::vector<png_bytep> rows(height);
  for (std::size_t y = 0; y < height; ++y) rows[y] = reinterpret_cast<png_bytep>(&values[4 * width * y]);
  reader.run([&] { png_read_image(reader.png(), rows.data()); });
  return values;
}

template <class Value>
void copy_linear(const std::vector<Value>& values, float scale, Image& image) {
  for (std::size_t i = 0; i < values.size(); i += 4) {
    const float alpha = static_cast<float>(values[i + 3]) / scale;
    for (std::size_t c = 0; c < 3; ++c) {
      image.rgba[i + c] = linear_from_srgb(static_cast<float>(values[i + c]) / scale) * alpha;
    }
    image.rgba[i + 3] = alpha;
  }
}

}  // namespace

Image read_png(const std::filesystem::path& path, const ImageReadOptions& options) {
  PngReader reader(path);
  read_header(reader);
  const std::size_t width = png_get_image_width(reader.png(), reader.info());
  const std::size_t height = png_get_image_height(reader.png(), reader.info());
  const bool sixteen_bits = png_get_bit_depth(reader.png(), reader.info()) == 16;
  check_picture_size(path, static_cast<std::int64_t>(width), static_cast<std::int64_t>(height), 4, options);
  const std::size_t expected_row = width * 4 * (sixteen_bits ? 2 : 1);
  if (png_get_rowbytes(reader.png(), reader.info()) != expected_row) {
    fail(ErrorCode::kUnsupported, path, "is a PNG picture of an unknown kind");
  }
  Image image(static_cast<int>(width), static_cast<int>(height));
  if (sixteen_bits) {
    copy_linear(read_values<png_uint_16>(reader, width, height), 65535, image);
  } else {
    copy_linear(read_values<png_byte>(reader, width, height), 255, image);
  }
  return image;
}

}  // namespace voxlume
