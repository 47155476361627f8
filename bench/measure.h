#pragma once
#include <algorithm>
#include <chrono>
#include <ctime>
#include <memory>
#include <string>
#include <vector>

#include "integrator/path_tracer.h"
#include "render/render_loop.h"
#include "scene/compile.h"
#include "scene/open_volume.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"

namespace voxlume {

inline double now_ms() {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}
/// Of the whole process: what other programs take from the machine does not count.
inline double processor_ms() { return 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// A scene and its voxels, read once for many variants of it.
struct LoadedScene {
  SceneDescription description;
  Volume volume;
  VolumeStatistics statistics;

  /// `path` is a scene file, or a volume for the default picture.
  explicit LoadedScene(const std::string& path) {
    if (path.ends_with(".json")) {
      description = read_scene(path);
    } else {
      description.volume.path = path;
    }
    volume = open_volume(description.volume);
    statistics = compute_statistics(make_grid_view(volume));
  }

  std::unique_ptr<CompiledScene> compile(const SceneDescription& variant) const {
    return std::make_unique<CompiledScene>(resolve(variant, volume, statistics), volume, statistics);
  }
};

struct TimedRender {
  double processor_ms;
  TraceCounters counters;
};

/// Renders on so many threads; 0: all.
inline TimedRender timed_render(const CompiledScene& scene, int spp, int threads) {
  const SceneView& view = scene.view();
  RenderState state{Film(view.width, view.height), {}};
  RenderLoopOptions options;
  options.stop.spp = spp;
  options.threads = threads;
  const double start = processor_ms();
  run_render_loop(
      state,
      [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
        render_tile(view, tile, begin, end, film, counters);
      },
      options);
  return {processor_ms() - start, state.counters};
}

inline TimedRender render_on_one_thread(const CompiledScene& scene, int spp) {
  return timed_render(scene, spp, 1);
}

}  // namespace voxlume
