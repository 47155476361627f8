#include "scene/recenter.h"

namespace voxlume {
namespace {

void move(Double3& position_mm, const Double3& origin_mm) {
  for (std::size_t a = 0; a < 3; ++a) position_mm[a] -= origin_mm[a];
}

void move(std::optional<Double3>& position_mm, const Double3& origin_mm) {
  if (position_mm) move(*position_mm, origin_mm);
}

}  // namespace

SceneDescription moved_to_origin(SceneDescription scene, const Double3& origin_mm) {
  move(scene.camera.target_mm, origin_mm);
  move(scene.camera.eye_mm, origin_mm);
  if (scene.lights) {
    for (LightDescription& light : *scene.lights) {
      if (light.attached_to == Attachment::kCamera) continue;
      move(light.position_mm, origin_mm);
      move(light.target_mm, origin_mm);
    }
  }
  if (scene.visibility)
    for (ImportanceDescription& important : scene.visibility->important) move(important.center_mm, origin_mm);
  if (scene.clip) {
    for (double& x : scene.clip->x_mm) x -= origin_mm[0];
    for (double& y : scene.clip->y_mm) y -= origin_mm[1];
    for (double& z : scene.clip->z_mm) z -= origin_mm[2];
  }
  return scene;
}

Volume moved_to_origin(Volume volume, const Double3& origin_mm) {
  move(volume.origin_mm, origin_mm);
  return volume;
}

}  // namespace voxlume
