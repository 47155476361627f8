#pragma once
#include <optional>
#include <vector>

#include "server/document.h"

namespace voxlume::server {

class Viewer;

/// What is on screen for a while without being in the scene: the animation at a time, and fields that are
/// other than the scene's. Either belongs to the page that asked for it last, and ends with it.
class Passing {
 public:
  /// Shows the animation at a time; absent: not any more. False where that changes nothing.
  bool seek(const Viewer& page, std::optional<double> time_s);
  /// Shows the scene with these fields; none: as it is, if they were this page's. False where that changes
  /// nothing.
  bool set(const Viewer& page, std::vector<FieldEdit> fields);
  /// The page goes. False where nothing was its own.
  bool leave(const Viewer& page);

  /// What is to be shown of `document`. Fields that its scene has no place for any more are forgotten. Throws
  /// Error where the scene at that time is none.
  SceneDescription over(const Document& document);

 private:
  std::optional<double> time_s_;
  std::vector<FieldEdit> fields_;
  const Viewer* seeking_ = nullptr;
  const Viewer* setting_ = nullptr;
};

}  // namespace voxlume::server
