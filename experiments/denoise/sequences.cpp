#include "sequences.h"

#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <span>
#include <utility>

#include "base/parallel.h"
#include "integrator/path_tracer.h"
#include "render/denoise_frame.h"
#include "render/film_image.h"
#include "scene/open_volume.h"
#include "scene/presets.h"
#include "scene/resolve.h"
#include "voxlume/error.h"

namespace voxlume::study {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vec3d center(const Volume& volume) {
  Vec3d middle;
  for (int a = 0; a < 3; ++a) middle[a] = 0.5 * static_cast<double>(volume.size[a] - 1);
  return world_from_index(volume).point(middle);
}

double radius_mm(const Volume& volume) {
  double squares = 0;
  for (int a = 0; a < 3; ++a) {
    const double edge = volume.spacing_mm[a] * static_cast<double>(volume.size[a]);
    squares += edge * edge;
  }
  return 0.5 * std::sqrt(squares);
}

/// On a circle around the volume's head-foot axis; 0 is in front of the face.
Double3 on_circle(const Dataset& data, double angle_deg, double distance, double height) {
  const Vec3d c = center(data.volume);
  const double r = data.size_mm;
  const double a = angle_deg * kDegree;
  return {c.x + r * distance * std::sin(a), c.y - r * distance * std::cos(a), c.z + r * height};
}

void orbit(SceneDescription& scene, const Dataset&, double t) { scene.camera.azimuth_deg += 120 * t; }

/// The area light on its circle.
void put_light(SceneDescription& scene, const Dataset& data, double angle_deg) {
  LightDescription& light = (*scene.lights)[0];
  const Vec3d c = center(data.volume);
  light.attached_to = Attachment::kWorld;
  light.position_mm = on_circle(data, angle_deg, 2.6, 1.2);
  light.target_mm = Double3{c.x, c.y, c.z};
}

constexpr double kLightAngle = -40;

void rotate_light(SceneDescription& scene, const Dataset& data, double t) {
  put_light(scene, data, kLightAngle + 360 * t);
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

/// Soft matter fades to half, is gone at once in the middle, and comes back slowly.
void edit_transfer(SceneDescription& scene, const Dataset& data, double t) {
  const double soft = t < 0.5 ? 1 - t : 2 * (t - 0.5);
  std::vector<TransferPoint>& points = scene.transfer.points;
  points = data.edited;
  const double lower = points.front().value, upper = points.back().value;
  for (TransferPoint& p : points) {
    if ((p.value - lower) / (upper - lower) > data.soft_share) continue;
    if (p.opacity) *p.opacity *= soft;
    if (p.mu_t_per_mm) *p.mu_t_per_mm *= soft;
  }
}

void stand_still(SceneDescription&, const Dataset&, double) {}

TransferPoint band_edge(double value, double opacity, Color color) {
  TransferPoint p;
  p.value = value;
  p.opacity = opacity;
  p.color = color;
  return p;
}

constexpr Color kSkin{{0.85f, 0.57f, 0.43f}}, kMuscle{{0.55f, 0.19f, 0.14f}}, kBone{{0.86f, 0.77f, 0.62f}};

/// Isosurfaces within one another; `peak` is the opacity of the outer ones.
std::vector<TransferPoint> narrow_bands(double peak) {
  return {band_edge(-350, 0, kSkin), band_edge(-250, peak, kSkin),       band_edge(-150, 0, kSkin),
          band_edge(40, 0, kMuscle), band_edge(70, 0.5 * peak, kMuscle), band_edge(100, 0, kMuscle),
          band_edge(180, 0, kBone),  band_edge(300, 2 * peak, kBone),    band_edge(420, 0, kBone),
          band_edge(1000, 0, kBone), band_edge(1400, 0.8, kBone),        band_edge(3000, 0.8, kBone)};
}

std::vector<TransferPoint> one_extinction() {
  std::vector<TransferPoint> points(3);
  constexpr double kStart = -300, kMuPerMm = 0.1;
  points[0].value = kStart - 1;
  points[1].value = kStart;
  points[2].value = 3100;
  for (int i = 0; i < 3; ++i) {
    points[i].mu_t_per_mm = i > 0 ? kMuPerMm : 0;
    points[i].color = Color{{0.8f, 0.9f, 0.75f}};
  }
  return points;
}

/// Which file and which transfer function.
void choose(const std::string& name, SceneDescription& scene) {
  scene.volume.path = "data/head-ct.nrrd";
  if (name == "head-ct") {
    scene.transfer.preset = "ct-bone";
  } else if (name == "mri-head") {
    scene.volume.path = "data/mri-head.nii.gz";
    scene.transfer.preset = "mri-head";
  } else if (name == "phantom") {
    scene.volume.path = "phantom";
  } else if (name == "semi-transparent") {
    scene.transfer.points = narrow_bands(0.12);
  } else if (name == "spiky") {
    scene.transfer.points = narrow_bands(0.04);
    scene.render.max_scatter = 3;
  } else if (name == "homogeneous") {
    scene.transfer.points = one_extinction();
    scene.material.shading = Shading::kPhase;
  } else {
    throw Error(ErrorCode::kBadParameter, "", "no data set \"" + name + "\"");
  }
}

/// Films of as many frames, each with other random numbers, in one go: cores wait for one another once.
std::vector<Film> render_films(SceneView view, std::span<const std::uint32_t> frames, int spp,
                               FilmLayers layers) {
  const std::vector<TileRect> tiles = make_tiles(view.width, view.height, 32);
  std::vector<Film> films;
  std::vector<SceneView> views;
  for (const std::uint32_t frame : frames) {
    films.emplace_back(view.width, view.height, layers);
    view.frame = frame;
    views.push_back(view);
  }
  parallel_for(static_cast<std::int64_t>(films.size() * tiles.size()), 1, [&](std::int64_t i) {
    const std::size_t job = static_cast<std::size_t>(i), film = job / tiles.size();
    TraceCounters counters;
    render_tile(views[film], tiles[job % tiles.size()], 0, spp, films[film], counters);
  });
  return films;
}

}  // namespace

Dataset load_dataset(const std::string& name, const std::string& environment, int width, int height) {
  Dataset data;
  data.name = name;
  SceneDescription scene;
  choose(name, scene);
  scene.image.width = width;
  scene.image.height = height;
  scene.image.filter = PixelFilter::kBox;
  scene.image.filter_radius_px = 0.5;
  scene.camera.azimuth_deg = 25;
  scene.camera.elevation_deg = 10;
  scene.camera.zoom = 1;
  data.volume = open_volume(scene.volume);
  data.statistics = compute_statistics(make_grid_view(data.volume));
  data.scene = resolve(scene, data.volume, data.statistics);
  data.size_mm = radius_mm(data.volume);
  data.scene.lights->resize(1);
  put_light(data.scene, data, kLightAngle);
  if (!environment.empty()) {
    data.scene.environment->image = environment;
    data.scene.environment->color = {};
    data.scene.environment->intensity = 1;
  }
  data.edited = data.scene.transfer.points;
  if (name == "head-ct") {
    data.edited = find_preset("ct-muscle-bone").points(data.statistics);
    data.soft_share = 0.13;  // below 156 HU
  }
  return data;
}

const std::vector<Animation>& animations() {
  static const std::vector<Animation> all{{"orbit", "camera orbit", orbit},
                                          {"area-light", "rotating area light", rotate_light},
                                          {"point-light", "moving point light, changing colour", move_point},
                                          {"transfer", "transfer-function edit", edit_transfer}};
  return all;
}

const Animation& find_animation(const std::string& name) {
  static const Animation still{"still", "nothing moves", stand_still};
  for (const Animation& a : animations()) {
    if (a.name == name) return a;
  }
  if (name == still.name) return still;
  throw Error(ErrorCode::kBadParameter, "", "no animation \"" + name + "\"");
}

void Sequence::go_to(int frame) {
  SceneDescription scene = data_.scene;
  animation_.set(scene, data_, frame / kFramesOfATurn);
  scene.render.seed = 1;
  if (scene_) {
    scene_->update(std::move(scene));
  } else {
    scene_ = std::make_unique<CompiledScene>(std::move(scene), data_.volume, data_.statistics);
  }
}

double Sequence::render(int spp, std::uint32_t seed, GradientSampler& gradients, DenoiseFrame& out) const {
  SceneView scene = view();
  scene.frame = seed;
  scene.keeps_parts = true;
  const std::array frames{seed};
  const auto begin = std::chrono::steady_clock::now();
  const Film film =
      std::move(render_films(scene, frames, spp, {.normal = true, .albedo = true, .classes = true}).front());
  const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - begin;
  fill_denoise_frame(film, scene, static_cast<float>(data_.size_mm), out);
  gradients.fill(scene, film, out);
  return took.count();
}

std::pair<Image, Image> Sequence::pictures(int spp, std::uint32_t seed) const {
  const std::array frames{seed, seed + 1};
  const std::vector<Film> films = render_films(view(), frames, spp, {});
  return {image_from_film(films[0], {}, false), image_from_film(films[1], {}, false)};
}

}  // namespace voxlume::study
