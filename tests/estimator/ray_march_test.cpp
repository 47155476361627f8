// Ray marching, plain and where what hides the important fades: against closed forms, and against path
// tracing.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "blob_scene.h"
#include "compiled_scene.h"
#include "integrator/path_tracer.h"
#include "marched_alpha.h"
#include "same_mean.h"

namespace voxlume::test {
namespace {

/// Rays through the pixels' centres, in even steps.
SceneDescription marched(SceneDescription scene, double step_voxels) {
  scene.render.integrator = Integrator::kRayMarch;
  scene.render.march_step_voxels = step_voxels;
  scene.render.march_jitter = false;
  scene.image.filter_radius_px = 1e-9;
  return scene;
}

/// The blobs, thin enough to see through.
SceneDescription thin_blobs() {
  SceneDescription scene = blob_scene();
  scene.transfer.density_scale = 0.05;
  return scene;
}

SceneDescription faded_blobs(double importance, double step_voxels, ImportanceSums sums) {
  SceneDescription scene = marched(thin_blobs(), step_voxels);
  scene.visibility.emplace();
  ImportanceDescription important;
  important.importance = importance;
  important.range = {60, 1000};
  scene.visibility->important = {important};
  scene.visibility->sums = sums;
  return scene;
}

constexpr double kMu = 0.05;

/// A box of 24 x 16 x 12 mm of the same matter throughout, seen along its 16 mm.
Volume box() {
  return make_volume({24, 16, 12}, 1, [](Vec3d) { return 1; });
}
SceneDescription box_scene(Color albedo, Color emission) {
  SceneDescription scene = dark_scene(8, 8);
  scene.transfer.points = {point(0, kMu, albedo, emission), point(1, kMu, albedo, emission)};
  return scene;
}

TEST(RayMarch, EvenMatterIsInClosedForm) {
  SceneDescription scene = box_scene(grey(0.8f), {{0.5f, 0.2f, 0.1f}});
  scene.background->color = grey(0.3f);
  for (const double step : {1.0, 0.37, 0.01}) {
    const Compiled compiled(marched(scene, step), box());
    const PixelSample s = compiled.sample(4, 4);
    // As many steps as have their middle in the box.
    const double through = std::exp(-kMu * step * std::round(16 / step));
    EXPECT_NEAR(s.alpha, 1 - through, 1e-6);
    EXPECT_NEAR(s.radiance.x, 0.5 * (1 - through) + 0.3 * through, 1e-6);
    EXPECT_NEAR(s.radiance.z, 0.1 * (1 - through) + 0.3 * through, 1e-6);
    EXPECT_NEAR(s.albedo.y, 0.8, 1e-6);
  }
  EXPECT_EQ(Compiled(marched(scene, 1), box()).sample(0, 0).alpha, 0) << "beside the box";
}

TEST(RayMarch, ShorterStepsComeNearerToTheIntegral) {
  const Compiled exact(marched(thin_blobs(), 1), two_blobs());
  double before = 0;
  for (const double step : {2.0, 1.0, 0.5, 0.25}) {
    const Compiled compiled(marched(thin_blobs(), step), two_blobs());
    double error = 0;
    int pixels = 0;
    for (int y = 8; y < 26; y += 3)
      for (int x = 5; x < 28; x += 3) {
        const double alpha = marched_alpha(exact.view(), x, y);
        if (alpha < 0.02) continue;
        error += std::abs(compiled.sample(x, y).alpha - alpha);
        ++pixels;
      }
    ASSERT_GT(pixels, 15);
    if (before > 0) {
      EXPECT_LT(error, before / 1.7) << step;
    }
    before = error;
    if (step == 0.25) {
      EXPECT_LT(error / pixels, 1e-3);
    }
  }
}

TEST(RayMarch, IntegralsConvergeToWhatPathTracingFades) {
  for (const double importance : {1.0, 0.75}) {
    SceneDescription scene = faded_blobs(importance, 0.01, ImportanceSums::kIntegral);
    const Compiled fine(scene, two_blobs());
    scene.render.march_step_voxels = 1;
    const Compiled coarse(scene, two_blobs());
    SceneDescription plain = scene;
    plain.visibility.reset();
    const Compiled unfaded(plain, two_blobs());
    double fine_error = 0, coarse_error = 0, faded = 0;
    int pixels = 0;
    for (int y = 10; y < 24; y += 2)
      for (int x = 6; x < 26; x += 2) {
        const double expected = marched_alpha(fine.view(), x, y);
        if (expected < 0.02) continue;
        const double error = std::abs(fine.sample(x, y).alpha - expected);
        EXPECT_LT(error, 2e-3) << x << ',' << y;
        fine_error += error;
        coarse_error += std::abs(coarse.sample(x, y).alpha - expected);
        faded = std::max(faded, unfaded.sample(x, y).alpha - expected);
        ++pixels;
      }
    ASSERT_GT(pixels, 20);
    EXPECT_GT(faded, 0.1);
    EXPECT_LT(fine_error, coarse_error / 10);
  }
}

/// The greatest alpha of a few pixels whose rays meet what is important.
double important_alpha(const SceneDescription& scene) {
  const Compiled compiled(scene, two_blobs());
  std::vector<ImportanceSegment> segments;
  double most = 0;
  int rays = 0;
  for (int y = 8; y < 24; y += 3)
    for (int x = 6; x < 26; x += 2) {
      if (!(find_importance(compiled.view(), x, y, {48, 1}, segments).total > 5)) continue;
      most = std::max(most, static_cast<double>(compiled.sample(x, y).alpha));
      ++rays;
    }
  EXPECT_GE(rays, 5);
  return most;
}

/// lerzer2025 Fig. 2: what is important but for a tenth vanishes as steps get shorter.
TEST(RayMarch, SumsOverStepsDependOnTheStep) {
  std::vector<double> sums, integrals;
  for (const double step : {1.0, 0.1, 0.01, 0.001}) {
    sums.push_back(important_alpha(faded_blobs(0.9, step, ImportanceSums::kDiscrete)));
    integrals.push_back(important_alpha(faded_blobs(0.9, step, ImportanceSums::kIntegral)));
  }
  for (std::size_t i = 1; i < sums.size(); ++i) {
    EXPECT_LT(sums[i], 0.5 * sums[i - 1]) << i;
    EXPECT_NEAR(integrals[i], integrals[0], 0.03) << i;
  }
  EXPECT_LT(sums.back(), 0.02);
  EXPECT_GT(integrals.back(), 0.3);
  // With importance 1 there is nothing to lose.
  const double whole = important_alpha(faded_blobs(1, 0.01, ImportanceSums::kDiscrete));
  EXPECT_GT(whole, 0.3);
}

/// Eq. 4, with numbers by hand: three steps of importance g, the middle one of the box.
TEST(RayMarch, FadesAStepByTheOthersAlone) {
  for (const ImportanceSums sums : {ImportanceSums::kDiscrete, ImportanceSums::kIntegral}) {
    SceneDescription scene = marched(box_scene(grey(0.8f), grey(0)), 4);
    scene.visibility.emplace();
    ImportanceDescription half;
    half.importance = 0.5;
    half.center_mm = Double3{0, 0, 0};
    half.size_mm = Double3{100, 8, 100};  // the middle two of four steps
    scene.visibility->important = {half};
    scene.visibility->q = 7;
    scene.visibility->r = 3;
    scene.visibility->sums = sums;
    const Compiled compiled(scene, box());
    // Integrals are in halves of 24 mm.
    const double unit = sums == ImportanceSums::kDiscrete ? 1 : 4.0 / 12;
    const double q = 7 * unit * 0.25, r = 3 * unit * 0.25;
    const double depth = 4 * kMu *
                         (1 / (1 + 2 * q) + 1 / (1 + 0.25 * q) +  // (1 - 0.5)^2
                          1 / (1 + 0.25 * r) + 1 / (1 + 2 * r));
    EXPECT_NEAR(compiled.sample(4, 4).alpha, 1 - std::exp(-depth), 1e-6);
  }
}

/// Steps at 2, 6, 10 and 14 mm of 15, lit from behind: what is important at 8 mm alone is met by shadow rays,
/// or lies behind the point that they light.
TEST(RayMarch, FreesLightRaysSeenFromTheLight) {
  const Volume deep = make_volume({24, 15, 12}, 1, [](Vec3d) { return 1; });
  for (const bool frees : {false, true}) {
    SceneDescription scene = marched(box_scene(grey(0.8f), grey(0)), 4);
    scene.lights = {directional({0, 1, 0}, 2)};
    scene.material.shading = Shading::kPhase;
    scene.material.self_occlusion = 0.5;
    scene.visibility.emplace();
    ImportanceDescription middle;
    middle.center_mm = Double3{0, 0.5, 0};
    middle.size_mm = Double3{100, 2, 100};
    scene.visibility->important = {middle};
    scene.visibility->q = 7;
    scene.visibility->r = 3;
    scene.visibility->sums = ImportanceSums::kDiscrete;
    scene.visibility->lights = frees ? VisibilityLights::kFirst : VisibilityLights::kOff;
    // Seen from the light, 12 mm is before it and 4 mm behind.
    const double before = frees ? 1.0 / 8 : 1, behind = frees ? 1.0 / 4 : 1;
    const double depths[] = {before + 1 + behind, before + 1, before, 0};
    double expected = 0;
    for (int i = 0; i < 4; ++i)
      expected += std::exp(-4 * kMu * i) * (1 - std::exp(-4 * kMu)) * std::exp(-0.5 * 4 * kMu * depths[i]);
    expected *= 2 * 0.8 / (4 * std::numbers::pi);
    EXPECT_NEAR(Compiled(scene, deep).sample(4, 4).radiance.y, expected, 1e-6) << frees;
  }
}

SceneDescription lit_blobs() {
  SceneDescription scene = blob_scene();
  scene.lights = {directional({0.3, -1, 0.6}, 2)};
  scene.material.gradient_factor = 0.7;
  scene.render.max_scatter = 1;
  return scene;
}

/// The scene by path tracing with one scattering, and marched in short steps.
void expect_path_traced(SceneDescription scene, int path_spp = 100, int spp = 8, double step = 0.1) {
  scene.render.max_scatter = 1;
  scene.render.integrator = Integrator::kPath;
  const Estimate path = estimate(scene, two_blobs(), path_spp);
  scene.render.integrator = Integrator::kRayMarch;
  scene.render.march_step_voxels = step;
  scene.render.seed = 2;
  expect_same_mean(path, estimate(scene, two_blobs(), spp));
}

TEST(RayMarch, IsPathTracingOfOneScattering) { expect_path_traced(lit_blobs()); }

TEST(RayMarch, TakesEveryLight) {
  SceneDescription scene = lit_blobs();
  LightDescription lamp;
  lamp.kind = LightKind::kPoint;
  lamp.position_mm = Double3{10, -60, 20};
  lamp.intensity = 4000;
  scene.lights->push_back(lamp);
  scene.lights->push_back(area_light());
  scene.environment->image = sky_file();
  scene.environment->intensity = 1;
  scene.environment->ambient = true;
  scene.background->kind = BackgroundKind::kEnvironment;
  scene.material.self_occlusion = 0.5;
  scene.transfer.points[2].emission = {{0.2f, 0.1f, 0}};
  expect_path_traced(scene);
}

TEST(RayMarch, ShadesAsTheSceneSays) {
  SceneDescription scene = lit_blobs();
  scene.material.shading = Shading::kExposureRender;
  expect_path_traced(scene);
  scene.material.shading = Shading::kBlinnPhong;
  scene.material.lobes = LobeModel::kReciprocal;
  expect_path_traced(scene);
  scene.material.shading = Shading::kCoexistence;
  scene.material.lobes = LobeModel::kParticles;
  expect_path_traced(scene);
  scene.illustration.emplace();
  expect_path_traced(scene);
}

TEST(RayMarch, FreesEyeAndLightsAsPathTracingDoes) {
  for (const VisibilityLights lights : {VisibilityLights::kOff, VisibilityLights::kFirst}) {
    SceneDescription scene = lit_blobs();
    scene.transfer.density_scale = 0.2;
    scene.visibility.emplace();
    ImportanceDescription important;
    important.range = {60, 1000};
    scene.visibility->important = {important};
    scene.visibility->lights = lights;
    scene.visibility->ray_passes = 64;
    scene.visibility->light_samples = 2000;
    // Path tracing has one list a pixel, of the ray through its centre.
    scene.image.filter_radius_px = 1e-3;
    expect_path_traced(scene, lights == VisibilityLights::kOff ? 100 : 40, 8, 0.1);
  }
}

TEST(RayMarch, GivesLayersAsPathTracingDoes) {
  SceneDescription scene = thin_blobs();
  scene.render.max_scatter = 1;
  const Compiled path(scene, two_blobs());
  const Compiled march(marched(scene, 0.1), two_blobs());
  constexpr int kSamples = 20000;
  for (const int x : {10, 16, 21}) {
    std::vector<PixelSample> samples(kSamples);
    SceneView view = path.view();
    view.filter_radius_px = 1e-9f;
    TraceCounters counters;
    trace_tile(view, {x, 15, x + 1, 16}, 0, kSamples, samples, {}, counters);
    Moments alpha, depth, normal, albedo;
    for (const PixelSample& s : samples) {
      alpha.add(s.alpha);
      if (!(s.alpha > 0)) continue;
      depth.add(s.depth_mm);
      normal.add(s.normal.y);
      albedo.add(s.albedo.z);
    }
    const PixelSample one = march.sample(x, 15);
    EXPECT_NEAR(one.alpha, alpha.mean(), 4 * alpha.standard_error());
    EXPECT_NEAR(one.depth_mm, depth.mean(), 4 * depth.standard_error());
    EXPECT_NEAR(one.normal.y, normal.mean(), 4 * normal.standard_error());
    EXPECT_NEAR(one.albedo.z, albedo.mean(), 4 * albedo.standard_error());
  }
}

TEST(RayMarch, IsNotRandomWithoutJitter) {
  SceneDescription scene = marched(lit_blobs(), 1);
  scene.lights->push_back(directional({-0.5, -0.2, 1}, 1));
  const auto row = [&](std::uint64_t seed) {
    scene.render.seed = seed;
    const Compiled compiled(scene, two_blobs());
    TraceCounters counters;
    return row_luminances(compiled.view(), 0, 32, 15, 2, counters);
  };
  const std::vector<double> one = row(1);
  ASSERT_GT(*std::max_element(one.begin(), one.end()), 0.01);
  EXPECT_EQ(one, row(2));
  for (std::size_t i = 0; i < one.size(); i += 2) EXPECT_EQ(one[i], one[i + 1]) << "sample by sample";
  scene.render.march_jitter = true;
  EXPECT_NE(one, row(1));
  EXPECT_NE(row(1), row(2));
}

/// Steps of any offset see all of the ray: coarse ones miss little in the mean.
TEST(RayMarch, JitterHasTheMeanOfShortSteps) {
  SceneDescription scene = marched(thin_blobs(), 1);
  scene.render.march_jitter = true;
  const Compiled jittered(scene, two_blobs());
  const Compiled fine(marched(thin_blobs(), 0.02), two_blobs());
  double spread = 0;
  for (int x = 6; x < 26; x += 2) {
    Moments alpha;
    for (std::uint32_t i = 0; i < 1000; ++i) alpha.add(jittered.sample(x, 15, i).alpha);
    // The mean of exp(-depth) is above exp of the mean by half the variance, relative to it.
    const double through = 1 - alpha.mean(), bend = 0.5 * alpha.variance() / through;
    EXPECT_NEAR(alpha.mean(), fine.sample(x, 15).alpha, 4.5 * alpha.standard_error() + 1.5 * bend + 1e-6);
    spread = std::max(spread, std::sqrt(alpha.variance()));
  }
  EXPECT_GT(spread, 1e-3);
}

TEST(RayMarch, PartsMakeUpTheRadiance) {
  SceneDescription scene = lit_blobs();
  scene.transfer.density_scale = 0.1;
  scene.environment->intensity = 0.5;
  scene.background->color = grey(0.4f);
  scene.render.integrator = Integrator::kRayMarch;
  scene.render.march_step_voxels = 0.5;
  const Compiled compiled(scene, two_blobs());
  SceneView view = compiled.view();
  view.keeps_parts = true;
  int between = 0;
  for (int y = 0; y < 32; y += 3)
    for (int x = 0; x < 32; ++x) {
      TraceCounters counters;
      RadianceParts p;
      const PixelSample s = trace_camera_sample(view, x, y, 0, counters, &p);
      EXPECT_EQ(s.radiance, compiled.sample(x, y).radiance);
      const Vec3f sum = p.direct_diffuse + p.direct_specular + p.later + p.behind;
      if (s.alpha > 0) {
        ASSERT_LE(max_component(max(sum - s.radiance, s.radiance - sum)), 1e-5f * max_component(s.radiance));
        EXPECT_NEAR(p.behind.x, 0.4 * (1 - s.alpha), 1e-6);
        EXPECT_GE(min_component(p.fx_diffuse), 0);
        EXPECT_LE(luminance(p.later), 1e-5f + 1e-4f * luminance(s.radiance));
      } else {
        EXPECT_EQ(sum, Vec3f(0));
      }
      between += s.alpha > 0.1 && s.alpha < 0.9;
    }
  EXPECT_GT(between, 20);
}

}  // namespace
}  // namespace voxlume::test
