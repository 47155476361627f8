#pragma once
#include <string>

#include "grid/volume_statistics.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// 16 hexadecimal digits of the volume's place, type and values (their histogram).
std::string volume_digest(const Volume& volume, const VolumeStatistics& statistics);

/// `scene` without what only ends or develops a render: equal for scenes whose samples are.
SceneDescription scene_of_samples(SceneDescription scene);

/// Text that differs whenever samples of the scene differ: the scene without what only ends or develops a
/// render, and its volume's digest. `scene` is resolved.
std::string scene_fingerprint(const SceneDescription& scene, const std::string& volume_digest);

/// 16 hexadecimal digits that differ (but for chance) whenever the finished picture may: of everything in the
/// scene and its volume's digest. `scene` is resolved.
std::string picture_digest(const SceneDescription& scene, const std::string& volume_digest);

}  // namespace voxlume
