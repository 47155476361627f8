#include "sequences.h"

#include <cmath>
#include <numbers>

#include "base/parallel.h"
#include "integrator/path_tracer.h"
#include "scene/open_volume.h"
#include "scene/resolve.h"

namespace voxlume::study {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vec3d center(const Volume& volume) {
  Vec3d middle;
  for (int a = 0; a < 3; ++a) middle[a] = 0.5 * static_cast<double>(volume.size[a] - 1);
  return world_from_index(volume).point(middle);
}

float radius_mm(const Volume& volume) {
  double squares = 0;
  for (int a = 0; a < 3; ++a) {
    const double edge = volume.spacing_mm[a] * static_cast<double>(volume.size[a]);
    squares += edge * edge;
  }
  return static_cast<float>(0.5 * std::sqrt(squares));
}

/// On a circle around the volume's head-foot axis; 0 is in front of the face.
Double3 on_circle(const Dataset& data, double angle_deg, double distance, double height) {
  const Vec3d c = center(data.volume);
  const double r = data.size_mm;
  const double a = angle_deg * kDegree;
  return {c.x + r * distance * std::sin(a), c.y - r * distance * std::cos(a), c.z + r * height};
}

void orbit(SceneDescription& scene, const Dataset&, double t) { scene.camera.azimuth_deg += 120 * t; }

void rotate_light(SceneDescription& scene, const Dataset& data, double t) {
  LightDescription& light = (*scene.lights)[0];
  const Vec3d c = center(data.volume);
  light.attached_to = Attachment::kWorld;
  light.position_mm = on_circle(data, -40 + 360 * t, 2.6, 1.2);
  light.target_mm = Double3{c.x, c.y, c.z};
}

void move_point(SceneDescription& scene, const Dataset& data, double t) {
  LightDescription light;
  light.kind = LightKind::kPoint;
  light.position_mm = on_circle(data, -70 + 140 * t, 1.5, 1.2 - 1.6 * t);
  const double distance = 2 * data.size_mm;
  light.intensity = 3.0 * distance * distance;
  const auto wave = [t](double phase) {
    return static_cast<float>(0.6 + 0.4 * std::cos(2 * std::numbers::pi * (t + phase)));
  };
  light.color.linear = {wave(0), wave(1.0 / 3), wave(2.0 / 3)};
  scene.lights = {light};
}

/// Matter of low values fades to half, then is gone at once, and comes back slowly.
void edit_transfer(SceneDescription& scene, const Dataset&, double t) {
  const double soft = t < 0.5 ? 1 - t : 2 * (t - 0.5);
  std::vector<TransferPoint>& points = scene.transfer.points;
  const double lower = points.front().value, upper = points.back().value;
  for (TransferPoint& p : points) {
    const double above = (p.value - lower) / (upper - lower);
    const double factor = above > 0.55 ? 1 : soft;
    if (p.opacity) *p.opacity *= factor;
    if (p.mu_t_per_mm) *p.mu_t_per_mm *= factor;
  }
}

}  // namespace

Dataset load_dataset(const std::string& name, const std::string& path, const std::string& preset, int width,
                     int height) {
  Dataset data;
  data.name = name;
  SceneDescription scene;
  scene.volume.path = path;
  scene.transfer.preset = preset;
  scene.image.width = width;
  scene.image.height = height;
  scene.camera.azimuth_deg = 25;
  scene.camera.elevation_deg = 10;
  scene.camera.zoom = 1.5;
  scene.image.filter = PixelFilter::kBox;
  scene.image.filter_radius_px = 0.5;
  data.volume = open_volume(scene.volume);
  data.statistics = compute_statistics(make_grid_view(data.volume));
  data.scene = resolve(scene, data.volume, data.statistics);
  data.scene.lights->resize(1);
  data.size_mm = radius_mm(data.volume);
  return data;
}

const std::vector<Animation>& animations() {
  static const std::vector<Animation> all{{"orbit", "camera orbit", orbit},
                                          {"area-light", "rotating area light", rotate_light},
                                          {"point-light", "moving point light, changing colour", move_point},
                                          {"transfer", "transfer-function edit", edit_transfer}};
  return all;
}

std::unique_ptr<CompiledScene> compile_frame(const Dataset& data, const Animation& animation, double t,
                                             std::uint64_t seed) {
  SceneDescription scene = data.scene;
  animation.set(scene, data, t);
  scene.render.seed = seed;
  return std::make_unique<CompiledScene>(std::move(scene), data.volume, data.statistics);
}

Film render_frame(const CompiledScene& scene, int spp, std::uint32_t frame, bool classes) {
  SceneView view = scene.view();
  view.frame = frame;
  view.keeps_parts = classes;
  Film film(view.width, view.height, {.normal = classes, .albedo = classes, .classes = classes});
  const std::vector<TileRect> tiles = make_tiles(view.width, view.height, 16);
  parallel_for(static_cast<std::int64_t>(tiles.size()), 1, [&](std::int64_t i) {
    TraceCounters counters;
    render_tile(view, tiles[i], 0, spp, film, counters);
  });
  return film;
}

}  // namespace voxlume::study
