#include "scene/peers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scene/compile.h"
#include "scene/resolve.h"
#include "support/volumes.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::HasSubstr;

Volume ramp() {
  return test::make_volume<std::int16_t>({21, 20, 20}, [](auto i, auto, auto) { return 20 * i; });
}

TransferPoint opacity_point(double value, double opacity) {
  TransferPoint p;
  p.value = value;
  p.opacity = opacity;
  return p;
}

SceneDescription scene_of(Integrator integrator) {
  SceneDescription scene;
  scene.render.integrator = integrator;
  scene.render.max_scatter = 5;
  scene.transfer.points = {opacity_point(0, 0), opacity_point(100, 0.9)};
  return scene;
}

TEST(Peers, ExposureRenderAndRmssScatterOnceByItsShading) {
  for (const Integrator integrator : {Integrator::kExposureRender, Integrator::kRmss}) {
    SceneDescription scene = scene_of(integrator);
    write_out_integrator(scene);
    EXPECT_EQ(scene.render.max_scatter, 1);
    EXPECT_EQ(scene.material.shading, Shading::kExposureRender);
    EXPECT_EQ(scene.render.integrator, integrator);
    scene.material.shading = Shading::kPhase;  // which Exposure Render has as well
    write_out_integrator(scene);
    EXPECT_EQ(scene.material.shading, Shading::kPhase);
  }
}

TEST(Peers, PathAndVplKeepWhatIsAsked) {
  for (const Integrator integrator : {Integrator::kPath, Integrator::kVplDvr}) {
    const SceneDescription scene = scene_of(integrator);
    SceneDescription written = scene;
    write_out_integrator(written);
    EXPECT_EQ(written, scene);
  }
}

TEST(Peers, Ar2tIsARuleByOpacityBeforeTheOthers) {
  SceneDescription scene = scene_of(Integrator::kAr2t);
  RuleDescription own;
  own.kind = RuleKind::kCoefficientSteps;
  own.points = {opacity_point(50, 1)};
  scene.transfer.rules = {own};
  write_out_integrator(scene);
  EXPECT_EQ(scene.render.integrator, Integrator::kPath);
  ASSERT_EQ(scene.transfer.rules.size(), 2u);
  EXPECT_EQ(scene.transfer.rules[1], own);
  const RuleDescription& rule = scene.transfer.rules[0];
  EXPECT_EQ(rule.volume, "opacity");
  ASSERT_EQ(rule.points.size(), 4u);
  EXPECT_EQ(rule.points[0].material, "ar2t dielectric");
  EXPECT_EQ(rule.points[3].material, "ar2t metal");
  EXPECT_EQ(scene.materials.size(), 4u);
  const SceneDescription once = scene;
  write_out_integrator(scene);
  EXPECT_EQ(scene, once);
}

TEST(Peers, Ar2tGivesMatterOfHighOpacityTheMetal) {
  const Volume volume = ramp();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  SceneDescription scene = scene_of(Integrator::kAr2t);
  scene.transfer.points = {opacity_point(0, 0.05),  opacity_point(100, 0.05), opacity_point(100, 0.2),
                           opacity_point(200, 0.2), opacity_point(200, 0.5),  opacity_point(300, 0.5),
                           opacity_point(300, 0.9)};
  const CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
  const SceneView& view = compiled.view();
  EXPECT_TRUE(view.scattering.particles);
  const char* expected[] = {"dielectric", "matte", "glossy", "metal"};
  const float values[] = {50, 150, 250, 350};
  for (int i = 0; i < 4; ++i) {
    const Classified matter = classify(view.medium.rules, Vec3f(10), values[i]);
    EXPECT_EQ(view.scattering.materials[matter.material + 1].metallic, i == 3 ? 1.0f : 0.0f) << expected[i];
    EXPECT_EQ(view.scattering.materials[matter.material + 1].transmission, i == 0 ? 1.0f : 0.0f)
        << expected[i];
  }
}

void expect_refused(const SceneDescription& scene, const char* why) {
  SceneDescription copy = scene;
  try {
    write_out_integrator(copy);
    ADD_FAILURE() << why;
  } catch (const Error& e) {
    EXPECT_EQ(e.where(), "/render/integrator");
    EXPECT_THAT(e.what(), HasSubstr(why));
  }
}

TEST(Peers, Ar2tIsRefusedWhereItMeansNothing) {
  SceneDescription scene = scene_of(Integrator::kAr2t);
  scene.transfer.rules.resize(1);
  scene.transfer.merge = Merge::kProduct;
  expect_refused(scene, "priority");
  scene.transfer.points.clear();
  expect_refused(scene, "points");
}

TEST(Peers, ThatMarchAreRefusedWithOtherTrackers) {
  const Volume volume = ramp();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  for (const Integrator integrator : {Integrator::kExposureRender, Integrator::kRmss, Integrator::kVplDvr}) {
    SceneDescription scene = scene_of(integrator);
    scene.render.extinction = Extinction::kRgb;
    EXPECT_THROW(CompiledScene(resolve(scene, volume, statistics), volume, statistics), Error);
    scene.render.extinction = Extinction::kSingle;
    scene.render.transmittance = TransmittanceEstimator::kResidual;
    EXPECT_THROW(CompiledScene(resolve(scene, volume, statistics), volume, statistics), Error);
  }
}

}  // namespace
}  // namespace voxlume
