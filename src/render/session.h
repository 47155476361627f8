#pragma once
#include <optional>
#include <string>

#include "base/progress.h"
#include "grid/volume_statistics.h"
#include "scene/compile.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// A scene and its volume in hand: the voxels are read and looked over once, everything left open is chosen
/// once, and of a picture after the first only what changed is compiled.
class Session {
 public:
  /// Takes the volume's statistics, of which `progress` hears, and resolves `scene`. Throws Error, those of
  /// resolve().
  Session(const SceneDescription& scene, Volume volume, const Progress& progress = {});

  const Volume& volume() const { return volume_; }
  const VolumeStatistics& statistics() const { return statistics_; }
  /// The scene with everything chosen in it, its animation too.
  const SceneDescription& description() const { return description_; }
  /// The scene of one frame (scene_of_frame), everything chosen. Throws Error kBadParameter for values that
  /// do not go together, or choices of a preset that there is not.
  SceneDescription frame_description(int frame) const;

  /// `scene`, of this session's volume, with everything open chosen. Throws Error, those of resolve().
  SceneDescription resolved(const SceneDescription& scene) const;

  /// Makes `scene`, resolved and of this session's volume, what compiled() is; its animation is left out.
  /// Throws Error: those of CompiledScene, whose `progress` this is.
  void compile(SceneDescription scene, const ListProgress& progress = {});
  /// What compile() made last; it must have been called.
  const CompiledScene& compiled() const { return *compiled_; }

  /// scene_fingerprint and picture_digest of `scene` with this session's volume.
  std::string fingerprint(const SceneDescription& scene) const;
  std::string digest(const SceneDescription& scene) const;

 private:
  Volume volume_;
  VolumeStatistics statistics_;
  std::string volume_digest_;
  SceneDescription description_;
  std::optional<CompiledScene> compiled_;
};

}  // namespace voxlume
