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
    apply_integrator(scene);
    EXPECT_EQ(scene.render.max_scatter, 1);
    EXPECT_EQ(scene.material.shading, Shading::kExposureRender);
    EXPECT_EQ(scene.render.integrator, integrator);
    scene.material.shading = Shading::kPhase;  // which Exposure Render has as well
    apply_integrator(scene);
    EXPECT_EQ(scene.material.shading, Shading::kPhase);
  }
}

TEST(Peers, RayMarchScattersOnceByTheScenesShading) {
  SceneDescription scene = scene_of(Integrator::kRayMarch);
  SceneDescription expected = scene;
  expected.render.max_scatter = 1;
  apply_integrator(scene);
  EXPECT_EQ(scene, expected);
}

TEST(Peers, PathAndVplKeepWhatIsAsked) {
  for (const Integrator integrator : {Integrator::kPath, Integrator::kVplDvr}) {
    const SceneDescription scene = scene_of(integrator);
    SceneDescription written = scene;
    apply_integrator(written);
    EXPECT_EQ(written, scene);
  }
}

RuleDescription steps(std::vector<TransferPoint> points) {
  RuleDescription rule;
  rule.kind = RuleKind::kCoefficientSteps;
  rule.points = std::move(points);
  return rule;
}

TEST(Peers, Ar2tIsARuleByOpacityBeforeTheOthers) {
  SceneDescription scene = scene_of(Integrator::kAr2t);
  const RuleDescription own = steps({opacity_point(50, 1)});
  scene.transfer.rules = {own};
  NamedMaterialDescription metal;
  metal.name = "ar2t metal";
  metal.like = "gold";
  scene.materials = {metal};
  const SceneDescription seen = with_opacity_materials(scene);
  ASSERT_EQ(seen.transfer.rules.size(), 2u);
  EXPECT_EQ(seen.transfer.rules[1], own);
  const RuleDescription& rule = seen.transfer.rules[0];
  EXPECT_EQ(rule.volume, "opacity");
  ASSERT_EQ(rule.points.size(), 4u);
  EXPECT_EQ(rule.points[0].material, "ar2t dielectric");
  EXPECT_EQ(rule.points[3].material, "ar2t metal");
  ASSERT_EQ(seen.materials.size(), 4u);
  EXPECT_EQ(seen.materials[0], metal);
}

TEST(Peers, Ar2tLeavesTheScenesOwnRulesTheirNumbers) {
  const Volume volume = ramp();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  SceneDescription scene = scene_of(Integrator::kAr2t);
  scene.transfer.rules = {steps({opacity_point(50, 1)}), steps({opacity_point(50, 1), opacity_point(40, 1)})};
  const SceneDescription resolved = resolve(scene, volume, statistics);
  EXPECT_EQ(resolved.transfer.rules, scene.transfer.rules);
  EXPECT_EQ(resolved.render.integrator, Integrator::kAr2t);
  try {
    const CompiledScene compiled(resolved, volume, statistics);
    ADD_FAILURE() << "points that are not sorted";
  } catch (const Error& e) {
    EXPECT_THAT(e.where(), HasSubstr("/transfer/rules/1/points/1"));
  }
}

TEST(Peers, Ar2tComesAndGoesWithAnUpdate) {
  const Volume volume = ramp();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  CompiledScene compiled(resolve(scene_of(Integrator::kPath), volume, statistics), volume, statistics);
  EXPECT_EQ(compiled.view().medium.rules.rule_count, 0);
  compiled.update(resolve(scene_of(Integrator::kAr2t), volume, statistics));
  EXPECT_EQ(compiled.view().medium.rules.rule_count, 2);
  compiled.update(resolve(scene_of(Integrator::kPath), volume, statistics));
  EXPECT_EQ(compiled.view().medium.rules.rule_count, 0);
  EXPECT_FALSE(compiled.view().scattering.particles);
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

void expect_refused(const SceneDescription& scene, const char* where, const char* why) {
  try {
    with_opacity_materials(scene);
    ADD_FAILURE() << why;
  } catch (const Error& e) {
    EXPECT_EQ(e.where(), where);
    EXPECT_THAT(e.what(), HasSubstr(why));
  }
}

TEST(Peers, Ar2tIsRefusedWhereItMeansNothing) {
  SceneDescription scene = scene_of(Integrator::kAr2t);
  scene.transfer.rules.assign(16, steps({opacity_point(50, 1)}));
  expect_refused(scene, "/transfer/rules", "at most 15");
  scene.transfer.rules.pop_back();
  EXPECT_EQ(with_opacity_materials(scene).transfer.rules.size(), 16u);
  scene.transfer.merge = Merge::kProduct;
  expect_refused(scene, "/render/integrator", "priority");
  scene.transfer.points.clear();
  expect_refused(scene, "/render/integrator", "points");
}

TEST(Peers, ThatMarchAreRefusedWithOtherTrackers) {
  const Volume volume = ramp();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  for (const Integrator integrator :
       {Integrator::kExposureRender, Integrator::kRmss, Integrator::kVplDvr, Integrator::kRayMarch}) {
    SceneDescription scene = scene_of(integrator);
    scene.render.extinction = Extinction::kRgb;
    EXPECT_THROW(CompiledScene(resolve(scene, volume, statistics), volume, statistics), Error);
    scene.render.extinction = Extinction::kSingle;
    scene.render.transmittance = TransmittanceEstimator::kResidual;
    EXPECT_THROW(CompiledScene(resolve(scene, volume, statistics), volume, statistics), Error);
  }
}

TEST(Peers, ThatMarchAreRefusedWithMillionsOfSteps) {
  test::Placement place;
  place.spacing_mm = {1, 1, 1e-4};
  const Volume volume = test::make_volume<std::int16_t>(
      {21, 20, 20}, [](auto i, auto, auto) { return 20 * i; }, place);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  SceneDescription scene = scene_of(Integrator::kRayMarch);
  scene.render.march_step_voxels = 0.2;
  try {
    const CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
    ADD_FAILURE() << "29 mm in steps of 0.2e-4 mm";
  } catch (const Error& e) {
    EXPECT_EQ(e.where(), "/render/march_step_voxels");
    EXPECT_THAT(e.what(), HasSubstr("at most 1000000"));
  }
  scene.render.march_step_voxels = 0.5;
  CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
  EXPECT_TRUE(compiled.view().ray_march.on);
}

TEST(Peers, RayMarchNeedsNoListsAndLeavesPathTracingIts) {
  const Volume volume = ramp();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  SceneDescription scene = scene_of(Integrator::kRayMarch);
  scene.image.width = scene.image.height = 8;
  scene.visibility.emplace();
  ImportanceDescription important;
  important.range = {100, 200};
  scene.visibility->important = {important};
  scene.visibility->sums = ImportanceSums::kDiscrete;
  CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
  const SceneView& view = compiled.view();
  EXPECT_TRUE(view.visibility.on);
  EXPECT_EQ(view.visibility.pixels.heads, nullptr);
  EXPECT_EQ(view.visibility.weights.q_per_mm, 70);
  scene.render.integrator = Integrator::kPath;
  compiled.update(resolve(scene, volume, statistics));
  EXPECT_FALSE(view.ray_march.on);
  EXPECT_NE(view.visibility.pixels.heads, nullptr);
  EXPECT_LT(view.visibility.weights.q_per_mm, 70);
  scene.render.integrator = Integrator::kRayMarch;
  compiled.update(resolve(scene, volume, statistics));
  EXPECT_EQ(view.visibility.pixels.heads, nullptr);
}

}  // namespace
}  // namespace voxlume
