// Measures tracking speed on the scenes of bench/scenes, variants interleaved in one run, and prints JSON:
// medians of wall time over the rounds, rates, and ratios round by round. Usage: voxlume_bench SCENES_FOLDER
// [ROUNDS]
#include <algorithm>
#include <cstdio>
#include <functional>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>

#include "base/parallel.h"
#include "integrator/path_tracer.h"
#include "render/render_loop.h"
#include "scene/compile.h"
#include "scene/open_volume.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;
using Json = nlohmann::ordered_json;

struct Render {
  Film film;
  TraceCounters counters;
  double wall_s;
};

std::unique_ptr<CompiledScene> load(const std::string& path,
                                    const std::function<void(SceneDescription&)>& edit) {
  SceneDescription scene = read_scene(path);
  edit(scene);
  Volume volume = open_volume(scene.volume);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  return std::make_unique<CompiledScene>(resolve(scene, volume, statistics), std::move(volume), statistics);
}

Render render(const CompiledScene& scene, int threads, int spp) {
  const SceneView& view = scene.view();
  RenderState state{Film(view.width, view.height), {}};
  RenderLoopOptions options;
  options.stop.spp = spp;
  options.threads = threads;
  const RenderOutcome outcome = run_render_loop(
      state,
      [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
        render_tile(view, tile, begin, end, film, counters);
      },
      options);
  return {std::move(state.film), state.counters, outcome.wall_s};
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t n = values.size();
  return 0.5 * (values[(n - 1) / 2] + values[n / 2]);
}

/// One way of rendering; its rounds are interleaved with the others'.
struct Variant {
  std::string name;
  std::shared_ptr<CompiledScene> scene;
  int threads, spp;
  std::vector<double> wall_s;
  TraceCounters counters;

  Json report() const {
    const double wall = median(wall_s);
    return {{"name", name},
            {"threads", threads},
            {"spp", spp},
            {"wall_s", wall},
            {"rounds_s", wall_s},
            {"paths_per_s", static_cast<double>(counters.paths) / wall},
            {"steps_per_s", static_cast<double>(counters.tracking_steps) / wall},
            {"steps_per_path",
             static_cast<double>(counters.tracking_steps) / static_cast<double>(counters.paths)},
            {"majorant_build_ms", scene->majorant_build_ms()}};
  }
};

/// Median over rounds of time(a) / time(b): how many times as fast b is.
double speedup(const Variant& a, const Variant& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.wall_s.size(); ++i) ratios.push_back(a.wall_s[i] / b.wall_s[i]);
  return median(ratios);
}

Json tracking(const std::string& folder, int rounds) {
  const auto scene = [&](const std::function<void(SceneDescription&)>& edit) {
    return std::shared_ptr<CompiledScene>(load(folder + "/ct-bone.json", edit));
  };
  const auto single = scene([](SceneDescription&) {});
  const auto two_lit = scene([](SceneDescription& s) {
    s.render.max_scatter = 2;
    s.lights.reset();
    s.environment.reset();
  });
  std::vector<Variant> variants;
  variants.push_back({"ct-bone, 1 scattering", single, 1, 8, {}, {}});
  variants.push_back({"ct-bone, 1 scattering, 2 threads", single, 2, 8, {}, {}});
  variants.push_back({"ct-bone, 2 scatterings, default lights", two_lit, 1, 8, {}, {}});
  variants.push_back({"ct-bone, 2 scatterings, default lights, 2 threads", two_lit, 2, 16, {}, {}});
  for (int round = 0; round < rounds; ++round) {
    for (Variant& v : variants) {
      const Render r = render(*v.scene, v.threads, v.spp);
      v.wall_s.push_back(r.wall_s);
      v.counters = r.counters;
    }
  }
  Json out;
  for (const Variant& v : variants) out["variants"].push_back(v.report());
  out["speedup_2_threads"] = speedup(variants[0], variants[1]);
  return out;
}

/// The lit forehead of the peer scene: mean luminance, and seconds of one core until the relative standard
/// deviation of a pixel is 10 %, from two independent renders.
Json peer(const std::string& folder, int max_scatter, int spp) {
  std::vector<Render> renders;
  for (const std::uint64_t seed : {1, 2}) {
    const auto scene = load(folder + "/peer.json", [&](SceneDescription& s) {
      s.render.max_scatter = max_scatter;
      s.render.seed = seed;
    });
    renders.push_back(render(*scene, 1, spp));
  }
  double sum = 0, difference2 = 0, error2 = 0;
  int count = 0;
  for (int y = 130; y < 260; ++y) {
    for (int x = 240; x < 370; ++x, ++count) {
      const double a = luminance(renders[0].film.mean(x, y)), b = luminance(renders[1].film.mean(x, y));
      sum += 0.5 * (a + b);
      difference2 += 0.5 * (a - b) * (a - b);
      error2 += 0.25 * (renders[0].film.variance_of_mean(x, y) + renders[1].film.variance_of_mean(x, y));
    }
  }
  const double mean = sum / count;
  const double relative_variance = difference2 / count / (mean * mean);
  const double wall = 0.5 * (renders[0].wall_s + renders[1].wall_s);
  return {{"max_scatter", max_scatter},
          {"spp", spp},
          {"wall_s", wall},
          {"paths_per_s", static_cast<double>(renders[0].counters.paths) / wall},
          {"forehead_mean", mean},
          {"forehead_mean_standard_error", std::sqrt(error2) / count},
          {"seconds_to_10_percent_rms", wall * relative_variance / 0.01}};
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: voxlume_bench SCENES_FOLDER [ROUNDS [tracking|peer]]\n");
    return 2;
  }
  try {
    const std::string folder = argv[1];
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    Json out;
    out["simd"] = "scalar";
    const std::string part = argc > 3 ? argv[3] : "";
    if (part != "peer") out["tracking"] = tracking(folder, rounds);
    if (part != "tracking") out["peer"] = Json::array({peer(folder, 1, 16), peer(folder, 100, 8)});
    std::cout << out.dump(2) << "\n";
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
