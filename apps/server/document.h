#pragma once
#include <deque>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "voxlume/scene.h"

namespace voxlume::server {

/// A field of the scene by its JSON pointer, and what it is to be; null removes it.
using FieldEdit = std::pair<std::string, nlohmann::json>;

/// The scene that everybody sees and changes, and how it came to be. Always resolved and valid.
///
/// The picture's size (/image/width, /image/height) belongs to the screen it is shown on: undoing leaves it.
class Document {
 public:
  /// What edits are held to.
  struct Rules {
    /// Fills in what a scene leaves open. May throw Error.
    std::function<SceneDescription(const SceneDescription&)> resolve;
    /// Looks at a scene's paths, and may change them; `before` is the scene that it follows. May throw Error.
    std::function<void(SceneDescription& scene, const SceneDescription& before)> check_paths;
  };

  /// Starts with `scene`, which is resolved. Throws Error kBadParameter where a text in it is not UTF-8.
  Document(SceneDescription scene, Rules rules);

  const SceneDescription& scene() const { return *scene_; }
  /// The same for other threads, who may keep it: it is never changed.
  std::shared_ptr<const SceneDescription> shared_scene() const { return scene_; }
  /// The scene with every field.
  const nlohmann::json& json() const { return json_; }
  bool can_undo() const { return !undone_.empty(); }
  bool can_redo() const { return !redone_.empty(); }

  /// Sets fields, all or nothing. Edits with the same non-empty `gesture` are one step of undo, unless in
  /// between another edit changed the same top-level members, or something was undone.
  /// Returns the top-level members that are different now, null where one is gone; empty: nothing changed.
  /// Throws Error, its where() the field's address ("/transfer/points/2/value").
  nlohmann::json edit(const std::vector<FieldEdit>& fields, const std::string& gesture = "");

  /// The scene with these fields set, which it does not become. Throws Error, as edit().
  SceneDescription with(const std::vector<FieldEdit>& fields) const;
  /// Another scene of this volume with what it leaves open filled in. Throws Error.
  SceneDescription resolved(const SceneDescription& scene) const { return rules_.resolve(scene); }

  /// Another scene for the same volume, in one step. Throws Error, as edit().
  void replace(const SceneDescription& scene);

  /// Takes the last step back, or makes it again. False where there is none.
  bool undo();
  bool redo();

 private:
  /// The same top-level members before and after; null where there was none.
  struct Step {
    nlohmann::json before, after;
    std::string gesture;
    std::size_t bytes = 0;
  };
  struct Accepted {
    SceneDescription scene;
    nlohmann::json json;
  };

  SceneDescription allowed(SceneDescription scene) const;
  Accepted accept(const SceneDescription& scene) const;
  nlohmann::json become(Accepted accepted, const std::string& gesture);
  bool take_step(std::deque<Step>& from, std::deque<Step>& to, nlohmann::json Step::*members);
  /// The step that an edit of `gesture`, which changed these members, belongs to; null: a new one.
  Step* step_of(const std::string& gesture, const nlohmann::json& changed);
  void forget_oldest();

  Rules rules_;
  std::shared_ptr<const SceneDescription> scene_;
  nlohmann::json json_;
  std::deque<Step> undone_, redone_;  ///< what undo and redo would take, the next one last
};

/// Sets a field in `scene` by its pointer; objects on the way that are missing are made. Throws Error
/// kBadParameter at the pointer where there is no such place.
void set_member(nlohmann::json& scene, const std::string& pointer, const nlohmann::json& value);

/// Most pixels of a picture on screen.
constexpr int kMostPixels = 1 << 24;

}  // namespace voxlume::server
