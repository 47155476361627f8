// What the path tracer does beside scattering: labels, ambient light, lenses, backgrounds, places far from
// the origin.
#include <gtest/gtest.h>

#include "integrator/scatter_point.h"
#include "render/render_loop.h"
#include "support/temporary_folder.h"
#include "test_scene.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume::test {
namespace {

Volume block() {
  return make_volume({20, 20, 20}, 2.0, [](Vec3d) { return 1.0; });
}

/// Seen along +y from outside, lit by a white environment; nearly opaque.
SceneDescription front_view(int edge_px) {
  SceneDescription scene = dark_scene(edge_px, edge_px);
  scene.camera.height_mm = 40;
  scene.transfer.points = {point(1, 5, grey(0.5f))};
  scene.environment->intensity = 1;
  scene.material.shading = Shading::kPhase;
  scene.render.max_scatter = 1;
  return scene;
}

Vec3d mean_color(const CompiledScene& scene, int x, int y, int spp) {
  Vec3d sum(0);
  TraceCounters counters;
  for (int s = 0; s < spp; ++s)
    sum += Vec3d(trace_camera_sample(scene.view(), x, y, static_cast<std::uint32_t>(s), counters).radiance);
  return sum / static_cast<double>(spp);
}

CompiledScene compile(const SceneDescription& description, const Volume& volume) {
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  return CompiledScene(resolve(description, volume, statistics), volume, statistics);
}

TEST(Features, LabelsColourWhatLiesInThemOnAnyGrid) {
  // Red left of x = 0 and green right of it, below z = 0 alone; a coarser, flipped grid of floats, as scaled
  // files have.
  const TemporaryFolder folder;
  Volume labels = make_volume({8, 9, 10}, 5.0, [](Vec3d p) { return p.z > 0   ? 0.0
                                                                    : p.x < 0 ? 1.0
                                                                              : 2.0; },
                              {-1, 0, 0, 0, 1, 0, 0, 0, -1});
  const std::string path = (folder / "labels.nrrd").string();
  write_volume(labels, path);
  write_bytes(folder / "labels.txt", "1 Left 255 0 0\n2 Right 0 255 0\n");
  SceneDescription scene = front_view(8);
  scene.labels.emplace();
  scene.labels->path = path;
  {
    const CompiledScene compiled = compile(scene, block());
    EXPECT_EQ(compiled.label_table()->names[2], "Right");
    const Vec3d red = mean_color(compiled, 1, 6, 200), green = mean_color(compiled, 6, 6, 200),
                plain = mean_color(compiled, 1, 1, 200);
    EXPECT_GT(red.x, 0.05);
    EXPECT_EQ(red.y, 0);
    EXPECT_GT(green.y, 0.05);
    EXPECT_EQ(green.x, 0);
    EXPECT_GT(plain.x, 0.05);
    EXPECT_DOUBLE_EQ(plain.x, plain.y);
  }
  scene.labels->strength = 0.5;
  const Vec3d half = mean_color(compile(scene, block()), 1, 6, 200);
  EXPECT_NEAR(half.y / half.x, 0.25 / 0.75, 1e-4);  // half of 0.5 grey against half of 0.5 and half of 1
}

TEST(Features, AFractionInALabelVolumeIsRefused) {
  const TemporaryFolder folder;
  const std::string path = (folder / "soft.nrrd").string();
  write_volume(make_volume({4, 4, 4}, 5.0, [](Vec3d p) { return p.x > 0 ? 0.5 : 1.0; }), path);
  SceneDescription scene = front_view(8);
  scene.labels.emplace();
  scene.labels->path = path;
  EXPECT_THROW(compile(scene, block()), Error);
}

TEST(Features, AmbientAddsAlbedoTimesTheMeanRadianceAtEveryScattering) {
  SceneDescription scene = front_view(4);
  scene.camera.height_mm = 4;
  scene.environment->intensity = 0.6;
  const double without = estimate(scene, block(), 4000).total().mean();
  scene.environment->ambient = true;
  const Moments with = estimate(scene, block(), 4000).total();
  // One scattering, the block is opaque: 0.5 * 0.6 more.
  EXPECT_NEAR(with.mean() - without, 0.3, 8 * with.standard_error());
}

TEST(Features, HighlightsFollowTheGradientOfTheExtinction) {
  // mu_t rises along x to 3 / mm and stays there.
  const Volume ramp = make_volume({40, 20, 20}, 2.0, [](Vec3d p) { return p.x; });
  SceneDescription scene = front_view(8);
  scene.transfer.points = {point(-30, 0, grey(0.5f)), point(0, 3, grey(0.5f)), point(40, 3, grey(0.5f))};
  scene.material.shading = Shading::kBlinnPhong;
  scene.material.highlight = 7;
  const CompiledScene compiled = compile(scene, ramp);
  const auto at = [&](float x_mm) {
    const Vec3f p_index = compiled.view().medium.grid.index_from_world.point(Vec3f(x_mm, 0, 0));
    return matter_at(compiled.view(), p_index, sample_trilinear(compiled.view().medium.grid, p_index));
  };
  const MatterPoint slope = at(-15), plateau = at(20);
  EXPECT_NEAR(slope.scatter.normal.x, -1, 1e-4);
  // 0.1 / mm^2 over 2 mm is 0.2 / mm of 3.
  EXPECT_NEAR(slope.highlight.strength, 7 * 0.2 / 3, 1e-3);
  EXPECT_EQ(slope.highlight.shininess, 40);
  EXPECT_EQ(slope.scatter.p_brdf, 0);
  EXPECT_LT(plateau.highlight.strength, 1e-3);
  // At the volume's own face it is a surface that looks outward.
  EXPECT_NEAR(at(39).scatter.normal.x, 1, 1e-3);
  EXPECT_GT(at(39).highlight.strength, 0.5);
}

TEST(Features, ALensBlursWhatIsOutOfFocusAndKeepsWhatIsInFocus) {
  const Volume ball = make_volume({40, 40, 40}, 1.0, [](Vec3d p) { return length(p) < 6 ? 1.0 : 0.0; });
  SceneDescription scene = dark_scene(32, 32);
  scene.camera.projection = Projection::kPerspective;
  scene.camera.eye_mm = Double3{0, -120, 0};
  scene.camera.target_mm = Double3{0, 0, 0};
  scene.camera.vertical_fov_deg = 16;
  scene.transfer.points = {point(0.4, 0, grey(1)), point(0.6, 20, grey(1))};
  scene.environment->intensity = 1;
  const auto corner_light = [&](double aperture_mm, double focus_mm) {
    scene.camera.aperture_radius_mm = aperture_mm;
    scene.camera.focus_mm = focus_mm;
    // 8.4 to 11.6 mm from the axis: beside the ball, whose edge is at 6.5.
    return estimate(scene, ball, 64).block(8, 5, 3).mean();
  };
  EXPECT_EQ(corner_light(0, 120), 0);
  EXPECT_EQ(corner_light(6, 120), 0);
  EXPECT_GT(corner_light(6, 60), 0.01);
}

TEST(Features, BackgroundBlurAveragesTheEnvironmentOverItsCone) {
  SceneDescription scene = dark_scene(4, 4);
  scene.transfer.points = {point(1, 0, grey(1))};
  scene.environment->intensity = 0.7;
  scene.background->kind = BackgroundKind::kEnvironment;
  scene.camera.background_blur_deg = 10;
  EXPECT_NEAR(estimate(scene, block(), 8).total().mean(), 0.7, 1e-6);
}

TEST(Features, TheSamePictureFarFromTheOrigin) {
  const Volume near =
      make_volume({24, 24, 24}, 0.05, [](Vec3d p) { return std::max(0.0, 1 - length(p) / 0.5); });
  Volume far = near;
  const Double3 offset{3e6, -2e6, 1e6};
  for (std::size_t a = 0; a < 3; ++a) far.origin_mm[a] += offset[a];
  SceneDescription scene = front_view(16);
  scene.camera.height_mm = 1.2;
  scene.transfer.points = {point(0.1, 0, grey(0.9f)), point(0.5, 60, grey(0.9f))};
  LightDescription light;
  light.kind = LightKind::kPoint;
  light.position_mm = Double3{1, -2, 1};
  light.intensity = 10;
  scene.lights = {light};
  const Estimate a = estimate(scene, near, 32);
  for (std::size_t i = 0; i < 3; ++i) (*(*scene.lights)[0].position_mm)[i] += offset[i];
  const Estimate b = estimate(scene, far, 32);
  EXPECT_GT(a.total().mean(), 0.01);
  // The offset itself is rounded to 5e-10 mm; the same paths are traced but for the rarest of decisions.
  EXPECT_NEAR(a.total().mean() / b.total().mean(), 1, 1e-3);
}

TEST(Features, TheRenderLoopGivesOneFilmForAnyThreadsTilesAndOrder) {
  const Volume volume =
      make_volume({24, 24, 24}, 2.0, [](Vec3d p) { return std::max(0.0, 1.2 - length(p) / 20); });
  SceneDescription description = dark_scene(37, 29);
  description.environment->intensity = 1;
  description.transfer.points = {point(0.1, 0, grey(0.9f)), point(0.6, 2, grey(0.9f))};
  const CompiledScene scene = compile(description, volume);
  std::vector<std::byte> first;
  for (const int threads : {1, 2, 7}) {
    for (const int tile_size : {8, 16}) {
      RenderState state{Film(37, 29, {true, true, true}), {}, 0, tile_size};
      RenderLoopOptions options;
      options.stop.spp = 5;
      options.threads = threads;
      const int tiles = static_cast<int>(make_tiles(37, 29, tile_size).size());
      for (int i = 0; i < tiles; ++i) options.tile_order.push_back(threads == 2 ? tiles - 1 - i : i);
      run_render_loop(
          state,
          [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
            render_tile(scene.view(), tile, begin, end, film, counters);
          },
          options);
      std::vector<std::byte> bytes;
      for (const auto& span : std::as_const(state.film).accumulators())
        bytes.insert(bytes.end(), span.begin(), span.end());
      if (first.empty()) first = bytes;
      EXPECT_TRUE(bytes == first) << threads << " threads, tiles of " << tile_size;
    }
  }
  EXPECT_FALSE(first.empty());
}

}  // namespace
}  // namespace voxlume::test
