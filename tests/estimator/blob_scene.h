#pragma once
#include "image_io/image_io.h"
#include "support/temporary_folder.h"
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

/// A dim sky with a small sun, as a picture; the file lives as long as the program.
inline const std::string& sky_file() {
  static const TemporaryFolder folder;
  static const std::string path = [] {
    Image sky(32, 16);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 32; ++x)
        for (int c = 0; c < 4; ++c)
          sky.pixel(x, y)[c] = c == 3 ? 1.0f : 0.1f * static_cast<float>(16 - y) / 16;
    for (int y = 2; y < 7; ++y)
      for (int x = 4; x < 10; ++x)
        for (int c = 0; c < 3; ++c) sky.pixel(x, y)[c] = 8;
    const std::string name = (folder / "sky.exr").string();
    write_exr(sky, name);
    return name;
  }();
  return path;
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
