// Where things are: orientation, clip boxes, cut faces, the camera's right and left.
#include <gtest/gtest.h>

#include "test_scene.h"

namespace voxlume::test {
namespace {

double lopsided_head(Vec3d p) {
  const double skull = 60 * std::max(0.0, 1.3 - length(p / Vec3d(30, 38, 34)));
  const Vec3d nose = p - Vec3d(0, -38, -6), ear = p - Vec3d(30, 4, 0), bump = p - Vec3d(-12, -20, 24);
  return skull + 50 * std::exp(-dot(nose, nose) / 50) + 50 * std::exp(-dot(ear, ear) / 40) +
         45 * std::exp(-dot(bump, bump) / 60);
}

SceneDescription head_scene() {
  SceneDescription scene = dark_scene(32, 32);
  scene.transfer.points = {point(12, 0, grey(0.8f)), point(30, 1.0, {{0.9f, 0.6f, 0.4f}})};
  scene.environment->intensity = 0.5;
  scene.lights = {directional({-1, -2, 1}, 2)};
  scene.camera.projection = Projection::kPerspective;
  scene.camera.eye_mm = Double3{60, -180, 50};
  scene.camera.target_mm = Double3{0, 0, 0};
  scene.camera.vertical_fov_deg = 34;
  return scene;
}

TEST(Geometry, AnObliqueVolumeLooksLikeAnAxialOneFromTheSamePlace) {
  const Volume axial = make_volume({72, 80, 76}, 1.25, lopsided_head);
  // Turned 30 degrees about z and 20 about x, the index axes permuted and one flipped.
  const double cz = std::cos(0.5236), sz = std::sin(0.5236), cx = std::cos(0.3491), sx = std::sin(0.3491);
  const Vec3d i(cz, sz, 0), j(-sz * cx, cz * cx, sx), k(sz * sx, -cz * sx, cx);
  const Volume oblique =
      make_volume({96, 96, 96}, 1.25, lopsided_head, {k.x, -i.x, j.x, k.y, -i.y, j.y, k.z, -i.z, j.z});
  const SceneDescription scene = head_scene();
  const Estimate a = estimate(scene, axial, 64), b = estimate(scene, oblique, 64);
  double difference2 = 0, signal2 = 0, noise2 = 0;
  for (int by = 0; by < 8; ++by) {
    for (int bx = 0; bx < 8; ++bx) {
      const Moments ma = a.block(bx, by, 4), mb = b.block(bx, by, 4);
      difference2 += (ma.mean() - mb.mean()) * (ma.mean() - mb.mean());
      noise2 += ma.standard_error() * ma.standard_error() + mb.standard_error() * mb.standard_error();
      signal2 += ma.mean() * ma.mean();
    }
  }
  // The two grids interpolate the same function differently: 2 % is far below what any mix-up of axes makes.
  EXPECT_LT(std::sqrt(std::max(0.0, difference2 - noise2) / signal2), 0.02);
  EXPECT_GT(signal2, 0.1);
}

TEST(Geometry, ThePatientsLeftIsOnTheRightOfAFrontalPicture) {
  const Volume volume = make_volume({48, 48, 48}, 1.0, [](Vec3d p) {
    const Vec3d left = p - Vec3d(12, 0, 0), top = p - Vec3d(0, 0, 16);
    return 100 * std::exp(-dot(left, left) / 20) + 100 * std::exp(-dot(top, top) / 20);
  });
  SceneDescription scene = dark_scene(16, 16);
  scene.transfer.points = {point(20, 0, grey(1)), point(40, 2, grey(1))};
  scene.environment->intensity = 1;
  scene.camera.height_mm = 48;
  const Estimate image = estimate(scene, volume, 64);
  double right = 0, left = 0, top = 0, bottom = 0;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      const double value = image.pixels[y * 16 + x].mean();
      (x < 8 ? left : right) += value;
      (y < 8 ? top : bottom) += value;
    }
  }
  EXPECT_GT(right, 2 * left);  // the blob at +x; the one on top straddles the middle
  EXPECT_GT(top, 2 * bottom);
}

/// A wall of matter at z in [-20, 20], lit from above (+z), cut at z = 0, seen from above.
SceneDescription cut_scene() {
  SceneDescription scene = dark_scene(8, 8);
  scene.camera.elevation_deg = 90;
  scene.camera.height_mm = 8;
  scene.transfer.points = {point(1, 3, grey(0.8f))};
  scene.lights = {directional({0, 0, 1}, 3)};
  scene.clip.emplace();
  scene.clip->z_mm = {-1e30, 0};
  return scene;
}

Volume block() {
  return make_volume({20, 20, 20}, 2.0, [](Vec3d) { return 1.0; });
}

TEST(Geometry, WhatIsCutAwayLetsLightPassOrBlocksIt) {
  SceneDescription scene = cut_scene();
  const double open = estimate(scene, block(), 200).total().mean();
  scene.clip->blocks_light = true;
  const double blocked = estimate(scene, block(), 200).total().mean();
  EXPECT_GT(open, 0.1);
  EXPECT_LT(blocked, 1e-3 * open);  // 20 mm of mu_t = 3
}

TEST(Geometry, CutFacesAreShadedAsSurfaces) {
  // A homogeneous block has no gradient: without the face's normal it would scatter as a medium alone. A
  // surface lobe lit and seen along its normal is brighter than the isotropic phase function: 1/pi against
  // 1/(4 pi).
  SceneDescription scene = cut_scene();
  scene.material.shading = Shading::kPhase;
  const double medium = estimate(scene, block(), 400).total().mean();
  scene.material.shading = Shading::kCoexistence;
  scene.material.gradient_factor = 1;
  const double surface = estimate(scene, block(), 400).total().mean();
  EXPECT_GT(surface, 1.7 * medium);

  // And the normal is the face's: turned away from the light it goes dark sooner than a medium does.
  scene.lights = {directional({1, 0, 0.05}, 3)};
  const double grazing = estimate(scene, block(), 400).total().mean();
  EXPECT_LT(grazing, 0.25 * surface);
}

TEST(Geometry, ClippingRemovesExactlyWhatIsOutside) {
  SceneDescription scene = cut_scene();
  scene.camera.elevation_deg = 0;
  scene.camera.height_mm = 40;
  scene.lights = {directional({0, -1, 0}, 3)};
  scene.image.width = scene.image.height = 40;
  scene.camera.target_mm = Double3{0, 0, 0};
  const Estimate image = estimate(scene, block(), 8);
  for (int y = 0; y < 40; ++y) {
    const double row = image.block(20, y, 1).mean();
    if (y < 20) {
      EXPECT_EQ(row, 0) << y;  // z > 0
    } else if (y > 20) {
      EXPECT_GT(row, 0) << y;
    }
  }
}

TEST(Geometry, SameImageForAnyThreadCount) {
  const Volume volume = make_volume({24, 24, 24}, 3.0, lopsided_head);
  SceneDescription scene = head_scene();
  std::vector<Estimate> images;
  for (const int threads : {1, 2, 7}) {
    const ThreadLimit limit(threads);
    images.push_back(estimate(scene, volume, 8));
  }
  for (std::size_t i = 0; i < images[0].pixels.size(); ++i) {
    EXPECT_EQ(images[0].pixels[i].sum, images[1].pixels[i].sum);
    EXPECT_EQ(images[0].pixels[i].sum, images[2].pixels[i].sum);
  }
}

}  // namespace
}  // namespace voxlume::test
