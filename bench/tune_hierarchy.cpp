// Tries settings of the hierarchy on a scene and prints the camera paths a second of each, best first: finest
// cells by look-up costs, and by pairs of thresholds. Uses the tracker that the scene asks for. The picture
// is the same with any of them; set the best in the scene file or with --set. Usage: voxlume_tune_hierarchy
// SCENE_OR_VOLUME [EDGE] [ROUNDS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "measure.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;

struct Setting {
  RenderDescription render;
  std::string text;
  std::vector<double> ms;
  TraceCounters counters;
};

std::string cells(int voxels) { return "/render/macrocell_voxels=" + std::to_string(voxels); }

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%g", value);
  return text;
}

std::vector<Setting> settings(const RenderDescription& given, const GridView& grid) {
  std::vector<Setting> out;
  RenderDescription render = given;
  render.accelerator = "hierarchy";
  const int own = default_hierarchy_voxels(grid);
  for (const int voxels : {std::max(1, own / 2), own, own + own / 2, 2 * own}) {
    render.macrocell_voxels = voxels;
    render.hierarchy_rule = "cost";
    for (const double cost : {0.5, 1.0, 1.5, 2.5, 4.0, 7.0, 12.0}) {
      render.lookup_cost = cost;
      out.push_back({render, cells(voxels) + " /render/lookup_cost=" + number(cost), {}, {}});
    }
    render.hierarchy_rule = "thresholds";
    for (const double climb : {0.01, 0.03, 0.1, 0.3, 1.0})
      for (const double descend : {0.03, 0.1, 0.3, 1.0, 3.0}) {
        if (climb > descend) continue;
        render.hierarchy_thresholds = {climb, descend};
        out.push_back({render,
                       cells(voxels) + " /render/hierarchy_rule=thresholds /render/hierarchy_thresholds=[" +
                           number(climb) + "," + number(descend) + "]",
                       {},
                       {}});
      }
  }
  return out;
}

/// Renders with each setting in turn, all of them `rounds` times, so that a slow spell of the machine hits
/// all.
void measure(const LoadedScene& loaded, std::vector<Setting>& all, int edge, int rounds) {
  for (int round = 0; round < rounds; ++round)
    for (Setting& setting : all) {
      SceneDescription scene = loaded.description;
      scene.render = setting.render;
      scene.image.width = scene.image.height = edge;
      const auto compiled = loaded.compile(scene);
      render_on_one_thread(*compiled, 1);  // warms caches
      const TimedRender render = render_on_one_thread(*compiled, 4);
      setting.ms.push_back(render.processor_ms);
      setting.counters = render.counters;
    }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    std::fprintf(stderr, "usage: voxlume_tune_hierarchy SCENE_OR_VOLUME [EDGE] [ROUNDS]\n");
    return 2;
  }
  try {
    const LoadedScene loaded(argv[1]);
    std::vector<Setting> all = settings(loaded.description.render, make_grid_view(loaded.volume));
    measure(loaded, all, argc > 2 ? std::max(1, std::atoi(argv[2])) : 192,
            argc > 3 ? std::max(1, std::atoi(argv[3])) : 3);
    const auto fastest = [](const Setting& s) { return *std::min_element(s.ms.begin(), s.ms.end()); };
    std::sort(all.begin(), all.end(),
              [&](const Setting& a, const Setting& b) { return fastest(a) < fastest(b); });
    std::printf("M paths/s  steps/path  settings (--set)\n");
    for (const Setting& s : all)
      std::printf("%9.3f  %10.2f  %s\n", 1e-3 * static_cast<double>(s.counters.paths) / fastest(s),
                  static_cast<double>(s.counters.tracking_steps) / static_cast<double>(s.counters.paths),
                  s.text.c_str());
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_tune_hierarchy: %s\n", error.what());
    return 1;
  }
  return 0;
}
