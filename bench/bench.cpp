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
#include "grid/sample.h"
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

using Edit = std::function<void(SceneDescription&)>;

/// The scene of that file with what `edit` changes in the file and `edit_resolved` in what it says in full.
std::unique_ptr<CompiledScene> load(const std::string& path, const Edit& edit,
                                    const Edit& edit_resolved = {}) {
  SceneDescription scene = read_scene(path);
  if (edit) edit(scene);
  Volume volume = open_volume(scene.volume);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  scene = resolve(scene, volume, statistics);
  if (edit_resolved) edit_resolved(scene);
  return std::make_unique<CompiledScene>(scene, std::move(volume), statistics);
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
            {"simd", simd_name(scene->view().simd)},
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

/// Renders the variants in turn, so that what slows the machine slows all.
void run_rounds(std::vector<Variant>& variants, int rounds) {
  for (int round = 0; round < rounds; ++round) {
    for (Variant& v : variants) {
      const Render r = render(*v.scene, v.threads, v.spp);
      v.wall_s.push_back(r.wall_s);
      v.counters = r.counters;
    }
  }
}

Json report(const std::vector<Variant>& variants) {
  Json out = Json::array();
  for (const Variant& v : variants) out.push_back(v.report());
  return out;
}

/// The main line's tracker: scalar code over macrocells, independent random numbers.
void as_main_line(SceneDescription& s) {
  s.render.accelerator = "macrocell";
  s.render.simd = "scalar";
  s.render.sampler = Sampler::kRandom;
}

Edit with_simd(const char* name) {
  return [name](SceneDescription& s) { s.render.simd = name; };
}

Json tracking(const std::string& folder, int rounds) {
  const auto scene = [&](const Edit& edit, const Edit& edit_resolved = {}) {
    return std::shared_ptr<CompiledScene>(load(folder + "/ct-bone.json", edit, edit_resolved));
  };
  const auto under_default_lights = [](SceneDescription& s) {
    s.render.max_scatter = 2;
    s.lights.reset();
    s.environment.reset();
  };
  const auto two_lit = scene(under_default_lights);
  const auto one_lit = scene(under_default_lights, [](SceneDescription& s) { s.lights->resize(1); });
  const auto widest = scene({});
  std::vector<Variant> variants;
  const auto add = [&](const std::string& name, std::shared_ptr<CompiledScene> of, int threads, int spp) {
    variants.push_back({name, std::move(of), threads, spp, {}, {}});
    return variants.size() - 1;
  };
  const std::size_t auto_1 = add("1 scattering", widest, 1, 32), auto_2 = add("1 scattering", widest, 2, 64);
  const std::size_t two_1 = add("2 scatterings, default lights", two_lit, 1, 16);
  add("2 scatterings, default lights", two_lit, 2, 32);
  const std::size_t one_1 = add("2 scatterings, one area light and environment", one_lit, 1, 16);
  const std::size_t main_line = add("1 scattering, scalar code over macrocells", scene(as_main_line), 1, 8);
  const std::size_t scalar = add("1 scattering, scalar code", scene(with_simd("scalar")), 1, 8);
  for (const SimdTarget target : {SimdTarget::kSse4, SimdTarget::kAvx2, SimdTarget::kNeon})
    if (has_simd_target(target))
      add(std::string("1 scattering, ") + simd_name(target), scene(with_simd(simd_name(target))), 1, 16);
  run_rounds(variants, rounds);
  const auto per_sample = [&](std::size_t a, std::size_t b) {
    return speedup(variants[a], variants[b]) * variants[b].spp / variants[a].spp;
  };
  return {{"variants", report(variants)},
          {"speedup_2_threads", per_sample(auto_1, auto_2)},
          {"speedup_over_scalar_same_accelerator", per_sample(scalar, auto_1)},
          {"speedup_over_scalar_macrocells", per_sample(main_line, auto_1)},
          {"rate_of_2_scatterings_over_1", per_sample(auto_1, two_1)},
          {"rate_of_2_scatterings_over_1_one_area_light", per_sample(auto_1, one_1)}};
}

/// `volume` with `factor` times as many voxels along each axis, interpolated.
Volume upsampled(const Volume& volume, int factor) {
  Volume out = volume;
  for (int a = 0; a < 3; ++a) {
    out.size[a] = volume.size[a] * factor;
    out.spacing_mm[a] = volume.spacing_mm[a] / factor;
  }
  const GridView grid = make_grid_view(volume);
  auto voxels = std::make_shared<std::vector<std::int16_t>>(out.voxel_count());
  parallel_for(out.size[2], 1, [&](std::int64_t k) {
    std::size_t at = static_cast<std::size_t>(k * out.size[1] * out.size[0]);
    const auto f = static_cast<float>(factor);
    for (std::int64_t j = 0; j < out.size[1]; ++j)
      for (std::int64_t i = 0; i < out.size[0]; ++i)
        (*voxels)[at++] = static_cast<std::int16_t>(sample_trilinear(
            grid, {static_cast<float>(i) / f, static_cast<float>(j) / f, static_cast<float>(k) / f}));
  });
  out.type = VoxelType::kI16;
  out.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  return out;
}

/// The head CT with 64 times its voxels (1024 x 1024 x 432).
Json large(const std::string& folder, int rounds) {
  SceneDescription description = read_scene(folder + "/ct-bone.json");
  const Volume volume = upsampled(open_volume(description.volume), 4);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  std::vector<Variant> variants;
  for (const bool main_line : {false, true}) {
    if (main_line) as_main_line(description);
    variants.push_back(
        {main_line ? "1 scattering, scalar code over macrocells" : "1 scattering",
         std::make_shared<CompiledScene>(resolve(description, volume, statistics), volume, statistics),
         1,
         main_line ? 4 : 16,
         {},
         {}});
  }
  run_rounds(variants, rounds);
  return {{"voxels", volume.voxel_count()}, {"variants", report(variants)}};
}

/// Seconds of one core until the RMSE of luminance over the picture is 0.01, against a reference of other
/// random numbers, for the default and for the main line's tracker.
Json time_to_rmse(const std::string& folder) {
  constexpr double kTarget = 0.01;
  constexpr int kSpp = 32, kReferenceSpp = 1024;
  const auto reference_scene =
      load(folder + "/ct-bone.json", [](SceneDescription& s) { s.render.seed = 99; });
  const Render reference = render(*reference_scene, 0, kReferenceSpp);
  Json out;
  std::vector<double> seconds;
  for (const Edit& edit : {Edit(as_main_line), Edit()}) {
    const auto scene = load(folder + "/ct-bone.json", edit);
    const Render r = render(*scene, 1, kSpp);
    double squares = 0;
    for (int y = 0; y < r.film.height(); ++y) {
      for (int x = 0; x < r.film.width(); ++x) {
        const double difference = luminance(r.film.mean(x, y)) - luminance(reference.film.mean(x, y));
        squares += difference * difference - reference.film.variance_of_mean(x, y);
      }
    }
    const double mean_square = squares / static_cast<double>(r.film.pixel_count());
    seconds.push_back(r.wall_s * mean_square / (kTarget * kTarget));
    out["variants"].push_back({{"name", seconds.size() == 1 ? "scalar code over macrocells" : "default"},
                               {"spp", kSpp},
                               {"wall_s", r.wall_s},
                               {"rmse", std::sqrt(mean_square)},
                               {"seconds_to_rmse_0.01", seconds.back()}});
  }
  out["ratio"] = seconds[1] / seconds[0];
  return out;
}

/// The lit forehead of the peer scene: mean luminance, and seconds of one core until the relative standard
/// deviation of a pixel is 10 %, from two independent renders with about as many samples as that takes.
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
    std::fprintf(stderr, "usage: voxlume_bench SCENES_FOLDER [ROUNDS [tracking|large|rmse|peer]]\n");
    return 2;
  }
  try {
    const std::string folder = argv[1];
    const int rounds = argc > 2 ? std::max(1, std::atoi(argv[2])) : 5;
    Json out;
    out["simd"] = simd_name(best_simd_target());
    const std::string part = argc > 3 ? argv[3] : "";
    const auto wanted = [&](const char* name) { return part.empty() || part == name; };
    if (wanted("tracking")) out["tracking"] = tracking(folder, rounds);
    if (wanted("large")) out["large"] = large(folder, std::min(rounds, 3));
    if (wanted("rmse")) out["time_to_rmse"] = time_to_rmse(folder);
    if (wanted("peer")) out["peer"] = Json::array({peer(folder, 1, 40), peer(folder, 100, 40)});
    std::cout << out.dump(2) << "\n";
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_bench: %s\n", error.what());
    return 1;
  }
  return 0;
}
