#include "server/passing.h"

#include <utility>

#include "scene/animation.h"
#include "voxlume/error.h"

namespace voxlume::server {

bool Passing::seek(const Viewer& page, std::optional<double> time_s) {
  seeking_ = time_s ? &page : nullptr;
  return std::exchange(time_s_, time_s) != time_s;
}

bool Passing::set(const Viewer& page, std::vector<FieldEdit> fields) {
  if (fields.empty() && setting_ != &page) return false;
  setting_ = fields.empty() ? nullptr : &page;
  if (fields == fields_) return false;
  fields_ = std::move(fields);
  return true;
}

bool Passing::leave(const Viewer& page) {
  const bool sought = seeking_ == &page && seek(page, std::nullopt);
  const bool set_fields = setting_ == &page && set(page, {});
  return sought || set_fields;
}

SceneDescription Passing::over(const Document& document) {
  SceneDescription scene = document.scene();
  try {
    if (!fields_.empty()) scene = document.with(fields_);
  } catch (const Error&) {
    fields_.clear();
    setting_ = nullptr;
  }
  return time_s_ && scene.animation ? document.resolved(scene_at(scene, *time_s_)) : scene;
}

}  // namespace voxlume::server
