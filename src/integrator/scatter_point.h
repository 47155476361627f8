#pragma once
#include "integrator/scene_view.h"
#include "material/scatter.h"

namespace voxlume {

/// Matter at a real collision.
struct MatterPoint {
  ScatterPoint scatter;  ///< surface share and normal included
  Vec3f emission;        ///< L_e
  Vec3f p_world;         ///< LPS mm
};

/// Classifies the data `value` at p_index and finds its surface: the normal is the outward data gradient, to
/// which the faces of the visible region (clip box and the volume's own border) are added as far as one voxel
/// deep, so that a cut is shaded as a surface. Without a gradient the surface share is 0.
MatterPoint matter_at(const SceneView& scene, Vec3f p_index, float value) noexcept;

}  // namespace voxlume
