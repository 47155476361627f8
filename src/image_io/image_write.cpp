#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdio>
#include <string>
#include <string_view>

#include "base/atomic_file.h"
#include "base/fail.h"
#include "image_io/image_io.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

constexpr int kRowsAtOnce = 64;

void set_metadata(OIIO::ImageSpec& spec, const std::map<std::string, std::string>& metadata) {
  for (const auto& [name, value] : metadata) spec.attribute(name, value);
}

// Encodes a picture into `sink`: rows(y_begin, y_end) returns the values of these rows.
template <class Rows>
void write_rows(const char* format, OIIO::ImageSpec spec, OIIO::TypeDesc type, const fs::path& path,
                OIIO::Filesystem::IOProxy* sink, Rows rows) {
  const auto output = OIIO::ImageOutput::create(format);
  if (!output) fail(ErrorCode::kInternal, path, "this build cannot write the format: " + OIIO::geterror());
  const auto check = [&](bool ok) {
    if (!ok) fail(ErrorCode::kInternal, path, "cannot be written: " + output->geterror());
  };
  spec.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, &sink);
  check(output->open(path.filename().string(), spec));
  for (int y = 0; y < spec.height; y += kRowsAtOnce) {
    const int end = std::min(y + kRowsAtOnce, spec.height);
    check(output->write_scanlines(y, end, 0, type, rows(y, end)));
  }
  check(output->close());
}

// A file that says whether all of it was written; OpenImageIO's own does not when the disk is full.
class OutputFile {
 public:
  OutputFile(const fs::path& path, const fs::path& where)
      : file_(std::fopen(path.c_str(), "wb")), where_(where) {
    if (file_ == nullptr) fail_write();
  }
  ~OutputFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  std::FILE* handle() { return file_; }
  void close() {
    const bool failed = std::ferror(file_) != 0;
    const bool close_failed = std::fclose(file_) != 0;
    file_ = nullptr;
    if (failed || close_failed) fail_write();
  }

 private:
  [[noreturn]] void fail_write() const {
    fail(ErrorCode::kInternal, where_, "cannot be written (disk full or no permission?)");
  }

  std::FILE* file_;
  fs::path where_;
};

// Runs `write` with the exceptions of the format libraries made our own.
template <class Write>
void write_picture(const fs::path& path, Write write) {
  try {
    write();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    fail(ErrorCode::kInternal, path, std::string("cannot be written: ") + error.what());
  }
}

void check_size(const fs::path& path, std::size_t found, int width, int height, std::size_t channels,
                const std::string& what) {
  const bool empty = width < 1 || height < 1;
  if (!empty && found == static_cast<std::size_t>(width) * height * channels) return;
  fail(ErrorCode::kBadParameter, path,
       what + " has " + std::to_string(found) + " values; expected " + std::to_string(width) + " x " +
           std::to_string(height) + " x " + std::to_string(channels) + (empty ? ", each at least 1" : ""));
}

std::string channel_name(const ImageLayer& layer, const std::string& channel) {
  return layer.name.empty() ? channel : layer.name + "." + channel;
}

OIIO::ImageSpec exr_spec(const Image& image, const fs::path& path) {
  check_size(path, image.rgba.size(), image.width, image.height, 4, "the picture");
  std::vector<std::string> names{"R", "G", "B", "A"};
  for (const ImageLayer& layer : image.layers) {
    check_size(path, layer.values.size(), image.width, image.height, layer.channels.size(),
               "layer " + layer.name);
    for (const std::string& channel : layer.channels) names.push_back(channel_name(layer, channel));
  }
  OIIO::ImageSpec spec(image.width, image.height, static_cast<int>(names.size()), OIIO::TypeDesc::FLOAT);
  spec.channelnames = names;
  spec.alpha_channel = 3;
  spec.attribute("compression", "zip");
  spec.attribute("oiio:ColorSpace", "Linear");
  spec.attribute("DateTime", "");  // else OpenImageIO adds the time, and equal pictures make different files
  set_metadata(spec, image.metadata);
  return spec;
}

// Appends the values of one pixel in the order of exr_spec's channels.
void append_pixel(const Image& image, std::size_t pixel, std::vector<float>& out) {
  const auto append = [&](const std::vector<float>& values, std::size_t channels) {
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(pixel * channels);
    out.insert(out.end(), first, first + static_cast<std::ptrdiff_t>(channels));
  };
  append(image.rgba, 4);
  for (const ImageLayer& layer : image.layers) append(layer.values, layer.channels.size());
}

}  // namespace

void write_exr(const Image& image, const fs::path& path) {
  const OIIO::ImageSpec spec = exr_spec(image, path);
  write_picture(path, [&] {
    write_file_atomically(path, [&](const fs::path& temporary) {
      OutputFile file(temporary, path);
      {
        OIIO::Filesystem::IOFile sink(file.handle(), OIIO::Filesystem::IOProxy::Write);
        std::vector<float> values;
        write_rows("openexr", spec, OIIO::TypeDesc::FLOAT, path, &sink, [&](int begin, int end) {
          values.clear();
          const std::size_t width = static_cast<std::size_t>(image.width);
          for (std::size_t i = begin * width; i < end * width; ++i) append_pixel(image, i, values);
          return values.data();
        });
      }
      file.close();
    });
  });
}

void write_png(const Image8& image, const fs::path& path) {
  if (image.channels != 3 && image.channels != 4) {
    fail(ErrorCode::kBadParameter, path, std::to_string(image.channels) + " channels; expected 3 or 4");
  }
  check_size(path, image.values.size(), image.width, image.height, static_cast<std::size_t>(image.channels),
             "the picture");
  OIIO::ImageSpec spec(image.width, image.height, image.channels, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  spec.attribute("oiio:UnassociatedAlpha", 1);  // values are straight already
  set_metadata(spec, image.metadata);
  write_picture(path, [&] {
    // Encoded in memory: libpng would tell standard error about a full disk.
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput sink(bytes);
    write_rows("png", spec, OIIO::TypeDesc::UINT8, path, &sink, [&](int begin, int) {
      return &image.values[static_cast<std::size_t>(begin) * image.width * image.channels];
    });
    write_file_atomically(path, std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
  });
}

}  // namespace voxlume
