#pragma once
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// Reads the volume a scene names: a file, a folder, raw voxels, or the built-in phantom.
/// Throws Error: kBadParameter when no path is given or the raw specification, or the direction
/// is wrong, and those of read_volume.
Volume open_volume(const VolumeDescription& description);

}  // namespace voxlume
