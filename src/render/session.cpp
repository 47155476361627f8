#include "render/session.h"

#include "grid/grid_view.h"
#include "render/fingerprint.h"
#include "scene/animation.h"
#include "scene/resolve.h"

namespace voxlume {

Session::Session(const SceneDescription& scene, Volume volume, const Progress& progress)
    : volume_(std::move(volume)),
      statistics_(compute_statistics(make_grid_view(volume_), progress)),
      volume_digest_(volume_digest(volume_, statistics_)),
      description_(resolve(scene, volume_, statistics_)) {}

SceneDescription Session::frame_description(int frame) const {
  return resolved(scene_of_frame(description_, frame));
}

SceneDescription Session::resolved(const SceneDescription& scene) const {
  return resolve(scene, volume_, statistics_);
}

void Session::compile(SceneDescription scene, const ListProgress& progress) {
  scene.animation.reset();
  if (compiled_) {
    compiled_->update(std::move(scene), progress);
  } else {
    compiled_.emplace(std::move(scene), volume_, statistics_, progress);
  }
}

std::string Session::fingerprint(const SceneDescription& scene) const {
  return scene_fingerprint(scene, volume_digest_);
}

std::string Session::digest(const SceneDescription& scene) const {
  return picture_digest(scene, volume_digest_);
}

}  // namespace voxlume
