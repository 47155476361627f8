// Pictures that have a closed form (shared references: Chandrasekhar's H function, the single-scattering
// slab).
#include <gtest/gtest.h>

#include <numbers>

#include "test_scene.h"

namespace voxlume::test {
namespace {

constexpr double kPi = std::numbers::pi;

/// A constant block of the given voxel size in mm per axis (3 voxels each).
Volume block(Double3 spacing_mm) {
  Volume volume = make_volume({3, 3, 3}, 1.0, [](Vec3d) { return 1.0; });
  volume.spacing_mm = spacing_mm;
  for (int a = 0; a < 3; ++a) volume.origin_mm[a] = -spacing_mm[a];
  return volume;
}

/// An orthographic view of the middle of the face at -y.
SceneDescription middle_view(double mu_t, double albedo) {
  SceneDescription scene = dark_scene(4, 4);
  scene.camera.height_mm = 1;
  scene.transfer.points = {point(1, mu_t, grey(static_cast<float>(albedo)))};
  scene.material.shading = Shading::kPhase;
  return scene;
}

void expect_mean(const Moments& moments, double expected) {
  EXPECT_LT(std::abs(moments.mean() - expected), 4 * moments.standard_error() + 1e-6 * expected)
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

TEST(Analytic, AbsorbingAndEmittingSlab) {
  for (const double mu_t : {0.05, 0.3, 1.5}) {
    SceneDescription scene = middle_view(mu_t, 0);
    scene.transfer.points[0].emission = grey(0.7f);
    scene.background->color = grey(2);
    const double transmittance = std::exp(-mu_t * 6.0);
    expect_mean(estimate(scene, block({2, 2, 2}), 20000).total(),
                2 * transmittance + 0.7 * (1 - transmittance));
  }
}

TEST(Analytic, SingleScatteringSlabLitFromTheFront) {
  const double irradiance = 3, albedo = 0.6;
  for (const double mu0 : {1.0, 0.5}) {
    for (const double tau : {0.2, 2.0}) {
      // 12 mm thick, wide enough that the sides are out of reach.
      SceneDescription scene = middle_view(tau / 12, albedo);
      scene.lights = {directional({std::sqrt(1 - mu0 * mu0), -mu0, 0}, irradiance)};
      scene.render.max_scatter = 1;
      const double expected =
          albedo * irradiance / (4 * kPi) * (1 - std::exp(-tau * (1 + 1 / mu0))) / (1 + 1 / mu0);
      expect_mean(estimate(scene, block({4000, 4, 4000}), 10000).total(), expected);
    }
  }
}

TEST(Analytic, SingleScatteringSlabLitFromBehind) {
  const double tau = 1.5, g = 0.4;
  SceneDescription scene = middle_view(tau / 12, 1);
  scene.material.anisotropy = g;
  scene.lights = {directional({0, 1, 0}, 2)};
  scene.render.max_scatter = 1;
  const double forward = (1 - g * g) / (4 * kPi * std::pow(1 - g, 3));
  expect_mean(estimate(scene, block({4000, 4, 4000}), 20000).total(), 2 * tau * std::exp(-tau) * forward);
}

TEST(Analytic, SemiInfiniteIsotropicMedium) {
  // L/E = albedo/(4 pi) mu0/(mu0+mu) H(mu) H(mu0), seen and lit along the normal: H(1)^2 albedo / (8 pi).
  // Without absorption light comes back from far inside: that block is 4500 mean free paths deep.
  const std::pair<double, double> table[] = {
      {0.5, 0.031148}, {0.9, 0.122572}, {0.99, 0.240863}, {1, 0.336428}};
  for (const auto& [albedo, expected] : table) {
    const bool conservative = albedo == 1;
    SceneDescription scene = middle_view(1, albedo);
    scene.lights = {directional({0, -1, 0}, 1)};
    scene.render.max_scatter = 0;
    const Double3 spacing_mm = conservative ? Double3{4000, 1500, 4000} : Double3{100, 30, 100};
    expect_mean(estimate(scene, block(spacing_mm), conservative ? 6000 : 12000).total(), expected);
  }
}

TEST(Analytic, PointLightFallsOffWithTheSquareOfTheDistance) {
  // A thin slab scatters I/d^2 * tau * albedo/(4 pi) toward the eye.
  SceneDescription scene = middle_view(0.001, 1);
  scene.camera.height_mm = 0.01;
  LightDescription light;
  light.kind = LightKind::kPoint;
  light.position_mm = Double3{0, -50, 0};
  light.intensity = 1000;
  scene.lights = {light};
  scene.render.max_scatter = 1;
  const double tau = 0.001 * 0.3;
  const Moments moments = estimate(scene, block({100, 0.1, 100}), 400000).total();
  expect_mean(moments, 1000.0 / 2500.0 * tau / (4 * kPi));
}

TEST(Analytic, RectLightOnAWallOfLambertianParticles) {
  // A step in the data is a wall; BRDF only. Light that enters at cosine mu and leaves along the normal
  // passes the same matter twice: single scattering reflects albedo/pi * mu/(1 + mu) of the irradiance per
  // solid angle.
  const Volume volume = make_volume({41, 41, 41}, 1.0, [](Vec3d p) { return p.y > 0 ? 100.0 : 0.0; });
  SceneDescription scene = dark_scene(4, 4);
  scene.camera.height_mm = 0.5;
  scene.transfer.points = {point(40, 0, grey(0.5f)), point(60, 200, grey(0.5f))};
  scene.material.shading = Shading::kBrdf;
  scene.material.specular = 0;
  LightDescription light;
  light.kind = LightKind::kRect;
  light.position_mm = Double3{0, -60, 0};
  light.target_mm = Double3{0, 0, 0};
  light.up = Double3{0, 0, 1};
  light.size_mm = {60, 60};
  light.intensity = 2;
  scene.lights = {light};
  scene.render.max_scatter = 1;
  const double distance = 60.45;  // the wall begins 0.4 mm behind the origin and is 0.1 mm soft
  double expected = 0;
  constexpr int kCells = 400;
  for (int i = 0; i < kCells; ++i) {
    for (int j = 0; j < kCells; ++j) {
      const double x = 60.0 * ((i + 0.5) / kCells - 0.5), z = 60.0 * ((j + 0.5) / kCells - 0.5);
      const double d2 = x * x + z * z + distance * distance, mu = distance / std::sqrt(d2);
      expected += 2 * (0.5 / kPi) * mu * (mu / (1 + mu)) * mu / d2 * (60.0 / kCells) * (60.0 / kCells);
    }
  }
  const Moments moments = estimate(scene, volume, 20000).total();
  // 0.1 mm of 60 changes the irradiance by 0.3 %.
  EXPECT_LT(std::abs(moments.mean() - expected), 4 * moments.standard_error() + 0.003 * expected)
      << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

}  // namespace
}  // namespace voxlume::test
