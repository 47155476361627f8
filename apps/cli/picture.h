#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "film/film.h"
#include "grid/volume_statistics.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume::cli {

/// Develops and writes the picture on the film as PNG or EXR, by the extension of `path`.
/// Throws Error kFileNotFound, kInternal.
void write_picture(const Film& film, const std::vector<std::string>& aovs, const SceneDescription& scene,
                   const std::filesystem::path& path);

/// Text that differs whenever samples of the scene differ: the scene without what only ends or develops a
/// render, and a digest of the volume. `scene` is resolved.
std::string scene_fingerprint(const SceneDescription& scene, const Volume& volume,
                              const VolumeStatistics& statistics);

}  // namespace voxlume::cli
