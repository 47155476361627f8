#pragma once
#include "test_scene.h"

namespace voxlume::test {

/// Two soft blobs, one denser than the other.
inline Volume two_blobs() {
  return make_volume({32, 32, 32}, 1.5, [](Vec3d p) {
    const double a = std::exp(-dot(p - Vec3d(-7, 2, 3), p - Vec3d(-7, 2, 3)) / 60);
    const double b = std::exp(-dot(p - Vec3d(8, -4, -5), p - Vec3d(8, -4, -5)) / 40);
    return 100 * std::max(a, 0.9 * b);
  });
}

inline SceneDescription blob_scene() {
  SceneDescription scene = dark_scene(32, 32);
  scene.transfer.points = {point(15, 0, {{0.9f, 0.5f, 0.3f}}), point(40, 0.15, {{0.9f, 0.6f, 0.4f}}),
                           point(70, 1.5, {{0.9f, 0.9f, 0.8f}})};
  scene.camera.azimuth_deg = 20;
  scene.camera.elevation_deg = 15;
  scene.camera.zoom = 1.7;
  return scene;
}

inline LightDescription area_light() {
  LightDescription light;
  light.kind = LightKind::kRect;
  light.position_mm = Double3{-40, -50, 40};
  light.target_mm = Double3{0, 0, 0};
  light.up = Double3{0, 0, 1};
  light.size_mm = {90, 70};
  light.intensity = 4;
  return light;
}

}  // namespace voxlume::test
