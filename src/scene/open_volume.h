#pragma once
#include "base/progress.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// Reads the volume a scene names: a file, a folder, raw voxels, or the built-in phantom.
/// Throws Error: kBadParameter when no path is given or the raw specification, or the direction
/// is wrong, and those of read_volume. `progress`, which may be empty, is that of ReadOptions; nobody reads
/// the phantom.
Volume open_volume(const VolumeDescription& description, const Progress& progress = {});

}  // namespace voxlume
