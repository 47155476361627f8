#pragma once
#include "test_scene.h"

namespace voxlume::test {

inline constexpr SimdTarget kTargets[] = {SimdTarget::kSse4, SimdTarget::kAvx2, SimdTarget::kAvx512,
                                          SimdTarget::kNeon};

/// A rough ball.
inline Volume bumps() {
  return make_volume({26, 24, 22}, 1.5, [](Vec3d p) {
    return 1.3 - length(p) / 14 + 0.25 * std::sin(1.1 * p.x) * std::cos(0.9 * p.y + 0.5 * p.z);
  });
}

inline SceneDescription base_scene() {
  SceneDescription scene = dark_scene(23, 19);
  scene.camera.projection = Projection::kPerspective;
  scene.environment->intensity = 0.7;
  scene.lights = {directional({-0.4, -1, 0.5}, 2)};
  LightDescription area;
  area.kind = LightKind::kRect;
  area.position_mm = Double3{20, -60, 30};
  area.target_mm = Double3{0, 0, 0};
  area.size_mm = {20, 30};
  area.intensity = 5;
  scene.lights->push_back(area);
  scene.transfer.points = {point(0.2, 0, grey(0.9f)), point(0.5, 0.4, grey(0.7f), grey(0.01f)),
                           point(0.9, 6, {{0.9f, 0.5f, 0.3f}})};
  return scene;
}

/// A way to render base_scene().
struct Mode {
  const char* name;
  void (*set)(SceneDescription&);
};

inline const Mode kModes[] = {
    {"coexistence", [](SceneDescription&) {}},
    {"exposure render", [](SceneDescription& s) { s.material.shading = Shading::kExposureRender; }},
    {"phase", [](SceneDescription& s) { s.material.shading = Shading::kPhase; }},
    {"brdf", [](SceneDescription& s) { s.material.shading = Shading::kBrdf; }},
    {"no limit", [](SceneDescription& s) { s.render.max_scatter = 0; }},
    {"one scattering", [](SceneDescription& s) { s.render.max_scatter = 1; }},
    {"light sampling", [](SceneDescription& s) { s.render.light_sampling = "light"; }},
    {"direction sampling", [](SceneDescription& s) { s.render.light_sampling = "direction"; }},
    {"sobol", [](SceneDescription& s) { s.render.sampler = Sampler::kSobol; }},
    {"sobol, three light samples",
     [](SceneDescription& s) {
       s.render.sampler = Sampler::kSobol;
       s.render.light_samples = 3;
     }},
    {"lens",
     [](SceneDescription& s) {
       s.render.sampler = Sampler::kSobol;
       s.camera.aperture_radius_mm = 2;
     }},
    {"orthographic", [](SceneDescription& s) { s.camera.projection = Projection::kOrthographic; }},
    {"gaussian filter",
     [](SceneDescription& s) {
       s.image.filter = PixelFilter::kGaussian;
       s.image.filter_radius_px = 1.5;
     }},
    {"clip",
     [](SceneDescription& s) {
       s.clip = ClipDescription{{-9, 7}, {-12, 30}, {-30, 8}};
     }},
    {"clip that blocks light",
     [](SceneDescription& s) {
       s.clip = ClipDescription{{-9, 7}, {-12, 30}, {-30, 8}};
       s.clip->blocks_light = true;
     }},
    {"cells of 1", [](SceneDescription& s) { s.render.macrocell_voxels = 1; }},
    {"cells of 5", [](SceneDescription& s) { s.render.macrocell_voxels = 5; }},
};

inline std::unique_ptr<CompiledScene> compile(SceneDescription description, const Volume& volume,
                                              SimdTarget target) {
  description.render.simd = simd_name(target);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  return std::make_unique<CompiledScene>(resolve(description, volume, statistics), volume, statistics);
}

}  // namespace voxlume::test
