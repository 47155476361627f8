#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <array>
#include <string>
#include <string_view>

#include "base/fail.h"
#include "image_io/image_io.h"
#include "image_io/picture_check.h"
#include "image_io/png_read.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMetadataPrefix = "voxlume:";

struct Pixels {
  OIIO::ImageSpec spec;
  std::vector<float> values;  // nchannels a pixel
};

Pixels read_pixels(const fs::path& path, PictureFormat format, const ImageReadOptions& options) {
  if (format == PictureFormat::kExr) check_exr_header(path);
  const auto input = OIIO::ImageInput::create(format == PictureFormat::kExr ? "openexr" : "hdr");
  if (!input) fail(ErrorCode::kUnsupported, path, "this build cannot read the format: " + OIIO::geterror());
  Pixels pixels;
  if (!input->open(path.string(), pixels.spec)) {
    fail(ErrorCode::kBadFormat, path, "cannot be read: " + input->geterror());
  }
  const OIIO::ImageSpec& spec = pixels.spec;
  if (spec.deep) fail(ErrorCode::kUnsupported, path, "is a deep picture; expected a flat one");
  if (spec.depth > 1) fail(ErrorCode::kUnsupported, path, "is a volume; expected a picture");
  check_picture_size(path, spec.width, spec.height, spec.nchannels, options);
  pixels.values.resize(static_cast<std::size_t>(spec.width) * spec.height * spec.nchannels);
  if (!input->read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, pixels.values.data())) {
    fail(ErrorCode::kBadFormat, path, "cannot be read: " + input->geterror());
  }
  return pixels;
}

// Which channel of the file is each of R, G, B and A; -1 where there is none.
std::array<int, 4> color_channels(const OIIO::ImageSpec& spec, const fs::path& path) {
  const auto find = [&](const char* name) {
    const auto at = std::find(spec.channelnames.begin(), spec.channelnames.end(), name);
    return at == spec.channelnames.end() ? -1 : static_cast<int>(at - spec.channelnames.begin());
  };
  std::array<int, 4> found{find("R"), find("G"), find("B"), find("A")};
  if (found[0] < 0 && found[1] < 0 && found[2] < 0) found[0] = found[1] = found[2] = find("Y");
  if (found[0] < 0 || found[1] < 0 || found[2] < 0) {
    fail(ErrorCode::kUnsupported, path, "has no channels R, G, B or Y");
  }
  return found;
}

void copy_colors(const Pixels& pixels, const std::array<int, 4>& channels, Image& image) {
  const std::size_t stride = static_cast<std::size_t>(pixels.spec.nchannels);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    const float* in = &pixels.values[i * stride];
    for (std::size_t c = 0; c < 4; ++c) image.rgba[4 * i + c] = channels[c] < 0 ? 1.0f : in[channels[c]];
  }
}

// The channels that are not colour, sorted into layers by the part of their names before the last dot.
void copy_layers(const Pixels& pixels, const std::array<int, 4>& colors, Image& image) {
  std::vector<std::vector<int>> sources;
  for (int c = 0; c < pixels.spec.nchannels; ++c) {
    if (std::find(colors.begin(), colors.end(), c) != colors.end()) continue;
    const std::string& name = pixels.spec.channelnames[static_cast<std::size_t>(c)];
    const std::size_t dot = name.rfind('.');
    const std::string layer = dot == std::string::npos ? "" : name.substr(0, dot);
    const auto same = [&](const ImageLayer& l) { return l.name == layer; };
    const auto at = std::find_if(image.layers.begin(), image.layers.end(), same) - image.layers.begin();
    if (at == static_cast<std::ptrdiff_t>(image.layers.size())) {
      image.layers.push_back({layer, {}, {}});
      sources.emplace_back();
    }
    const std::string channel = dot == std::string::npos ? name : name.substr(dot + 1);
    image.layers[static_cast<std::size_t>(at)].channels.push_back(channel);
    sources[static_cast<std::size_t>(at)].push_back(c);
  }
  const std::size_t stride = static_cast<std::size_t>(pixels.spec.nchannels);
  for (std::size_t l = 0; l < image.layers.size(); ++l) {
    image.layers[l].values.reserve(image.pixel_count() * sources[l].size());
    for (std::size_t i = 0; i < image.pixel_count(); ++i) {
      for (const int c : sources[l]) image.layers[l].values.push_back(pixels.values[i * stride + c]);
    }
  }
}

Image read_known(const fs::path& path, const ImageReadOptions& options) {
  const PictureFormat format = picture_format(path);
  if (format == PictureFormat::kPng) return read_png(path, options);
  const Pixels pixels = read_pixels(path, format, options);
  const std::array<int, 4> colors = color_channels(pixels.spec, path);
  Image image(pixels.spec.width, pixels.spec.height);
  copy_colors(pixels, colors, image);
  copy_layers(pixels, colors, image);
  for (const OIIO::ParamValue& attribute : pixels.spec.extra_attribs) {
    // Only voxlume's own: other programs' text may identify a patient.
    const std::string name = attribute.name().string();
    if (name.starts_with(kMetadataPrefix)) image.metadata[name] = attribute.get_string();
  }
  return image;
}

}  // namespace

Image read_image(const fs::path& path, const ImageReadOptions& options) {
  try {
    return read_known(path, options);
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    fail(ErrorCode::kOutOfMemory, path, "does not fit in memory");
  } catch (const std::exception& error) {
    fail(ErrorCode::kBadFormat, path, std::string("cannot be read: ") + error.what());
  }
}

}  // namespace voxlume
