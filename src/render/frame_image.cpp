#include "render/frame_image.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "render/camera_text.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr const char* kSizeText = "voxlume:size_mm";
constexpr const char* kCameraText = "voxlume:camera";
constexpr const char* kMatter = "matter";
/// Larger values count as not finite, so that sums of squares of values are finite; the variance is a square.
constexpr float kLargest = 1e16f, kLargestVariance = kLargest * kLargest;
/// Of fx, in units of a white Lambert surface, and of samples: a pixel's fx meets the fl of others, times
/// their samples.
constexpr float kLargestShading = 1e9f, kMostSamples = 4294967296.0f;
/// Of what is seen.
constexpr float kMaxSize_mm = 1e9f;

/// A layer and the planes of a frame that its channels are. `PlaneType` is Plane or const Plane.
template <class PlaneType>
struct LayerPlanes {
  std::string name;
  std::vector<std::pair<const char*, PlaneType*>> channels;
};

template <class Frame>
using PlaneOf = std::conditional_t<std::is_const_v<Frame>, const Plane, Plane>;

template <class Planes>
auto three(const std::string& name, Planes& planes, const char* a, const char* b, const char* c) {
  return LayerPlanes<PlaneOf<Planes>>{name, {{a, &planes[0]}, {b, &planes[1]}, {c, &planes[2]}}};
}

/// The layers that methods with these needs read, as in the table of voxlume/image.h.
template <class Frame>
std::vector<LayerPlanes<PlaneOf<Frame>>> layer_planes(Frame& frame, const DenoiserNeeds& needs) {
  std::vector<LayerPlanes<PlaneOf<Frame>>> out;
  out.push_back(three(kMatter, frame.radiance, "R", "G", "B"));
  out.back().channels.emplace_back("A", &frame.alpha);
  out.push_back(three("background", frame.background, "R", "G", "B"));
  out.push_back({"matter_depth", {{"Z", &frame.depth_mm}}});
  out.push_back({"matter_variance", {{"Y", &frame.variance}}});
  out.push_back({"samples", {{"Y", &frame.samples}}});
  if (needs.normal) out.push_back(three("normal", frame.normal, "X", "Y", "Z"));
  if (needs.albedo) out.push_back(three("albedo", frame.albedo, "R", "G", "B"));
  for (int k = 0; needs.classes && frame.classes && k < 2; ++k) {
    auto& one = (*frame.classes)[k];
    const std::string name = fmt::format("class{}.", k);
    out.push_back({name + "count", {{"Y", &one.count}}});
    out.push_back(three(name + "fx_diffuse", one.fx_diffuse, "R", "G", "B"));
    out.push_back(three(name + "fx_specular", one.fx_specular, "R", "G", "B"));
    out.push_back(three(name + "fl_diffuse", one.fl_diffuse, "R", "G", "B"));
    out.push_back(three(name + "fl_specular", one.fl_specular, "R", "G", "B"));
    out.push_back(three(name + "later", one.later, "R", "G", "B"));
  }
  return out;
}

Vec3f at(const Planes3& planes, int x, int y) {
  return {planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y)};
}

/// One picture that is read.
class FrameReader {
 public:
  FrameReader(const Image& image, const DenoiserNeeds& needs, const std::string& where)
      : image_(image), needs_(needs), where_(where), frame_(make_denoise_frame(image.width, image.height)) {}

  DenoiseFrame read() {
    read_camera();
    own_ = image_.metadata.contains(kCameraText) || image_.layer(kMatter) != nullptr;
    if (own_) {
      if (needs_.classes) add_classes(frame_);
      for (const auto& layer : layer_planes(frame_, needs_)) {
        for (const auto& [channel, plane] : layer.channels) read_channel(layer.name, channel, *plane);
      }
    } else {
      read_colors();
      read_guides();
    }
    parallel_for(frame_.height, 8, [&](std::int64_t y) { check_row(static_cast<int>(y)); });
    if (!image_.metadata.contains(kCameraText)) frame_.size_mm = median_depth_mm();
    return std::move(frame_);
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::kBadFormat, where_, message);
  }

  void read_camera() {
    const auto camera = image_.metadata.find(kCameraText);
    if (camera == image_.metadata.end()) {
      CameraDescription still;
      frame_.camera = compile_camera(still, Vec3f(0), 1, image_.width, image_.height);
      return;
    }
    frame_.camera = parse_camera(camera->second, where_);
    const auto width = static_cast<double>(frame_.camera.width_px), height = double{frame_.camera.height_px};
    if (width != image_.width || height != image_.height)
      fail(fmt::format("the camera (\"{}\") is of a picture of {:g} x {:g} pixels; found {} x {}",
                       kCameraText, width, height, image_.width, image_.height));
    const auto size = image_.metadata.find(kSizeText);
    if (size == image_.metadata.end())
      fail(fmt::format("the size \"{}\" is missing; render the picture with --aov {}", kSizeText,
                       kDenoiseAov));
    const nlohmann::json number = nlohmann::json::parse(size->second, nullptr, false);
    frame_.size_mm = number.is_number() ? static_cast<float>(number.get<double>()) : 0.0f;
    if (!(frame_.size_mm > 0 && frame_.size_mm <= kMaxSize_mm))
      fail(fmt::format("the size \"{}\" is no number in (0, 1e9]", kSizeText));
  }

  /// -1 without that channel.
  std::ptrdiff_t channel_index(const ImageLayer& layer, const std::string& channel) const {
    const auto at = std::find(layer.channels.begin(), layer.channels.end(), channel);
    if (at == layer.channels.end()) return -1;
    if (layer.values.size() != image_.pixel_count() * layer.channels.size())
      fail("layer \"" + layer.name + "\" is not of the picture's size");
    return at - layer.channels.begin();
  }

  void copy(const std::vector<float>& values, std::size_t stride, std::size_t first, Plane& plane) const {
    for (int y = 0; y < image_.height; ++y) {
      const float* in = values.data() + static_cast<std::size_t>(y) * image_.width * stride + first;
      for (int x = 0; x < image_.width; ++x) plane.at(x, y) = in[static_cast<std::size_t>(x) * stride];
    }
  }

  bool try_channel(const std::string& name, const std::string& channel, Plane& plane) const {
    const ImageLayer* const layer = image_.layer(name);
    const std::ptrdiff_t index = layer ? channel_index(*layer, channel) : -1;
    if (index < 0) return false;
    copy(layer->values, layer->channels.size(), static_cast<std::size_t>(index), plane);
    return true;
  }

  void read_channel(const std::string& name, const char* channel, Plane& plane) const {
    if (try_channel(name, channel, plane)) return;
    const bool layer = image_.layer(name) != nullptr;
    fail(fmt::format(
        "{} \"{}\" is missing; {}", layer ? "channel" : "layer", layer ? name + "." + channel : name,
        own_ ? fmt::format("render the picture with --aov {}", kDenoiseAov) : "this method needs it"));
  }

  void read_colors() {
    for (std::size_t c = 0; c < 3; ++c) copy(image_.rgba, 4, c, frame_.radiance[c]);
    copy(image_.rgba, 4, 3, frame_.alpha);
  }

  /// What another program's picture has besides its colours.
  void read_guides() {
    if (!try_channel("depth", "Z", frame_.depth_mm) && !try_channel("", "Z", frame_.depth_mm))
      frame_.depth_mm.fill(1);
    if (!try_channel("samples", "Y", frame_.samples)) frame_.samples.fill(1);
    try_channel("variance", "Y", frame_.variance);
    const auto read_three = [&](const char* name, const char* channels, Planes3& planes) {
      for (std::size_t c = 0; c < 3; ++c) read_channel(name, std::string(1, channels[c]).c_str(), planes[c]);
    };
    if (needs_.normal) read_three("normal", "XYZ", frame_.normal);
    if (needs_.albedo) read_three("albedo", "RGB", frame_.albedo);
    if (needs_.classes)
      fail(fmt::format("layer \"class0.count\" is missing; render the picture with --aov {}", kDenoiseAov));
  }

  bool classes_make_sense(int x, int y) const {
    if (!frame_.classes) return true;
    float samples = 0;
    for (const SampleClass& one : *frame_.classes) {
      const float count = one.count.at(x, y);
      samples += count;
      if (!(count >= 0)) return false;
      for (const auto& [fx, fl] :
           {std::pair(&one.fx_diffuse, &one.fl_diffuse), std::pair(&one.fx_specular, &one.fl_specular)}) {
        const Vec3f shading = at(*fx, x, y), light = at(*fl, x, y);
        if (!(min_component(shading) >= 0 && min_component(light) >= 0)) return false;
        if (!(max_component(shading) <= kLargestShading)) return false;
        if (!(max_component(shading) * max_component(light) <= kLargest)) return false;
      }
    }
    return samples <= frame_.samples.at(x, y);
  }

  void check_row(int y) {
    const auto layers = layer_planes(frame_, needs_);
    for (int x = 0; x < frame_.width; ++x) {
      bool bad = frame_.alpha.at(x, y) < 0 || frame_.depth_mm.at(x, y) < 0 || frame_.variance.at(x, y) < 0 ||
                 frame_.samples.at(x, y) < 0 || frame_.samples.at(x, y) > kMostSamples;
      for (const auto& layer : layers) {
        for (const auto& [channel, plane] : layer.channels) {
          const float largest = plane == &frame_.variance ? kLargestVariance : kLargest;
          bad |= !(std::abs(plane->at(x, y)) <= largest);
        }
      }
      bad |= !classes_make_sense(x, y);
      if (bad) {
        make_empty(x, y, layers);
        continue;
      }
      frame_.alpha.at(x, y) = std::min(frame_.alpha.at(x, y), 1.0f);
      const auto make_light = [&](Planes3& planes) {
        for (Plane& plane : planes) plane.at(x, y) = std::max(plane.at(x, y), 0.0f);
      };
      make_light(frame_.radiance);
      make_light(frame_.background);
      for (int k = 0; frame_.classes && k < 2; ++k) make_light((*frame_.classes)[k].later);
    }
  }

  /// Leaves what is behind: of another program's picture that is the pixel itself.
  void make_empty(int x, int y, const std::vector<LayerPlanes<Plane>>& layers) {
    Vec3f behind;
    for (int c = 0; c < 3; ++c) {
      const float value = (own_ ? frame_.background : frame_.radiance)[c].at(x, y);
      behind[c] = value > 0 && value <= kLargest ? value : 0.0f;
    }
    for (const auto& layer : layers) {
      for (const auto& [channel, plane] : layer.channels) plane->at(x, y) = 0;
    }
    for (int c = 0; c < 3; ++c) frame_.background[c].at(x, y) = behind[c];
  }

  /// Stands for the size of what is seen where nobody says it; 1 without any depth.
  float median_depth_mm() const {
    std::vector<float> depths;
    for (int y = 0; y < frame_.height; ++y) {
      for (int x = 0; x < frame_.width; ++x) {
        if (frame_.depth_mm.at(x, y) > 0) depths.push_back(frame_.depth_mm.at(x, y));
      }
    }
    if (depths.empty()) return 1;
    const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
    std::nth_element(depths.begin(), middle, depths.end());
    return *middle;
  }

  const Image& image_;
  const DenoiserNeeds& needs_;
  const std::string& where_;
  DenoiseFrame frame_;
  bool own_ = false;
};

}  // namespace

void add_denoise_layers(const DenoiseFrame& frame, Image& image) {
  const DenoiserNeeds all{.normal = true, .albedo = true, .classes = true};
  for (const auto& planes : layer_planes(frame, all)) {
    if (image.layer(planes.name) != nullptr) continue;
    ImageLayer& layer = image.layers.emplace_back();
    layer.name = planes.name;
    for (const auto& channel : planes.channels) layer.channels.emplace_back(channel.first);
    layer.values.reserve(image.pixel_count() * planes.channels.size());
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        for (const auto& channel : planes.channels) layer.values.push_back(channel.second->at(x, y));
      }
    }
  }
  image.metadata[kSizeText] = nlohmann::json(double{frame.size_mm}).dump();
}

DenoiseFrame frame_from_image(const Image& image, const DenoiserNeeds& needs, const std::string& where) {
  if (image.width < 1 || image.height < 1 || image.rgba.size() != image.pixel_count() * 4)
    throw Error(ErrorCode::kBadFormat, where, "is empty; expected a picture");
  return FrameReader(image, needs, where).read();
}

}  // namespace voxlume
