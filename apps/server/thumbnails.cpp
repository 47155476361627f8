#include "server/thumbnails.h"

#include <boost/asio/post.hpp>

#include "scene/presets.h"
#include "server/picture_bytes.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

constexpr int kSide_px = 128;
constexpr int kSpp = 32;

SceneDescription small_scene(SceneDescription scene, const std::string& preset) {
  scene.transfer.preset = preset;
  scene.transfer.points.clear();
  scene.animation.reset();
  scene.image.width = scene.image.height = kSide_px;
  scene.image.aovs.clear();
  scene.render.denoise = "none";
  return scene;
}

std::shared_ptr<const std::string> coded(const Image8& picture) {
  if (picture.width == 0) return nullptr;
  try {
    return std::make_shared<const std::string>(png_bytes(picture));
  } catch (const std::exception&) {
    return nullptr;  // it is drawn again when asked for again
  }
}

}  // namespace

std::vector<std::string> Thumbnails::draw_all(OpenedVolume& volume, const SceneDescription& scene) {
  std::vector<std::string> there;
  for (const Preset& preset : presets()) {
    const std::string name(preset.name);
    if (const auto found = drawn_->pictures.find(name); found != drawn_->pictures.end()) {
      if (found->second) there.push_back(name);
      continue;
    }
    SceneDescription small;
    try {
      small = volume.session->resolved(small_scene(scene, name));
    } catch (const Error&) {
      continue;  // a density, say, that this preset cannot be drawn with
    }
    drawn_->pictures[name] = nullptr;
    volume.session->draw_aside(small, kSpp, [this, &io = io_, drawn = drawn_, name](const Image8& picture) {
      // Called by the session's thread, which may end later than this object.
      boost::asio::post(io, [this, drawn, name, png = coded(picture)] {
        png ? void(drawn->pictures[name] = png) : void(drawn->pictures.erase(name));
        if (png && drawn == drawn_) told_(name);
      });
    });
  }
  return there;
}

std::shared_ptr<const std::string> Thumbnails::find(const std::string& name) const {
  const auto found = drawn_->pictures.find(name);
  return found == drawn_->pictures.end() ? nullptr : found->second;
}

void Thumbnails::forget() { drawn_ = std::make_shared<Drawn>(); }

}  // namespace voxlume::server
