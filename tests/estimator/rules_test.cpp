// Pictures under transfer functions of several volumes.
#include <gtest/gtest.h>

#include "simd_modes.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume::test {
namespace {

struct Traced {
  std::vector<PixelSample> samples;
  std::vector<RadianceParts> parts;
  TraceCounters counters;
};

Traced trace(const CompiledScene& scene, int spp) {
  SceneView view = scene.view();
  view.keeps_parts = true;
  const TileRect tile{0, 0, view.width, view.height};
  Traced out;
  out.samples.resize(static_cast<std::size_t>(tile.pixel_count()) * spp);
  out.parts.resize(out.samples.size());
  trace_tile(view, tile, 3, 3 + spp, out.samples, out.parts, out.counters);
  return out;
}

bool same(const RadianceParts& a, const RadianceParts& b) {
  return a.fx_diffuse == b.fx_diffuse && a.fx_specular == b.fx_specular &&
         a.direct_diffuse == b.direct_diffuse && a.direct_specular == b.direct_specular &&
         a.later == b.later && a.dense == b.dense;
}

std::size_t differing(const Traced& x, const Traced& y) {
  std::size_t count = x.samples.size() != y.samples.size();
  for (std::size_t i = 0; i < std::min(x.samples.size(), y.samples.size()); ++i) {
    const PixelSample &a = x.samples[i], &b = y.samples[i];
    count += !(a.radiance == b.radiance && a.alpha == b.alpha && a.albedo == b.albedo &&
               a.normal == b.normal && a.depth_mm == b.depth_mm && same(x.parts[i], y.parts[i]));
  }
  return count;
}

double total(const Traced& traced) {
  double sum = 0;
  for (const PixelSample& s : traced.samples) sum += luminance(s.radiance);
  return sum;
}

class Rules : public testing::Test {
 protected:
  void SetUp() override {
    // Octants of the rough ball, on a coarser grid that leaves some of it out.
    Volume organs = make_volume({12, 12, 12}, 2.5, [](Vec3d p) {
      return p.x > 0 && p.z > 0 ? 3 : p.x < 0 && p.y < 3 ? 1 : 0;
    });
    write_volume(organs, folder_ / "organs.nrrd");
  }

  ProxyDescription organs() const {
    ProxyDescription out;
    out.name = "organs";
    out.path = folder_ / "organs.nrrd";
    out.lookup = Lookup::kNearest;
    return out;
  }
  static ProxyDescription derived(const std::string& name, ProxyKind kind) {
    ProxyDescription out;
    out.name = name;
    out.kind = kind;
    out.sigma_mm = 2;
    return out;
  }
  static RuleDescription rule(RuleKind kind, const std::string& volume, std::vector<TransferPoint> points) {
    RuleDescription out;
    out.kind = kind;
    out.volume = volume;
    out.points = std::move(points);
    return out;
  }
  static TransferPoint of_material(double value, const std::string& material, double mu_t_per_mm) {
    TransferPoint out;
    out.value = value;
    out.material = material;
    out.mu_t_per_mm = mu_t_per_mm;
    return out;
  }

  SceneDescription labels_over_curve() const {
    SceneDescription scene = base_scene();
    scene.proxies = {organs()};
    scene.transfer.rules = {
        rule(RuleKind::kMaterialPoints, "organs", {of_material(1, "bone", 0.5), of_material(3, "gold", 2)})};
    return scene;
  }
  SceneDescription glass_and_metal() const {
    SceneDescription scene = base_scene();
    scene.transfer.rules = {rule(RuleKind::kMaterialSteps, "opacity",
                                 {of_material(0.1, "glass", 0.3), of_material(0.6, "metal", 5)})};
    return scene;
  }
  SceneDescription two_dimensional() const {
    SceneDescription scene = base_scene();
    scene.proxies = {derived("gradient", ProxyKind::kGradient), derived("smooth", ProxyKind::kSmoothed)};
    RuleDescription steep;
    steep.volume = "smooth";
    steep.along = "gradient";
    steep.columns = {{0, {point(0.2, 0.3, grey(0.9f))}}, {0.1, {point(0.2, 1, grey(0.5f))}}};
    scene.transfer.merge = Merge::kProduct;
    scene.transfer.rules = {steep};
    return scene;
  }
  SceneDescription fused() const {
    SceneDescription scene = labels_over_curve();
    scene.proxies.push_back(derived("smooth", ProxyKind::kSmoothed));
    scene.transfer.merge = Merge::kMaximum;
    scene.transfer.rules.push_back(
        rule(RuleKind::kCoefficientCurve, "smooth", {point(0, 0, grey(0.5f)), point(1, 2, grey(0.2f))}));
    scene.transfer.smooth_labels = false;
    return scene;
  }

  TemporaryFolder folder_;
};

TEST_F(Rules, EveryInstructionSetIsTheScalarPicture) {
  const Volume volume = bumps();
  struct Case {
    const char* name;
    SceneDescription scene;
  };
  int compared = 0;
  for (const Case& c : {Case{"labels", labels_over_curve()}, Case{"glass and metal", glass_and_metal()},
                        Case{"two dimensional", two_dimensional()}, Case{"fused", fused()}})
    for (const double self_occlusion : {1.0, 0.3})
      for (const LobeModel lobes : {LobeModel::kAuto, LobeModel::kReciprocal})
        for (const int max_scatter : {2, 0}) {
          SceneDescription scene = c.scene;
          scene.material.self_occlusion = self_occlusion;
          scene.material.lobes = lobes;
          scene.render.max_scatter = max_scatter;
          const Traced expected = trace(*compile(scene, volume, SimdTarget::kScalar), 4);
          EXPECT_GT(total(expected), 1) << c.name;
          EXPECT_EQ(expected.counters.majorant_violations, 0u) << c.name;
          for (const SimdTarget target : kTargets) {
            if (!has_simd_target(target)) continue;
            const auto compiled = compile(scene, volume, target);
            ASSERT_EQ(compiled->view().simd, target);
            const Traced traced = trace(*compiled, 4);
            EXPECT_EQ(traced.counters, expected.counters) << c.name << ", " << simd_name(target);
            EXPECT_EQ(differing(traced, expected), 0u) << c.name << ", " << simd_name(target);
            ++compared;
          }
        }
  if (compared == 0) GTEST_SKIP() << "this machine has no vector target";
}

TEST_F(Rules, SelfOcclusionIsTheScalarPictureWithoutRules) {
  const Volume volume = bumps();
  SceneDescription scene = base_scene();
  scene.material.self_occlusion = 0.3;
  const Traced expected = trace(*compile(scene, volume, SimdTarget::kScalar), 4);
  for (const SimdTarget target : kTargets) {
    if (!has_simd_target(target)) continue;
    const Traced traced = trace(*compile(scene, volume, target), 4);
    EXPECT_EQ(traced.counters, expected.counters) << simd_name(target);
    EXPECT_EQ(differing(traced, expected), 0u) << simd_name(target);
  }
  // More light arrives; one is what a scene has that does not say.
  SceneDescription plain = base_scene(), one = base_scene();
  plain.render.light_sampling = one.render.light_sampling = "light";
  one.material.self_occlusion = 1;
  const Traced without = trace(*compile(plain, volume, SimdTarget::kScalar), 4);
  EXPECT_EQ(differing(trace(*compile(one, volume, SimdTarget::kScalar), 4), without), 0u);
  EXPECT_GT(total(expected), 1.05 * total(without));
}

TEST_F(Rules, ARuleOfTheSameCurveGivesTheSamePicture) {
  const Volume volume = bumps();
  for (const Mode& mode : kModes) {
    SceneDescription plain = base_scene();
    mode.set(plain);
    plain.material.lobes = LobeModel::kReciprocal;
    SceneDescription ruled = plain;
    ruled.transfer.rules = {rule(RuleKind::kCoefficientCurve, "data", plain.transfer.points)};
    SceneDescription alone = ruled;
    alone.transfer.points.clear();
    for (const SimdTarget target : {SimdTarget::kScalar, best_simd_target()}) {
      const Traced expected = trace(*compile(plain, volume, target), 4);
      for (const SceneDescription& scene : {ruled, alone}) {
        const Traced traced = trace(*compile(scene, volume, target), 4);
        EXPECT_EQ(traced.counters, expected.counters) << mode.name;
        EXPECT_EQ(differing(traced, expected), 0u) << mode.name << ", " << simd_name(target);
      }
    }
  }
}

TEST_F(Rules, UpdatesGiveThePicturesOfNewScenes) {
  const Volume volume = bumps();
  SceneDescription wider = labels_over_curve();
  wider.proxies.push_back(derived("smooth", ProxyKind::kSmoothed));
  wider.transfer.rules.push_back(
      rule(RuleKind::kCoefficientCurve, "smooth", {point(0, 0, grey(0.5f)), point(1, 2, grey(0.2f))}));
  SceneDescription gold = labels_over_curve();
  gold.materials.resize(1);
  gold.materials[0].name = "gold";
  gold.materials[0].color = Color{{0.1f, 0.9f, 0.2f}};
  SceneDescription cells = wider;
  cells.render.macrocell_voxels = 3;
  const std::vector<SceneDescription> course{
      base_scene(),      labels_over_curve(), wider,   gold,  glass_and_metal(),
      two_dimensional(), base_scene(),        fused(), cells, base_scene()};
  const auto scene = compile(base_scene(), volume, SimdTarget::kScalar);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  for (std::size_t n = 0; n < course.size(); ++n) {
    SceneDescription next = course[n];
    next.render.simd = "scalar";
    scene->update(resolve(next, volume, statistics));
    const Traced updated = trace(*scene, 3), fresh = trace(*compile(next, volume, SimdTarget::kScalar), 3);
    EXPECT_EQ(differing(updated, fresh), 0u) << "step " << n;
    EXPECT_EQ(updated.counters, fresh.counters) << "step " << n;
  }
}

TEST_F(Rules, WhatDoesNotGoWithThemIsRefused) {
  const Volume volume = bumps();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const auto expect_refused = [&](const SceneDescription& first, SceneDescription next,
                                  const std::string& where) {
    const auto scene = compile(first, volume, SimdTarget::kScalar);
    const Traced before = trace(*scene, 1);
    for (const bool updated : {false, true}) {
      try {
        next.render.simd = "scalar";
        if (updated)
          scene->update(resolve(next, volume, statistics));
        else
          compile(next, volume, SimdTarget::kScalar);
        ADD_FAILURE() << "accepted, expected an error at " << where << (updated ? ", update" : "");
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
        EXPECT_EQ(error.where(), where);
      }
    }
    // The scene is what it was.
    EXPECT_EQ(differing(trace(*scene, 1), before), 0u);
  };
  SceneDescription scene = labels_over_curve();
  scene.render.accelerator = "octree";
  expect_refused(labels_over_curve(), scene, "/render/accelerator");
  scene = labels_over_curve();
  scene.render.transmittance = TransmittanceEstimator::kResidual;
  expect_refused(labels_over_curve(), scene, "/render/transmittance");
  SceneDescription occluded = base_scene();
  occluded.material.self_occlusion = 0.5;
  scene = occluded;
  scene.render.free_flight = FreeFlightSampling::kDecomposition;
  expect_refused(occluded, scene, "/material/self_occlusion");
}

TEST_F(Rules, DenseMatterIsThatOfTheVolume) {
  // A curve that goes on beyond the data does not decide what counts as dense.
  const Volume volume = bumps();
  SceneDescription plain = base_scene();
  plain.transfer.points.push_back(point(50, 1000, grey(1)));
  SceneDescription ruled = plain;
  ruled.transfer.rules = {rule(RuleKind::kCoefficientCurve, "data", plain.transfer.points)};
  EXPECT_EQ(compile(ruled, volume, SimdTarget::kScalar)->view().dense_mu_t,
            compile(plain, volume, SimdTarget::kScalar)->view().dense_mu_t);
}

}  // namespace
}  // namespace voxlume::test
