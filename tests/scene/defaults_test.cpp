// What is chosen when the user says nothing: presets, lights, camera target.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>

#include "denoise/denoiser.h"
#include "grid/phantom.h"
#include "image_io/image_io.h"
#include "integrator/path_tracer.h"
#include "scene/compile.h"
#include "scene/presets.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::HasSubstr;

VolumeStatistics statistics_of(std::vector<std::pair<float, std::uint64_t>> histogram) {
  VolumeStatistics s;
  s.lower = histogram.front().first;
  s.upper = histogram.back().first;
  s.histogram = std::move(histogram);
  return s;
}

Volume tiny(std::string modality, std::string format) {
  Volume volume;
  volume.size = {100, 200, 50};
  volume.spacing_mm = {1, 1, 2};
  volume.modality = std::move(modality);
  volume.format = std::move(format);
  return volume;
}

TEST(Presets, EveryOneCompilesOnAnyData) {
  const VolumeStatistics ct = statistics_of({{-1024, 500}, {40, 300}, {900, 50}, {2000, 3}});
  const VolumeStatistics constant = statistics_of({{7, 100}});
  const VolumeStatistics empty = [] {
    VolumeStatistics s;
    return s;
  }();
  ASSERT_GE(presets().size(), 5u);
  for (const VolumeStatistics& s : {ct, constant, empty}) {
    for (const Preset& preset : presets()) {
      TransferDescription transfer;
      transfer.points = preset.points(s);
      transfer.reference_length_mm = 1;
      const TransferFunction compiled(transfer);
      EXPECT_GT(compiled.max_mu_t(), 0) << preset.name;
      // What is drawn as opacity must stay below the clamp, or the densest matter all looks alike.
      for (const TransferPoint& p : transfer.points) EXPECT_LE(*p.opacity, 0.9999) << preset.name;
    }
  }
}

TEST(Presets, TheOnesPromisedAreThere) {
  for (const char* name : {"ct-bone", "ct-skin", "ct-muscle-bone", "mri-head", "fog"})
    EXPECT_EQ(find_preset(name).name, name);
}

TEST(Presets, AnUnknownNameGetsTheNearestOne) {
  try {
    find_preset("ct-bones");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
    EXPECT_THAT(error.what(), HasSubstr("did you mean \"ct-bone\""));
  }
}

TEST(Presets, AreChosenFromTheData) {
  const VolumeStatistics ct = statistics_of({{-1024, 500}, {40, 300}, {2000, 3}});
  const VolumeStatistics bytes = statistics_of({{0, 500}, {100, 300}, {255, 3}});
  EXPECT_EQ(automatic_preset(tiny("CT", "DICOM series"), bytes).name, "ct-bone");
  EXPECT_EQ(automatic_preset(tiny("", "NRRD"), ct).name, "ct-bone");
  EXPECT_EQ(automatic_preset(tiny("", "NIfTI"), ct).name, "ct-bone");
  EXPECT_EQ(automatic_preset(tiny("MR", "NRRD"), bytes).name, "mri-head");
  EXPECT_EQ(automatic_preset(tiny("", "NIfTI"), bytes).name, "mri-head");
  EXPECT_EQ(automatic_preset(tiny("", "TIFF"), bytes).name, "generic");
}

TEST(Presets, ReferenceLengthIsAMillimetreForCtAndAShareOfTheVolumeElsewhere) {
  const VolumeStatistics ct = statistics_of({{-1024, 500}, {40, 300}, {2000, 3}});
  const VolumeStatistics bytes = statistics_of({{0, 500}, {100, 300}, {255, 3}});
  EXPECT_EQ(default_reference_length_mm(tiny("CT", ""), bytes), 1);
  EXPECT_EQ(default_reference_length_mm(tiny("", ""), ct), 1);
  EXPECT_EQ(default_reference_length_mm(tiny("", ""), bytes), 200.0 / 256);
}

TEST(Presets, OtsuSeparatesTwoClasses) {
  EXPECT_EQ(otsu_threshold(statistics_of({{0, 100}, {1, 100}, {2, 100}, {50, 30}, {51, 30}})), 2);
}

TEST(Resolve, KeepsWhatIsGivenAndFillsTheRest) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene;
  scene.transfer.preset = "ct-skin";
  scene.lights.emplace();
  scene.camera.azimuth_deg = 33;
  const SceneDescription out = resolve(scene, phantom, statistics);
  EXPECT_EQ(out.transfer.preset, "ct-skin");
  EXPECT_FALSE(out.transfer.points.empty());
  EXPECT_EQ(*out.transfer.reference_length_mm, 1);
  EXPECT_TRUE(out.lights->empty());
  EXPECT_TRUE(out.environment && out.background && out.camera.target_mm && out.image.spp);
  EXPECT_EQ(out.camera.azimuth_deg, 33);
  EXPECT_EQ(resolve(out, phantom, statistics), out);
}

TEST(Resolve, ASavedSceneDescribesTheSamePicture) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene;
  scene.volume.path = "phantom";
  const SceneDescription out = resolve(scene, phantom, statistics);
  EXPECT_EQ(parse_scene(write_scene(out), "saved.json"), out);
}

TEST(Resolve, RefusesAClipBoxThatKeepsNothing) {
  const Volume phantom = make_head_phantom();
  SceneDescription scene;
  scene.clip.emplace();
  scene.clip->x_mm = {5000, 6000};
  EXPECT_THROW(resolve(scene, phantom, compute_statistics(make_grid_view(phantom))), Error);
}

TEST(Compile, RefusesExtinctionThatNoRayGetsThrough) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene = resolve({}, phantom, statistics);
  scene.transfer.density_scale = 1e6;
  try {
    const CompiledScene compiled(scene, phantom, statistics);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
    EXPECT_THAT(error.what(), HasSubstr("/transfer"));
  }
}

TEST(SceneFields, EveryDenoiserCanBeNamed) {
  SceneDescription scene;
  std::string known = "none";
  for (const DenoiserKind& kind : denoiser_kinds()) {
    set_scene_field(scene, "/render/denoise", std::string(kind.name), "");
    EXPECT_EQ(scene.render.denoise, kind.name);
    known += ", " + std::string(kind.name);
  }
  try {
    set_scene_field(scene, "/render/denoise", "blur", "");
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("expected one of " + known));
  }
}

TEST(Compile, EstimatorsWithMinimaTakeMacrocellsAndScalarCode) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene = resolve({}, phantom, statistics);
  scene.render.transmittance = TransmittanceEstimator::kResidual;
  const CompiledScene residual(scene, phantom, statistics);
  EXPECT_EQ(residual.view().simd, SimdTarget::kScalar);
  EXPECT_EQ(residual.view().medium.accelerator.kind, AcceleratorKind::kMacrocell);
  EXPECT_NE(residual.view().medium.accelerator.macrocell.mu_min, nullptr);
  scene.render.accelerator = "hierarchy";
  try {
    const CompiledScene compiled(scene, phantom, statistics);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    EXPECT_THAT(error.what(), HasSubstr("/render/accelerator"));
  }
  scene.render.transmittance = TransmittanceEstimator::kRatio;
  EXPECT_EQ(CompiledScene(scene, phantom, statistics).view().medium.accelerator.kind,
            AcceleratorKind::kHierarchy);
}

/// What rays see of two scenes: majorants and extinction along lines, lights, camera.
void expect_same_view(const SceneView& a, const SceneView& b) {
  EXPECT_EQ(a.camera.eye_mm.x, b.camera.eye_mm.x);
  EXPECT_EQ(a.camera.half_width, b.camera.half_width);
  EXPECT_EQ(a.lights.light_count, b.lights.light_count);
  EXPECT_EQ(a.lights.environment.axis_x.y, b.lights.environment.axis_x.y);
  EXPECT_EQ(a.clip_world.lower.x, b.clip_world.lower.x);
  EXPECT_EQ(a.scattering.g, b.scattering.g);
  EXPECT_EQ(a.dense_mu_t, b.dense_mu_t);
  EXPECT_EQ(a.frame, b.frame);
  EXPECT_EQ(a.medium.accelerator.kind, b.medium.accelerator.kind);
  Film of_a(24, 24, {}), of_b(24, 24, {});
  TraceCounters counters_a, counters_b;
  render_tile(a, {0, 0, 24, 24}, 0, 4, of_a, counters_a);
  render_tile(b, {0, 0, 24, 24}, 0, 4, of_b, counters_b);
  EXPECT_EQ(counters_a.tracking_steps, counters_b.tracking_steps);
  for (int i = 0; i < 24 * 24; ++i)
    EXPECT_EQ(Vec3f(of_a.mean(i % 24, i / 24)).x, Vec3f(of_b.mean(i % 24, i / 24)).x);
}

TEST(Compile, AnUpdatedSceneIsTheSceneCompiledAnew) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene = resolve({}, phantom, statistics);
  scene.image.width = scene.image.height = 24;
  CompiledScene updated(scene, phantom, statistics);
  const auto change = [&](auto edit) {
    edit(scene);
    updated.update(scene);
    expect_same_view(updated.view(), CompiledScene(scene, phantom, statistics).view());
    EXPECT_EQ(updated.description(), scene);
  };
  change([](SceneDescription& s) { s.camera.azimuth_deg = 40; });
  change([](SceneDescription& s) { s.lights->pop_back(); });
  change([](SceneDescription& s) { s.environment->rotation_deg = 20; });
  change([](SceneDescription& s) { s.environment->intensity = 2; });
  change([](SceneDescription& s) {
    s.clip = ClipDescription{{-1e30, 20}, {-1e30, 1e30}, {-1e30, 1e30}, true};
  });
  change([](SceneDescription& s) { s.clip.reset(); });
  change([](SceneDescription& s) { s.transfer.points = {{0, 0.0, {}, {}, {}}, {900, 0.3, {}, {}, {}}}; });
  change([](SceneDescription& s) { s.transfer.density_scale = 0.2; });
  change([](SceneDescription& s) { s.material.anisotropy = 0.5; });
  change([](SceneDescription& s) { s.render.accelerator = "octree"; });
  change([](SceneDescription& s) { s.render.frame = 9; });
  const float eye = updated.view().camera.eye_mm.x;
  SceneDescription wrong = scene;
  wrong.camera.azimuth_deg = -70;
  wrong.lights->at(0).position_mm = wrong.lights->at(0).target_mm = Double3{0, 0, 0};
  EXPECT_THROW(updated.update(wrong), Error);
  EXPECT_EQ(updated.view().camera.eye_mm.x, eye);
  EXPECT_EQ(updated.description(), scene);
}

TEST(Compile, AnUpdateKeepsTheTablesOfTheEnvironmentsPicture) {
  const auto path =
      std::filesystem::temp_directory_path() / ("voxlume-sky-" + std::to_string(::getpid()) + ".exr");
  Image sky(8, 4);
  for (std::size_t i = 0; i < sky.rgba.size(); ++i) sky.rgba[i] = static_cast<float>(i % 7) * 0.3f;
  write_exr(sky, path);
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene = resolve({}, phantom, statistics);
  scene.image.width = scene.image.height = 24;
  scene.environment->image = path.string();
  CompiledScene updated(scene, phantom, statistics);
  const Vec3f* const texels = updated.view().lights.environment.texels;
  const auto change = [&](auto edit) {
    edit(scene);
    updated.update(scene);
    expect_same_view(updated.view(), CompiledScene(scene, phantom, statistics).view());
  };
  change([](SceneDescription& s) { s.environment->rotation_deg = 70; });
  change([](SceneDescription& s) { s.environment->attached_to = Attachment::kCamera; });
  change([](SceneDescription& s) { s.camera.elevation_deg = 60; });
  change([](SceneDescription& s) { s.environment->intensity = 0.1; });
  change([](SceneDescription& s) { s.environment->color = Color{{1, 0.5f, 0.2f}}; });
  change([](SceneDescription& s) { s.render.light_sampling = "light"; });
  EXPECT_EQ(updated.view().lights.environment.texels, texels);
  change([](SceneDescription& s) { s.environment->image.clear(); });
  std::filesystem::remove(path);
}

TEST(Compile, AnUpdateReadsTheEnvironmentsPictureWhenItsFileIsAnother) {
  const auto path =
      std::filesystem::temp_directory_path() / ("voxlume-dusk-" + std::to_string(::getpid()) + ".exr");
  const auto write = [&](float value) {
    Image sky(8, 4);
    std::fill(sky.rgba.begin(), sky.rgba.end(), value);
    write_exr(sky, path);
  };
  write(1);
  const auto time = std::filesystem::last_write_time(path);
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  SceneDescription scene = resolve({}, phantom, statistics);
  scene.environment->image = path.string();
  scene.environment->color = Color{{1, 1, 1}};
  CompiledScene compiled(scene, phantom, statistics);
  const auto mean_at = [&](double intensity) {
    scene.environment->intensity = intensity;
    compiled.update(scene);
    return compiled.view().lights.environment_mean.x;
  };
  write(5);
  std::filesystem::last_write_time(path, time);
  EXPECT_FLOAT_EQ(mean_at(2), 2);  // not read: nothing tells that it is another
  std::filesystem::last_write_time(path, time + std::chrono::seconds(1));
  EXPECT_FLOAT_EQ(mean_at(3), 15);
  std::filesystem::remove(path);
  EXPECT_FLOAT_EQ(mean_at(4), 20);
  scene.environment->image.clear();
  EXPECT_FLOAT_EQ(mean_at(4), 4);
}

TEST(Resolve, TheFramingStaysWhileAClipBoxMoves) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  const SceneDescription whole = resolve({}, phantom, statistics);
  SceneDescription cut = whole;
  cut.clip.emplace();
  cut.clip->z_mm = {-20, 20};
  const CameraView a = CompiledScene(whole, phantom, statistics).view().camera;
  const CameraView b = CompiledScene(resolve(cut, phantom, statistics), phantom, statistics).view().camera;
  EXPECT_EQ(a.eye_mm.y, b.eye_mm.y);
  SceneDescription cut_at_once;
  cut_at_once.clip = cut.clip;
  EXPECT_LT(*resolve(cut_at_once, phantom, statistics).camera.fit_radius_mm, *whole.camera.fit_radius_mm);
}

}  // namespace
}  // namespace voxlume
