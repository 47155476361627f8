// Measures what keeping the important in view costs: pictures without it, with the camera's rays and with
// first light rays too, in interleaved rounds; seconds and megabytes of the lists, and look-ups of importance
// with and without cells. Times are processor time of all threads: what other programs take does not count.
// A picture's time is that of its lists and of its samples, whose time grows evenly. What is important are
// values from 300 on of a CT, or labels of a file. Prints JSON. Usage:
// voxlume_visibility_speed VOLUME [ROUNDS [SIZE [FILE=A,B,...]]]
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/parallel.h"
#include "camera/camera.h"
#include "measure.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;
using Json = nlohmann::ordered_json;

constexpr int kSpp = 8;

SceneDescription bone_scene(int size, int max_scatter) {
  SceneDescription scene;
  scene.transfer.preset = "ct-bone";
  scene.image.width = scene.image.height = size;
  scene.render.max_scatter = max_scatter;
  scene.visibility.emplace();
  scene.visibility->important.emplace_back().range = {300, 1e6};
  return scene;
}

/// Without anything important, the volumes that only that names are not read either.
SceneDescription with(const SceneDescription& scene, bool visibility, VisibilityLights lights) {
  SceneDescription out = scene;
  if (visibility) {
    out.visibility->lights = lights;
  } else {
    out.visibility.reset();
    out.proxies.clear();
  }
  return out;
}

struct Looks {
  double with_cells_ns = 0, without_ns = 0, known_share = 0;
};

/// Looks at points along the rays of some pixels, on one thread.
Looks time_looks(const SceneView& scene) {
  std::vector<Vec3f> points;
  const ImportanceView& view = scene.visibility.importance;
  Rng rng(1, 0, 0, 0);
  for (int y = 0; y < scene.height; y += 7)
    for (int x = 0; x < scene.width; x += 7) {
      const CameraRay eye =
          camera_ray(scene.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f, 0.5f);
      const TrackRay ray = visible_part(scene, to_index_ray(scene.medium.grid, eye.origin, eye.direction),
                                        eye.origin, eye.direction, 1e30f, true);
      for (int i = 0; i < 48 && ray.t_near < ray.t_far; ++i) {
        const float t = ray.t_near + (ray.t_far - ray.t_near) * (static_cast<float>(i) + rng.next()) / 48;
        const Vec3f p = ray.ray.origin_index + ray.ray.direction_index * t;
        points.push_back(min(max(p, scene.domain_index.lower), scene.domain_index.upper));
      }
    }
  Looks out;
  if (points.empty()) return out;
  const auto count = static_cast<double>(points.size());
  for (const Vec3f p : points)
    out.known_share += view.cells.level_at(p) != ImportanceCellsView::kMixed ? 1 / count : 0;
  double sum = 0;
  std::vector<double> with_cells, without;
  for (int round = 0; round < 7; ++round) {
    const double start = processor_ms();
    for (const Vec3f p : points) sum += double{importance_at(view, p)};
    const double middle = processor_ms();
    for (const Vec3f p : points) sum -= double{look_up_importance(view, p)};
    with_cells.push_back((middle - start) * 1e6 / count);
    without.push_back((processor_ms() - middle) * 1e6 / count);
  }
  if (sum != 0) std::fprintf(stderr, "voxlume_visibility_speed: cells change look-ups\n");
  out.with_cells_ns = median(with_cells);
  out.without_ns = median(without);
  return out;
}

/// Of a scene with something important.
Json measure(const LoadedScene& loaded, const SceneDescription& important, int rounds) {
  constexpr int kVariants = 3;
  SceneDescription variants[kVariants];
  for (int v = 0; v < kVariants; ++v)
    variants[v] = resolve(with(important, v > 0, v > 1 ? VisibilityLights::kFirst : VisibilityLights::kOff),
                          loaded.volume, loaded.statistics);
  CompiledScene scene(variants[0], loaded.volume, loaded.statistics);
  std::vector<double> sample_ms[kVariants], prepare_ms, build_s;
  TraceCounters counters[kVariants];
  std::size_t bytes = 0;
  Looks looks;
  for (int round = 0; round < rounds; ++round)
    for (int v = 0; v < kVariants; ++v) {
      const double start = processor_ms();
      scene.update(variants[v]);
      if (v == 1) {
        prepare_ms.push_back(processor_ms() - start);
        build_s.push_back(scene.importance_list_s());
        bytes = scene.importance_list_bytes();
        if (round == 0) looks = time_looks(scene.view());
      }
      const TimedRender render = timed_render(scene, kSpp, 0);
      counters[v] = render.counters;
      sample_ms[v].push_back(render.processor_ms / kSpp);
    }
  const double prepare = median(prepare_ms);
  Json out{{"width", important.image.width},
           {"scatterings", important.render.max_scatter},
           {"plain_ms_per_spp", median(sample_ms[0])},
           {"camera_ms_per_spp", median(sample_ms[1])},
           {"camera_and_first_lights_ms_per_spp", median(sample_ms[2])},
           {"prepare_ms", prepare}};
  for (const int spp : {32, 128})
    for (int v = 1; v < kVariants; ++v) {
      std::vector<double> ratios;
      for (int round = 0; round < rounds; ++round) {
        const auto r = static_cast<std::size_t>(round);
        ratios.push_back((prepare_ms[r] + spp * sample_ms[v][r]) / (spp * sample_ms[0][r]));
      }
      out[std::string(v == 1 ? "camera" : "camera_and_first_lights") + "_ratio_" + std::to_string(spp) +
          "_spp"] = median(ratios);
    }
  const VisibilityDescription& d = *important.visibility;
  out["lists_wall_s"] = median(build_s);
  out["lists_mb"] = static_cast<double>(bytes) * 1e-6;
  out["looks_per_ray"] = d.ray_samples * d.ray_passes;
  out["looks_per_light_ray"] = d.light_samples;
  out["light_rays_per_path"] =
      static_cast<double>(counters[2].shadow_rays) / static_cast<double>(counters[2].paths);
  out["looks_known_by_cells"] = looks.known_share;
  out["look_ns"] = looks.with_cells_ns;
  out["look_without_cells_ns"] = looks.without_ns;
  return out;
}

/// The scene of `bones` with the labels of "FILE=A,B,..." in place of values.
SceneDescription label_scene(const SceneDescription& bones, const std::string& text) {
  SceneDescription scene = bones;
  const std::size_t at = text.find('=');
  ProxyDescription file, distance;
  file.name = "labels";
  file.path = text.substr(0, at);
  file.lookup = Lookup::kNearest;
  distance.name = "inside";
  distance.kind = ProxyKind::kDistance;
  distance.of = "labels";
  std::istringstream numbers(at == std::string::npos ? "" : text.substr(at + 1));
  for (std::string number; std::getline(numbers, number, ',');)
    distance.labels.push_back(std::atoi(number.c_str()));
  scene.proxies = {file, distance};
  scene.transfer.preset.clear();
  scene.visibility->important.assign(1, {});
  scene.visibility->important[0].volume = "inside";
  scene.visibility->important[0].range = {0, 1e12};
  return scene;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: voxlume_visibility_speed VOLUME [ROUNDS [SIZE [FILE=A,B,...]]]\n");
    return 2;
  }
  try {
    const LoadedScene loaded(argv[1]);
    const int rounds = argc > 2 ? std::atoi(argv[2]) : 5, size = argc > 3 ? std::atoi(argv[3]) : 800;
    Json rows;
    for (const int scatterings : {1, 2}) {
      const SceneDescription bones = bone_scene(size, scatterings);
      rows.push_back(measure(loaded, argc > 4 ? label_scene(bones, argv[4]) : bones, rounds));
    }
    const std::string important = argc > 4 ? argv[4] : "values from 300 on";
    std::printf(
        "%s\n",
        Json{{"volume", argv[1]}, {"important", important}, {"threads", thread_count()}, {"rows", rows}}
            .dump(2)
            .c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_visibility_speed: %s\n", error.what());
    return 1;
  }
  return 0;
}
