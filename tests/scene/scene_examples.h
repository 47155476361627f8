#pragma once
#include "voxlume/scene.h"

namespace voxlume {

/// A valid scene in which every field differs from its default, save those with one value only.
inline SceneDescription full_scene() {
  SceneDescription s;
  s.volume = {"data/ct.raw", "4x4x4,u8,1,1,1", Double3{0.5, 0.25, 1.0 / 3.0}, Double3{-1, 0, 12.5},
              std::array<double, 9>{0, 1, 0, -1, 0, 0, 0, 0, 1}};
  s.transfer.preset = "ct-bone";
  s.transfer.reference_length_mm = 0.957;
  s.transfer.density_scale = 2.5;
  s.transfer.points = {{-100.5, 0.0, {}, Color{{0.1f, 0.2f, 0.3f}}, {}},
                       {150, 0.7, {}, {}, Color{{0, 12.5f, 0}}},
                       {150, 1.0, {}, Color{{1.0f / 3.0f, 1, 0}}, {}}};
  TransferPoint varied{7, 0.5, {}, {}, {}, 0.25, 0.75, 0.125, -0.5, 0.375, Color{{0.5f, 0.25f, 1}}, "shell"};
  s.transfer.rules = {
      {RuleKind::kMaterialSteps, "pet", {varied}, {}, ColumnForm::kSteps, {}},
      {RuleKind::kCoefficientPoints, "atlas", {}, "gradient", ColumnForm::kPoints, {{-2.5, {varied}}}}};
  s.transfer.merge = Merge::kProduct;
  s.transfer.smooth_labels = false;
  s.proxies = {
      {"pet", ProxyKind::kSmoothed, "pet.nrrd", "atlas", 2.5, {3, 70000}, Lookup::kNearest, Outline::kVoxels},
      {"atlas", ProxyKind::kFile, "atlas.nii", "data", 1, {}, Lookup::kNearest, Outline::kVoxels}};
  s.materials = {{"shell",
                  "glass",
                  0.5,
                  {},
                  Color{{0.5f, 0.25f, 1}},
                  Color{{0, 2, 3}},
                  0.1,
                  0.2,
                  0.3,
                  -0.4,
                  0.5,
                  0.6,
                  1.75,
                  0.7,
                  -0.8,
                  0.9,
                  Color{{1, 0.5f, 0}}},
                 {"thin", "", {}, 0.25, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}, {}}};
  s.illustration = IllustrationDescription{
      {{0, 0.5, {}, Color{{0, 0, 1}}, {}}}, {0, 0, 2}, Attachment::kWorld, 0.25, 0.5, Color{{1, 0, 0}}};
  s.labels = LabelsDescription{"labels.nii.gz", "labels.txt", 0.75};
  s.material = {Shading::kBrdf,
                SurfaceShareForm::kThreshold,
                0.7,
                false,
                -0.3,
                0.9,
                0.1,
                2,
                10,
                LobeModel::kParticles,
                0.5};
  LightDescription sun, lamp, panel;
  sun.direction = Double3{-0.5, 0.6, 0.75};
  sun.color = Color{{1, 0.9f, 0.8f}};
  sun.intensity = 9;
  lamp.kind = LightKind::kPoint;
  lamp.position_mm = Double3{1, 2, 3};
  panel.kind = LightKind::kRect;
  panel.attached_to = Attachment::kCamera;
  panel.position_mm = Double3{100, 200, 300};
  panel.target_mm = Double3{0, 1, 0};
  panel.up = Double3{0, 0, 1};
  panel.size_mm = {30, 40};
  panel.two_sided = true;
  s.lights = {sun, lamp, panel};
  s.environment = EnvironmentDescription{"sky.exr", Color{{0.5f, 0.5f, 1}}, 2, 45, Attachment::kCamera, true};
  s.background = BackgroundDescription{BackgroundKind::kEnvironment, Color{{0.25f, 0, 0}}};
  s.camera = {Projection::kOrthographic, 30,    -10, 5,     1.5, 28,   Double3{1, 2, 3}, Double3{4, 5, 6},
              Double3{0, 1, 0},          200.0, 0.5, 300.0, 3,   175.0};
  s.clip = ClipDescription{{-10, 1e30}, {-1e30, 20}, {0, 5}, true};
  s.image = {640, 480, 16, 2.5, 0.01, PixelFilter::kBox, 0.5, 1.25, ToneCurve::kSrgb, {"depth", "albedo"}};
  ImportanceDescription important;
  important.importance = 0.75;
  important.volume = "data";
  important.range = std::array<double, 2>{300, 1e12};
  important.along = "steep";
  important.along_range = std::array<double, 2>{0.5, 40};
  important.center_mm = Double3{1, 2, 3};
  important.radius_mm = 20;
  ImportanceDescription box;
  box.center_mm = Double3{0, 0, 0};
  box.size_mm = Double3{10, 20, 30};
  s.visibility = VisibilityDescription{{important, box},         2,   50, 20, 0.5,
                                       VisibilityLights::kAll,   100, 32, 8,  ImportanceLookup::kPerVoxel,
                                       ImportanceSums::kDiscrete};
  s.render.integrator = Integrator::kVplDvr;
  s.render.march_step_voxels = 1.5;
  s.render.march_jitter = false;
  s.render.virtual_lights = 64;
  s.render.virtual_light_radius = 0.1;
  s.render.seed = 18446744073709551615ull;
  s.render.frame = 7;
  s.render.max_scatter = 100;
  s.render.accelerator = "macrocell";
  s.render.macrocell_voxels = 8;
  s.render.hierarchy_rule = "thresholds";
  s.render.lookup_cost = 4;
  s.render.hierarchy_thresholds = {0.25, 2};
  s.render.sampler = Sampler::kRandom;
  s.render.light_samples = 2;
  s.render.transmittance = TransmittanceEstimator::kMarching;
  s.render.free_flight = FreeFlightSampling::kDecomposition;
  s.render.extinction = Extinction::kRgb;
  s.render.shadow_roulette = 0.25;
  s.render.simd = "scalar";
  s.render.denoise = "svgf";
  s.render.light_sampling = "light";
  const auto dim = s.transfer.points, bright = std::vector<TransferPoint>{dim.begin(), dim.begin() + 1};
  s.animation = AnimationDescription{
      25,
      100,
      TurntableDescription{4, -1.5},
      {{"/camera/zoom", Interpolation::kSmooth, {{0, 1.0}, {2.5, 1.0 / 3.0}}},
       {"/lights/0/color", Interpolation::kLinear, {{0, "#ff8000"}, {1, Color{{2, 0.1f, 0}}}}},
       {"/lights/1/position_mm", Interpolation::kLinear, {{-1, std::vector<double>{1, 2, 3.5}}}},
       {"/clip/blocks_light", Interpolation::kStep, {{0, true}, {0, false}}},
       {"/transfer/points", Interpolation::kLinear, {{0, dim}, {3, bright}}}}};
  return s;
}

}  // namespace voxlume
