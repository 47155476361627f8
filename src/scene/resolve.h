#pragma once
#include "grid/volume_statistics.h"
#include "voxlume/scene.h"
#include "voxlume/volume.h"

namespace voxlume {

/// A sphere around what is visible [LPS mm].
struct BoundingSphere {
  Double3 center_mm;
  double radius_mm;
};

/// The volume's own bounding sphere, or that of the part the clip box keeps.
/// Throws Error kBadParameter (/clip/x_mm, ...) when the box keeps nothing of the volume.
BoundingSphere visible_sphere(const Volume& volume, const std::optional<ClipDescription>& clip);

/// Fills in everything the user left open (the default picture, docs/default-picture.md), so that the result
/// alone, saved, gives the same picture: preset points, reference length, lights, environment, background,
/// camera target and framing, samples. What is given stays, but for what the integrator demands
/// (scene/peers.h). Throws Error kBadParameter for an unknown preset or an empty clip box, and those of
/// check_picture().
SceneDescription resolve(const SceneDescription& scene, const Volume& volume,
                         const VolumeStatistics& statistics);

}  // namespace voxlume
