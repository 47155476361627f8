#include "render/camera_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "voxlume/error.h"

namespace voxlume {
namespace {

using nlohmann::json;

/// No camera takes more bytes.
constexpr std::size_t kMaxBytes = 1 << 14;
constexpr float kLargest = 1e9f, kLeast = 1e-9f;

json vector_json(Vec3f v) { return {double{v.x}, double{v.y}, double{v.z}}; }

/// One text that is read.
class CameraReader {
 public:
  CameraReader(std::string_view text, const std::string& where) : where_(where) {
    if (text.size() > kMaxBytes) fail("is longer than any camera");
    camera_ = json::parse(text, nullptr, false);
    if (!camera_.is_object()) fail("is no JSON object");
  }

  Vec3f vector(const char* key) const {
    const json& value = member(key);
    if (!value.is_array() || value.size() != 3) fail(std::string("has no three numbers for ") + key);
    return {number(value[0], key), number(value[1], key), number(value[2], key)};
  }
  /// A number in [kLeast, kLargest].
  float positive(const char* key) const {
    const float value = number(member(key), key);
    if (!(value >= kLeast)) fail(std::string("needs a number > 0 for ") + key);
    return value;
  }
  bool boolean(const char* key) const {
    if (!member(key).is_boolean()) fail(std::string("needs true or false for ") + key);
    return member(key).get<bool>();
  }
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::kBadFormat, where_, "the camera (\"voxlume:camera\") " + message);
  }

 private:
  const json& member(const char* key) const {
    const auto at = camera_.find(key);
    if (at == camera_.end()) fail(std::string("lacks ") + key);
    return *at;
  }
  float number(const json& value, const char* key) const {
    const float out = value.is_number() ? static_cast<float>(value.get<double>()) : std::nanf("");
    if (!(std::abs(out) <= kLargest)) fail(std::string("needs numbers within +-1e9 for ") + key);
    return out;
  }

  std::string where_;
  json camera_;
};

bool are_orthonormal(const CameraView& camera) {
  constexpr float kTolerance = 1e-3f;
  const Vec3f axes[] = {camera.right, camera.up, camera.forward};
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j) {
      if (!(std::abs(dot(axes[i], axes[j]) - (i == j ? 1.0f : 0.0f)) <= kTolerance)) return false;
    }
  }
  return true;
}

}  // namespace

std::string write_camera(const CameraView& camera, const Double3& origin_mm) {
  const auto point = [&](Vec3f p) {
    return json{origin_mm[0] + p.x, origin_mm[1] + p.y, origin_mm[2] + p.z};
  };
  return nlohmann::ordered_json{{"eye_mm", point(camera.eye_mm)},
                                {"target_mm", point(camera.target_mm)},
                                {"right", vector_json(camera.right)},
                                {"up", vector_json(camera.up)},
                                {"forward", vector_json(camera.forward)},
                                {"half_width", double{camera.half_width}},
                                {"half_height", double{camera.half_height}},
                                {"orthographic", camera.orthographic},
                                {"width_px", static_cast<int>(camera.width_px)},
                                {"height_px", static_cast<int>(camera.height_px)}}
      .dump();
}

CameraView parse_camera(std::string_view text, const std::string& where) {
  const CameraReader reader(text, where);
  CameraView camera{};
  camera.eye_mm = reader.vector("eye_mm");
  camera.target_mm = reader.vector("target_mm");
  camera.right = reader.vector("right");
  camera.up = reader.vector("up");
  camera.forward = reader.vector("forward");
  camera.orthographic = reader.boolean("orthographic");
  camera.half_width = reader.positive("half_width");
  camera.half_height = reader.positive("half_height");
  camera.width_px = reader.positive("width_px");
  camera.height_px = reader.positive("height_px");
  camera.focus_mm = 1;
  if (!are_orthonormal(camera)) reader.fail("has axes that are not orthonormal");
  return camera;
}

}  // namespace voxlume
