// The parts that a sample's radiance is made of, for denoisers.
#include <gtest/gtest.h>

#include "test_scene.h"

namespace voxlume::test {
namespace {

Volume ball() {
  return make_volume({24, 24, 24}, 1.5, [](Vec3d p) { return 1.4 - length(p) / 14; });
}

SceneDescription lit_scene(int max_scatter) {
  SceneDescription scene = dark_scene(24, 24);
  scene.environment->intensity = 0.7;
  LightDescription area;
  area.kind = LightKind::kRect;
  area.position_mm = Double3{20, -60, 30};
  area.target_mm = Double3{0, 0, 0};
  area.size_mm = {20, 30};
  area.intensity = 5;
  scene.lights = {area};
  scene.transfer.points = {point(0.2, 0, grey(0.9f)), point(0.9, 3, {{0.9f, 0.5f, 0.3f}})};
  scene.render.max_scatter = max_scatter;
  return scene;
}

struct Traced {
  std::vector<PixelSample> samples;
  std::vector<RadianceParts> parts;
};

Traced trace(const SceneDescription& description, int spp) {
  const Volume volume = ball();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const CompiledScene scene(resolve(as_tested(description), volume, statistics), volume, statistics);
  SceneView view = scene.view();
  view.keeps_parts = true;
  const TileRect tile{0, 0, view.width, view.height};
  Traced out;
  out.samples.resize(static_cast<std::size_t>(tile.pixel_count()) * spp);
  out.parts.resize(out.samples.size());
  TraceCounters counters;
  trace_tile(view, tile, 0, spp, out.samples, out.parts, counters);

  view.keeps_parts = false;
  std::vector<PixelSample> plain(out.samples.size());
  trace_tile(view, tile, 0, spp, plain, {}, counters);
  std::size_t differing = 0;
  for (std::size_t i = 0; i < plain.size(); ++i) differing += plain[i].radiance != out.samples[i].radiance;
  EXPECT_EQ(differing, 0u) << "keeping parts changes nothing";
  return out;
}

Vec3f composed(const RadianceParts& p) { return p.direct_diffuse + p.direct_specular + p.later; }

struct PartsMode {
  const char* name;
  void (*set)(SceneDescription&);
};

const PartsMode kModes[] = {
    {"coexistence", [](SceneDescription&) {}},
    {"exposure render", [](SceneDescription& s) { s.material.shading = Shading::kExposureRender; }},
    {"light", [](SceneDescription& s) { s.render.light_sampling = "light"; }},
    {"direction", [](SceneDescription& s) { s.render.light_sampling = "direction"; }},
    {"three light samples", [](SceneDescription& s) { s.render.light_samples = 3; }},
    {"roulette of shadow rays", [](SceneDescription& s) { s.render.shadow_roulette = 1; }},
    {"glossy", [](SceneDescription& s) { s.material.roughness = 0.1; }},
};

TEST(Parts, MakeUpTheRadianceOfEverySample) {
  for (const PartsMode& mode : kModes) {
    for (const int max_scatter : {1, 2, 0}) {
      SceneDescription scene = lit_scene(max_scatter);
      mode.set(scene);
      const Traced traced = trace(scene, 8);
      double later = 0, all = 0;
      for (std::size_t i = 0; i < traced.samples.size(); ++i) {
        const PixelSample& s = traced.samples[i];
        const RadianceParts& p = traced.parts[i];
        if (s.alpha == 0) {
          ASSERT_EQ(composed(p), Vec3f(0));
          continue;
        }
        const float size = max_component(s.radiance);
        ASSERT_LE(max_component(max(composed(p) - s.radiance, s.radiance - composed(p))),
                  1e-5f * size + 1e-7f)
            << mode.name << ", " << max_scatter << " scatterings";
        later += luminance(p.later);
        all += luminance(s.radiance);
      }
      ASSERT_GT(all, 0);
      if (max_scatter == 1)
        EXPECT_LE(later, 1e-5 * all) << mode.name << ": all the light is that of the first scattering";
      else
        EXPECT_GT(later, 0.02 * all) << mode.name;
    }
  }
}

TEST(Parts, FxIsTheShadingWithoutShadows) {
  SceneDescription scene = lit_scene(1);
  scene.material.shading = Shading::kPhase;
  const Traced all_around = trace(scene, 4);
  scene.environment->intensity = 0;
  const Traced phase = trace(scene, 4);
  double with_environment = 0, without = 0;
  for (std::size_t i = 0; i < phase.samples.size(); ++i) {
    if (phase.samples[i].alpha == 0) continue;
    const Vec3f expected = phase.samples[i].albedo * 0.25f;  // pi / (4 pi) of a light in one direction
    for (int c = 0; c < 3; ++c) ASSERT_NEAR(phase.parts[i].fx_diffuse[c], expected[c], 1e-4f * expected[c]);
    ASSERT_EQ(phase.parts[i].fx_specular, Vec3f(0));
    without += phase.parts[i].fx_diffuse.x;
    with_environment += all_around.parts[i].fx_diffuse.x;
  }
  EXPECT_GT(with_environment, 1.2 * without) << "all of the light that comes from all around is scattered";

  scene.material.shading = Shading::kBrdf;
  scene.material.specular = 0;
  const Traced lambert = trace(scene, 4);
  const Vec3f to_light = normalize(Vec3f(20, -60, 30));  // nearly, from everywhere in the ball
  for (std::size_t i = 0; i < lambert.samples.size(); ++i) {
    const PixelSample& s = lambert.samples[i];
    if (s.alpha == 0 || s.normal == Vec3f(0)) continue;
    const float share = lambert.parts[i].fx_diffuse.x / s.albedo.x;
    const float cosine = dot(s.normal, to_light), to_eye = -s.normal.y;
    ASSERT_NEAR(share, cosine * to_eye > 0 ? std::abs(cosine) : 0.0f, 0.3f) << "as the light is seen";
  }
}

/// What shadows take is in the direct light alone: fx is the same in front of the light and behind the ball.
TEST(Parts, DirectLightIsShadowedAndFxIsNot) {
  SceneDescription scene = lit_scene(1);
  scene.material.shading = Shading::kPhase;
  scene.environment->intensity = 0;
  const auto ratio_of = [](const Traced& traced) {
    double direct = 0, fx = 0;
    for (const RadianceParts& p : traced.parts) direct += p.direct_diffuse.x, fx += p.fx_diffuse.x;
    return direct / fx;
  };
  const double lit = ratio_of(trace(scene, 16));
  (*scene.lights)[0].position_mm = Double3{20, 60, 30};  // behind what the camera sees
  const double behind = ratio_of(trace(scene, 16));
  EXPECT_LT(behind, 0.3 * lit);
}

/// In the ball's middle everything is dense, and nothing is where it fades into air.
TEST(Parts, DenseIsWhereTheExtinctionIsAQuarterOfTheGreatest) {
  SceneDescription scene = lit_scene(1);
  std::size_t dense = 0, hits = 0;
  for (const float top : {3.0f, 30.0f}) {
    // Extinction 3 / mm up to 0.99, and at 30 a thin core from there on.
    scene.transfer.points = {point(0.2, 0, grey(0.9f)), point(0.21, 3, grey(0.9f)),
                             point(0.99, 3, grey(0.9f)), point(1.3, top, grey(0.9f))};
    const Traced traced = trace(scene, 8);
    dense = hits = 0;
    for (std::size_t i = 0; i < traced.samples.size(); ++i) {
      hits += traced.samples[i].alpha > 0;
      dense += traced.parts[i].dense;
    }
    ASSERT_GT(hits, 500u);
    if (top == 3.0f) {
      EXPECT_GT(dense, hits * 9 / 10);
    }
  }
  EXPECT_LT(dense, hits / 10) << "the core is out of reach behind 3 / mm";
}

}  // namespace
}  // namespace voxlume::test
