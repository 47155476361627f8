#pragma once
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// The scene with every world position moved by -`origin_mm`; what is attached to the camera moves with its
/// target. `scene` is resolved. Kernels compute in floats: with the volume's centre as origin they keep the
/// same precision wherever a scanner or a map put it.
SceneDescription moved_to_origin(SceneDescription scene, const Double3& origin_mm);

/// The same for a volume; the voxels are shared.
Volume moved_to_origin(Volume volume, const Double3& origin_mm);

}  // namespace voxlume
