#pragma once
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// Optical depth of one voxel above which matter is refused: a ray would take as many steps through it as its
/// majorant says, and beyond this float distances no longer move on.
constexpr double kMostVoxelDepth = 1e5;

/// Refuses what a picture of `volume` cannot be made from, as far as that is known without its tables: an eye
/// or a light out of reach, matter too dense to be tracked through, more steps than rays can take. `scene` is
/// resolved. Throws Error kBadParameter with the address of the field that is to blame ("/camera/zoom").
void check_picture(const SceneDescription& scene, const Volume& volume);

}  // namespace voxlume
