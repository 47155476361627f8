#pragma once
#include "integrator/scene_view.h"
#include "material/blinn_phong.h"
#include "material/particles.h"
#include "material/scatter.h"

namespace voxlume {

/// Matter at a real collision.
struct MatterPoint {
  ScatterPoint scatter;     ///< surface share and normal included
  ParticlePoint particles;  ///< the same as particles, where the scene shades those
  Highlight highlight;      ///< where the scene's shading is kBlinnPhong; scatter.p_brdf is 0 then
  Vec3f emission;           ///< L_e
  Vec3f p_world;            ///< LPS mm
};

/// Classifies the data `value` at p_index and finds its surface: the normal is the outward data gradient, to
/// which the faces of the visible region (clip box and the volume's own border) are added as far as one voxel
/// deep, so that a cut is shaded as a surface. Without a gradient the surface share is 0. Under rules the
/// gradient is that of the volume that decides about the extinction, and borders of labels are surfaces.
MatterPoint matter_at(const SceneView& scene, Vec3f p_index, float value) noexcept;

/// The albedo that the label at p_world [LPS mm] gives matter of `albedo`.
Vec3f labelled_albedo(const LabelsView& labels, Vec3f p_world, Vec3f albedo) noexcept;

/// The region whose points are too deep for faces to show: inside both boxes.
struct FaceReach {
  Box3f deep_index, deep_world;
  FaceReach(const Box3f& clip_world, const GridView& grid) noexcept
      : deep_index{grid.index_box().lower + grid.step_index, grid.index_box().upper - grid.step_index},
        deep_world{clip_world.lower + Vec3f(grid.step_mm), clip_world.upper - Vec3f(grid.step_mm)} {}
};

/// Sum of the outward normals of the faces less than a voxel away, each fading from 1 on the face to 0.
Vec3f face_normals(const Box3f& clip_world, const GridView& grid, Vec3f p_index, Vec3f p_world) noexcept;

}  // namespace voxlume
