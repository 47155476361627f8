#pragma once
#include "integrator/scene_view.h"
#include "light/sample_light.h"

namespace voxlume {

/// Whether the background at an image point is a mean over directions.
inline bool blurs_background(const SceneView& scene) noexcept {
  return scene.background == BackgroundKind::kEnvironment && scene.camera.background_versine > 0;
}

/// What a camera ray through image point (px, py) in direction `direction_world` sees where it meets nothing;
/// a blurred background in one of its directions, chosen by u0, u1.
inline Vec3f background_radiance(const SceneView& scene, float px, float py, Vec3f direction_world, float u0,
                                 float u1) noexcept {
  switch (scene.background) {
    case BackgroundKind::kTransparent:
      return Vec3f(0);
    case BackgroundKind::kColor:
      return scene.background_color;
    case BackgroundKind::kEnvironment:
      break;
  }
  if (blurs_background(scene)) direction_world = background_direction(scene.camera, px, py, u0, u1);
  if (!scene.lights.has_environment) return Vec3f(0);
  return eval_environment(scene.lights.environment, direction_world).radiance;
}

}  // namespace voxlume
