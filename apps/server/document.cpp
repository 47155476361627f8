#include "server/document.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

#include "scene/field_info.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

using Json = nlohmann::json;

/// Names in an address: no scene has more, and what is nested without end is not to be copied or written.
constexpr std::ptrdiff_t kMostNames = 32;
constexpr std::size_t kMostSteps = 200;
constexpr std::size_t kMostHistoryBytes = std::size_t{64} << 20;
/// What parse_scene puts before the address of a field.
constexpr std::string_view kScenePrefix = "scene: ";

[[noreturn]] void refuse(const std::string& pointer, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, pointer, message);
}

/// "a~1b" is "a/b", "a~0b" "a~b".
std::string unescaped(std::string_view token, const std::string& pointer) {
  std::string out;
  for (std::size_t i = 0; i < token.size(); ++i) {
    if (token[i] != '~') {
      out += token[i];
      continue;
    }
    const char next = i + 1 < token.size() ? token[++i] : '\0';
    if (next != '0' && next != '1') refuse(pointer, "expected ~0 or ~1 after ~ in an address");
    out += next == '0' ? '~' : '/';
  }
  return out;
}

/// The element of a list; `append` allows the one after the last, as a number or "-".
std::size_t element(std::string_view token, std::size_t count, bool append, const std::string& pointer) {
  std::size_t index = 0;
  if (token == "-") {
    index = count;
  } else {
    const auto [stop, failed] = std::from_chars(token.data(), token.data() + token.size(), index);
    if (failed != std::errc{} || stop != token.data() + token.size())
      refuse(pointer, "found element " + quote_text(token) + ", expected a number");
  }
  if (index >= count + (append ? 1 : 0))
    refuse(pointer, "the list has " + std::to_string(count) + " elements");
  return index;
}

void set_last(Json& parent, const std::string& token, const Json& value, const std::string& pointer) {
  if (parent.is_array()) {
    const std::size_t i = element(token, parent.size(), !value.is_null(), pointer);
    if (value.is_null()) {
      parent.erase(i);
    } else if (i == parent.size()) {
      parent.push_back(value);
    } else {
      parent[i] = value;
    }
  } else if (parent.is_object()) {
    if (value.is_null())
      parent.erase(token);
    else
      parent[token] = value;
  } else {
    refuse(pointer, "a plain value has no fields");
  }
}

/// Members that differ, as they are in `to`; null where it has none.
Json differences(const Json& from, const Json& to) {
  Json out = Json::object();
  for (const auto& [key, value] : to.items())
    if (const auto old = from.find(key); old == from.end() || *old != value) out[key] = value;
  for (const auto& [key, value] : from.items())
    if (!to.contains(key)) out[key] = nullptr;
  return out;
}

Json without_size(Json scene) {
  if (const auto image = scene.find("image"); image != scene.end() && image->is_object()) {
    image->erase("width");
    image->erase("height");
  }
  return scene;
}

SceneDescription parsed(const Json& scene) {
  try {
    return parse_scene(scene.dump(), "scene");
  } catch (const Error& error) {
    std::string where = error.where();
    if (where.starts_with(kScenePrefix)) where.erase(0, kScenePrefix.size());
    throw Error(error.code(), where == "scene" ? "/" : where, error.message());
  } catch (const Json::exception&) {
    throw Error(ErrorCode::kBadFormat, "/", "the scene holds text that is not UTF-8");
  }
}

}  // namespace

void set_member(Json& scene, const std::string& pointer, const Json& value) {
  if (!pointer.starts_with('/')) refuse(pointer, "expected an address such as /camera/zoom");
  if (std::count(pointer.begin(), pointer.end(), '/') > kMostNames)
    refuse(pointer.substr(0, 64), "expected an address of at most " + std::to_string(kMostNames) + " names");
  Json* parent = &scene;
  for (std::size_t start = 1;;) {
    const std::size_t end = std::min(pointer.find('/', start), pointer.size());
    const std::string token = unescaped(std::string_view(pointer).substr(start, end - start), pointer);
    if (end == pointer.size()) return set_last(*parent, token, value, pointer);
    if (parent->is_array()) {
      parent = &(*parent)[element(token, parent->size(), false, pointer)];
    } else if (parent->is_object()) {
      if (!parent->contains(token)) (*parent)[token] = Json::object();
      parent = &(*parent)[token];
    } else {
      refuse(pointer, "a plain value has no fields");
    }
    start = end + 1;
  }
}

namespace {

SceneDescription edited(Json scene, const std::vector<FieldEdit>& fields) {
  for (const auto& [pointer, value] : fields) set_member(scene, pointer, value);
  return parsed(scene);
}

}  // namespace

Document::Document(SceneDescription scene, Rules rules)
    : rules_(std::move(rules)),
      scene_(std::make_shared<const SceneDescription>(std::move(scene))),
      json_(Json::parse(write_scene(*scene_, true))) {}

SceneDescription Document::allowed(SceneDescription scene) const {
  if (!(scene.volume == scene_->volume))
    refuse("/volume", "the volume is another one; open its file instead, or load the scene as a whole");
  const auto pixels = static_cast<std::int64_t>(scene.image.width) * scene.image.height;
  if (pixels > kMostPixels)
    refuse("/image/width", "found " + std::to_string(scene.image.width) + " x " +
                               std::to_string(scene.image.height) + ", expected at most " +
                               std::to_string(kMostPixels) + " pixels on screen");
  rules_.check_paths(scene, *scene_);
  return rules_.resolve(scene);
}

Document::Accepted Document::accept(const SceneDescription& scene) const {
  Accepted accepted{allowed(scene), {}};
  accepted.json = Json::parse(write_scene(accepted.scene, true));
  return accepted;
}

Json Document::become(Accepted accepted, const std::string& gesture) {
  const Json changed = differences(json_, accepted.json);
  if (changed.empty()) return changed;
  const Json before = without_size(json_), after = without_size(accepted.json);
  const Json forward = differences(before, after);
  json_ = std::move(accepted.json);
  scene_ = std::make_shared<const SceneDescription>(std::move(accepted.scene));
  if (forward.empty()) return changed;  // a size alone is no step, and ends no gesture
  redone_.clear();
  Json backward = differences(after, before);
  Step* step = step_of(gesture, forward);
  if (step != nullptr) {
    backward.update(step->before);
    step->before = std::move(backward);
    step->after.update(forward);
  } else {
    step = &undone_.emplace_back(Step{std::move(backward), forward, gesture});
  }
  step->bytes = step->before.dump().size() + step->after.dump().size();
  forget_oldest();
  return changed;
}

Document::Step* Document::step_of(const std::string& gesture, const Json& changed) {
  if (gesture.empty()) return nullptr;
  for (auto step = undone_.rbegin(); step != undone_.rend(); ++step) {
    if (step->gesture == gesture) return &*step;
    // Taking the later step back must leave these members alone.
    for (const auto& [key, value] : changed.items())
      if (step->after.contains(key)) return nullptr;
  }
  return nullptr;
}

void Document::forget_oldest() {
  std::size_t bytes = 0;
  for (const Step& step : undone_) bytes += step.bytes;
  while (undone_.size() > 1 && (undone_.size() > kMostSteps || bytes > kMostHistoryBytes)) {
    bytes -= undone_.front().bytes;
    undone_.pop_front();
  }
}

Json Document::edit(const std::vector<FieldEdit>& fields, const std::string& gesture) {
  return become(accept(edited(json_, fields)), gesture);
}

SceneDescription Document::with(const std::vector<FieldEdit>& fields) const {
  return allowed(edited(json_, fields));
}

void Document::replace(const SceneDescription& scene) { become(accept(scene), ""); }

bool Document::take_step(std::deque<Step>& from, std::deque<Step>& to, Json Step::*members) {
  if (from.empty()) return false;
  Json scene = json_;
  for (const auto& [key, value] : (from.back().*members).items()) set_member(scene, "/" + key, value);
  scene["image"]["width"] = json_["image"]["width"];
  scene["image"]["height"] = json_["image"]["height"];
  scene_ = std::make_shared<const SceneDescription>(parsed(scene));
  json_ = std::move(scene);
  from.back().gesture.clear();
  to.push_back(std::move(from.back()));
  from.pop_back();
  for (Step& step : undone_) step.gesture.clear();
  return true;
}

bool Document::undo() { return take_step(undone_, redone_, &Step::before); }
bool Document::redo() { return take_step(redone_, undone_, &Step::after); }

}  // namespace voxlume::server
