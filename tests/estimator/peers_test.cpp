// The integrators that stand for other renderers: what they must agree with, and where they must not.
#include <gtest/gtest.h>

#include "blob_scene.h"
#include "integrator/environment_guide.h"
#include "integrator/virtual_lights.h"
#include "same_mean.h"

namespace voxlume::test {
namespace {

SceneDescription lit_blobs(Integrator integrator) {
  SceneDescription scene = blob_scene();
  scene.environment->image = sky_file();
  scene.environment->intensity = 1;
  scene.render.integrator = integrator;
  return scene;
}

TEST(Peers, ExposureRenderWithShortStepsIsPathTracingOfOneScattering) {
  SceneDescription scene = lit_blobs(Integrator::kPath);
  scene.lights = {area_light(), directional({0, 0, 1}, 1)};
  scene.material.gradient_factor = 0.7;
  scene.render.max_scatter = 1;
  const Estimate path = estimate(scene, two_blobs(), 100);
  scene.render.integrator = Integrator::kExposureRender;
  scene.render.march_step_voxels = 0.1;
  scene.render.seed = 2;
  expect_same_mean(path, estimate(scene, two_blobs(), 100));
}

TEST(Peers, RmssIsExposureRenderWithLessNoise) {
  SceneDescription scene = lit_blobs(Integrator::kExposureRender);
  const Estimate uniform = estimate(scene, two_blobs(), 300);
  scene.render.integrator = Integrator::kRmss;
  scene.render.seed = 2;
  const Estimate guided = estimate(scene, two_blobs(), 300);
  expect_same_mean(uniform, guided);
  double noise_uniform = 0, noise_guided = 0;
  for (std::size_t i = 0; i < uniform.pixels.size(); ++i) {
    noise_uniform += uniform.pixels[i].variance();
    noise_guided += guided.pixels[i].variance();
  }
  EXPECT_LT(noise_guided, 0.7 * noise_uniform);
}

/// A view of a compiled scene, for tables made of it.
struct Compiled {
  explicit Compiled(const SceneDescription& scene, const Volume& volume)
      : statistics(compute_statistics(make_grid_view(volume))),
        compiled(resolve(as_tested(scene), volume, statistics), volume, statistics) {}
  const VolumeStatistics statistics;
  const CompiledScene compiled;
};

constexpr double kMu = 0.05;

/// A box of 24 x 16 x 12 mm of the same matter throughout.
Volume box() {
  return make_volume({24, 16, 12}, 1, [](Vec3d) { return 1; });
}
SceneDescription box_scene() {
  SceneDescription scene = dark_scene(8, 8);
  scene.transfer.points = {point(0, kMu, grey(0.8f)), point(1, kMu, grey(0.8f))};
  return scene;
}

TEST(Sweep, LosesWhatIsBetweenACellAndTheLight) {
  const Compiled scene(box_scene(), box());
  const CoarseMedium medium = coarse_medium(scene.compiled.view(), 12);
  ASSERT_EQ(medium.count[0], 12);
  ASSERT_EQ(medium.count[1], 8);
  ASSERT_EQ(medium.count[2], 6);
  for (const float mu_t : medium.mu_t) ASSERT_NEAR(mu_t, kMu, 1e-6);
  const std::vector<float> from_right = sweep_visibility(medium, Vec3f(1, 0, 0));
  const std::vector<float> from_below = sweep_visibility(medium, Vec3f(0, 0, -1));
  for (int i = 0; i < 12; ++i)
    EXPECT_NEAR(from_right[static_cast<std::size_t>(i + 12 * (3 + 8 * 2))], std::exp(-kMu * (23 - 2 * i)),
                1e-5);
  for (int k = 0; k < 6; ++k)
    EXPECT_NEAR(from_below[static_cast<std::size_t>(4 + 12 * (3 + 8 * k))], std::exp(-kMu * (2 * k + 1)),
                1e-5);
  // Aslant through the top, far from the sides: the way is longer by the slope.
  const Vec3f slanted = normalize(Vec3f(0.3f, 0.2f, 1));
  const std::vector<float> from_above = sweep_visibility(medium, slanted);
  for (int k = 2; k < 6; ++k)
    EXPECT_NEAR(from_above[static_cast<std::size_t>(4 + 12 * (3 + 8 * k))],
                std::exp(-kMu * (11 - 2 * k) / slanted.z), 2e-3)
        << k;
}

TEST(Sweep, KnowsNoShadowWithoutMatter) {
  SceneDescription empty = box_scene();
  empty.transfer.points = {point(0, 0, grey(1)), point(1, 0, grey(1))};
  const Compiled scene(empty, box());
  for (const float v :
       sweep_visibility(coarse_medium(scene.compiled.view(), 12), normalize(Vec3f(0.3f, -0.8f, 0.5f))))
    ASSERT_EQ(v, 1);
}

SceneDescription vpl_box(int max_scatter) {
  SceneDescription scene = box_scene();
  scene.lights = {directional({0.2, -1, 0.4}, 2)};
  scene.environment->intensity = 0.5;
  scene.render.integrator = Integrator::kVplDvr;
  scene.render.march_step_voxels = 0.5;
  scene.render.virtual_light_radius = 1e-3;
  scene.render.virtual_lights = 4096;
  scene.render.max_scatter = max_scatter;
  return scene;
}

TEST(VirtualLights, KnowTheTransmittanceToPointsAround) {
  const Compiled scene(vpl_box(2), box());
  const VirtualLightsView& view = scene.compiled.view().virtual_lights;
  ASSERT_GE(view.count, 4096);
  Rng rng(5, 0, 0, 0);
  int checked = 0;
  for (int i = 0; i < 20000; ++i) {
    const int light = static_cast<int>(rng.next() * static_cast<float>(view.count));
    const Vec3f p(20 * rng.next() - 10, 12 * rng.next() - 6, 8 * rng.next() - 4);
    const double distance_mm = length(Vec3d(p) - Vec3d(view.lights[light].matter.p_world));
    // Farther away, directions beside the right one may leave the box before it does.
    if (distance_mm > 5) continue;
    ++checked;
    ASSERT_NEAR(virtual_transmittance(view, light, p, rng.next(), rng.next()), std::exp(-kMu * distance_mm),
                2e-3);
  }
  EXPECT_GT(checked, 1000);
}

/// The mean luminance of a picture and its standard error.
Moments brightness(SceneDescription scene, Integrator integrator, int spp) {
  scene.render.integrator = integrator;
  return estimate(scene, box(), spp).total();
}

/// Every set of lights has an error of its own: the moments of the brightness over sets.
Moments brightness_over_sets(SceneDescription scene) {
  Moments out;
  for (scene.render.seed = 1; scene.render.seed <= 16; ++scene.render.seed)
    out.add(brightness(scene, Integrator::kVplDvr, 600).mean());
  return out;
}

TEST(VirtualLights, GiveTheFurtherScatterings) {
  for (const int limit : {2, 4}) {
    SceneDescription scene = vpl_box(limit);
    scene.render.virtual_lights = 1024;
    scene.render.virtual_light_radius = 0.02;
    scene.render.march_step_voxels = 1;
    const Moments path = brightness(scene, Integrator::kPath, 4000);
    const Moments vpl = brightness_over_sets(scene);
    const double error = std::hypot(path.standard_error(), vpl.standard_error());
    // What is nearer than 0.3 mm counts as that far, which loses less than mu_t times that, 1.5 per cent, of
    // light that has scattered before.
    EXPECT_LT(std::abs(vpl.mean() - path.mean()), 4 * error + 0.0075 * path.mean())
        << limit << ": " << vpl.mean() << " against " << path.mean();
    scene.render.max_scatter = 1;
    const double further = path.mean() - brightness(scene, Integrator::kPath, 4000).mean();
    EXPECT_GT(further, 0.1 * path.mean());
    EXPECT_LT(4 * error, 0.15 * further);
  }
}

TEST(VirtualLights, AreNotNeededForOneScattering) {
  const Compiled scene(vpl_box(1), box());
  EXPECT_EQ(scene.compiled.view().virtual_lights.count, 0);
  const Moments path = brightness(vpl_box(1), Integrator::kPath, 1000);
  const Moments vpl = brightness(vpl_box(1), Integrator::kVplDvr, 1000);
  EXPECT_LT(std::abs(welch_z(path, vpl)), 4);
}

TEST(VirtualLights, LoseLightWhereTheyAreHeldOff) {
  SceneDescription scene = vpl_box(2);
  const Moments near = brightness(scene, Integrator::kVplDvr, 500);
  scene.render.virtual_light_radius = 1;
  const Moments far = brightness(scene, Integrator::kVplDvr, 500);
  EXPECT_GT(welch_z(near, far), 5);
}

TEST(VirtualLights, AreTheSameForEveryFrameAndCameraAndNewForNewMatter) {
  const Volume volume = box();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  SceneDescription scene = vpl_box(2);
  scene.render.virtual_lights = 64;
  CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
  const VirtualLight* before = compiled.view().virtual_lights.lights;
  scene.render.frame = 3;
  scene.camera.azimuth_deg = 40;
  compiled.update(resolve(scene, volume, statistics));
  EXPECT_EQ(compiled.view().virtual_lights.lights, before);
  EXPECT_EQ(compiled.view().max_scatter, 1);
  const Vec3f flux = before[0].flux;
  scene.lights->front().intensity = 4;
  compiled.update(resolve(scene, volume, statistics));
  ASSERT_GE(compiled.view().virtual_lights.count, 64);
  EXPECT_NE(compiled.view().virtual_lights.lights[0].flux, flux);
  scene.render.integrator = Integrator::kPath;
  compiled.update(resolve(scene, volume, statistics));
  EXPECT_EQ(compiled.view().virtual_lights.count, 0);
  EXPECT_EQ(compiled.view().max_scatter, 2);
}

TEST(VirtualLights, AreFewWhereLightHardlyMeetsMatter) {
  SceneDescription scene = vpl_box(2);
  scene.transfer.points = {point(0, 0, grey(1)), point(1, 0, grey(1))};
  const Compiled compiled(scene, box());
  EXPECT_EQ(compiled.compiled.view().virtual_lights.count, 0);
}

}  // namespace
}  // namespace voxlume::test
