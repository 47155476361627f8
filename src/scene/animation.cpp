#include "scene/animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include "scene/field_walk.h"
#include "scene/track_value.h"
#include "scene/validate.h"

namespace voxlume {
namespace {

constexpr double kMaxFrames = 1e6;
constexpr const char* kPresetField = "/transfer/preset";

/// Throws unless the field may change from frame to frame.
void check_animatable(const std::string& field, const FieldInfo& info, bool leaf, const std::string& where) {
  static const std::vector<std::string_view> kSections{"camera", "lights",   "environment", "background",
                                                       "clip",   "transfer", "material",    "labels"};
  std::string_view rest = field;
  const std::string_view section = take_key(rest);
  const bool known = std::find(kSections.begin(), kSections.end(), section) != kSections.end();
  if (leaf && !info.is_path && (known || field == "/image/exposure_ev")) return;
  throw Error(ErrorCode::kBadParameter, where,
              quote_text(field) + " cannot be animated; expected a single field of " + join_words(kSections) +
                  ", or /image/exposure_ev");
}

void check_keys(const AnimationTrack& track, const std::string& where) {
  if (track.keys.empty()) throw Error(ErrorCode::kBadParameter, where, "found no key, expected at least one");
  for (std::size_t i = 1; i < track.keys.size(); ++i) {
    if (track.keys[i].time_s >= track.keys[i - 1].time_s) continue;
    throw Error(ErrorCode::kBadParameter, child_address(where, std::to_string(i)),
                fmt::format("found time {} after {}, expected keys sorted by time", track.keys[i].time_s,
                            track.keys[i - 1].time_s));
  }
}

void check_track(const AnimationTrack& track, const std::string& where) {
  const std::string field_where = child_address(where, "field"), keys_where = child_address(where, "keys");
  check_address(track.field, field_where);
  const auto check = [&]<class T>(const FieldInfo& info, Type<T>) {
    check_animatable(track.field, info, TrackValue<T>, field_where);
    check_keys(track, keys_where);
    if constexpr (TrackValue<T>) {
      for (std::size_t i = 0; i < track.keys.size(); ++i)
        key_value<T>(track.keys[i], info, child_address(keys_where, std::to_string(i)));
    }
  };
  FieldTypeWalk{field_where}.visit(track.field, FieldInfo{.key = "", .doc = ""}, Type<SceneDescription>{},
                                   check);
}

/// The four keys around `time_s`; the first or last key twice where the time is outside.
KeyWindow<const AnimationKey*> window_at(const std::vector<AnimationKey>& keys, double time_s) {
  const auto is_later = [](double t, const AnimationKey& key) { return t < key.time_s; };
  const auto next = std::upper_bound(keys.begin(), keys.end(), time_s, is_later);
  const auto entry = [](auto key) { return KeyWindow<const AnimationKey*>::Key{key->time_s, &*key}; };
  if (next == keys.begin()) return {{}, entry(next), entry(next), {}};
  const auto begin = next - 1;
  if (next == keys.end()) return {{}, entry(begin), entry(begin), {}};
  KeyWindow<const AnimationKey*> window{{}, entry(begin), entry(next), {}};
  // A jump, two keys at one time, is an end of the course on either side.
  if (begin != keys.begin() && (begin - 1)->time_s < begin->time_s) window.before = entry(begin - 1);
  if (next + 1 != keys.end() && next->time_s < (next + 1)->time_s) window.after = entry(next + 1);
  return window;
}

template <TrackValue T>
T track_value(const AnimationTrack& track, double time_s, const FieldInfo& info, const std::string& where) {
  const KeyWindow<const AnimationKey*> keys = window_at(track.keys, time_s);
  const auto entry = [&](const auto& key) {
    return typename KeyWindow<T>::Key{key.time_s, key_value<T>(*key.value, info, where)};
  };
  if (keys.begin.value == keys.end.value) return entry(keys.begin).value;
  KeyWindow<T> window{{}, entry(keys.begin), entry(keys.end), {}};
  if (keys.before) window.before = entry(*keys.before);
  if (keys.after) window.after = entry(*keys.after);
  return interpolate_value(window, time_s, track.interpolation, info.is_direction);
}

void apply_track(const AnimationTrack& track, double time_s, const std::string& where,
                 SceneDescription& scene) {
  const auto set = [&]<class T>(const FieldInfo& info, T& field) {
    if constexpr (OptionalField<T>) {
      if constexpr (TrackValue<typename T::value_type>)
        field = track_value<typename T::value_type>(track, time_s, info, where);
    } else if constexpr (TrackValue<T>) {
      field = track_value<T>(track, time_s, info, where);
    }
  };
  FieldWalk{where}.visit(track.field, FieldInfo{.key = "", .doc = ""}, scene, set);
  if (track.field == kPresetField) scene.transfer.points.clear();  // they would win over the preset
}

/// The vector turned about +z as azimuth turns the eye.
Double3 turned(const Double3& v, double angle_deg) {
  const double angle = angle_deg * std::numbers::pi / 180.0, c = std::cos(angle), s = std::sin(angle);
  return {v[0] * c - v[1] * s, v[0] * s + v[1] * c, v[2]};
}

void apply_turntable(const TurntableDescription& turntable, double time_s, CameraDescription& camera) {
  // A whole turn is none, so that numbers stay small and the second round repeats the first.
  const double angle_deg = std::fmod(360 * turntable.turns * time_s / turntable.seconds, 360);
  if (!camera.eye_mm) {
    camera.azimuth_deg += angle_deg;
    return;
  }
  const Double3 target = camera.target_mm.value_or(Double3{});
  Double3 from_target;
  for (std::size_t a = 0; a < 3; ++a) from_target[a] = (*camera.eye_mm)[a] - target[a];
  from_target = turned(from_target, angle_deg);
  for (std::size_t a = 0; a < 3; ++a) (*camera.eye_mm)[a] = target[a] + from_target[a];
  if (camera.up) camera.up = turned(*camera.up, angle_deg);
}

}  // namespace

void check_animation(const AnimationDescription& animation, const std::string& where) {
  const std::string list = child_address(where, "tracks");
  std::set<std::string> fields;
  for (std::size_t i = 0; i < animation.tracks.size(); ++i) {
    const AnimationTrack& track = animation.tracks[i];
    const std::string address = child_address(list, std::to_string(i));
    check_track(track, address);
    if (!fields.insert(track.field).second)
      throw Error(ErrorCode::kBadParameter, child_address(address, "field"),
                  "found a second track of " + quote_text(track.field) + ", expected one a field");
  }
}

int frame_count(const AnimationDescription& animation) {
  if (animation.frames) return *animation.frames;
  double count = 0;
  if (animation.turntable) {
    count = std::round(animation.turntable->seconds * animation.fps);
  } else {
    if (animation.tracks.empty())
      throw Error(ErrorCode::kBadParameter, "/animation",
                  "nothing says how many frames; expected turntable, tracks or frames");
    double last_s = 0;
    for (const AnimationTrack& track : animation.tracks) last_s = std::max(last_s, track.keys.back().time_s);
    count = std::round(last_s * animation.fps) + 1;
  }
  if (count > kMaxFrames)
    throw Error(ErrorCode::kBadParameter, "/animation",
                fmt::format("comes to {} frames, expected at most {}", count, kMaxFrames));
  return std::max(1, static_cast<int>(count));
}

SceneDescription scene_at(const SceneDescription& animated, double time_s) {
  SceneDescription out = animated;
  out.animation.reset();
  if (!animated.animation) return out;
  const AnimationDescription& animation = *animated.animation;
  for (std::size_t i = 0; i < animation.tracks.size(); ++i)
    apply_track(animation.tracks[i], time_s, "/animation/tracks/" + std::to_string(i), out);
  if (animation.turntable) apply_turntable(*animation.turntable, time_s, out.camera);
  validate_scene(out);
  return out;
}

double frame_time_s(const AnimationDescription& animation, int frame) { return frame / animation.fps; }

SceneDescription scene_of_frame(const SceneDescription& animated, int frame) {
  try {
    SceneDescription out = scene_at(animated, frame_time_s(*animated.animation, frame));
    out.render.frame += static_cast<std::uint32_t>(frame);
    return out;
  } catch (const Error& error) {
    throw Error(error.code(), error.where(), fmt::format("{} (frame {})", error.message(), frame));
  }
}

}  // namespace voxlume
