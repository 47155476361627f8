// xu2025 Table 5: what the papers' accelerators cost, all with the scalar tracker. Prints CSV: time to update
// after a new transfer function (all threads), to find the nearest and the farthest visible point of every
// pixel, and to render 10 samples per pixel with global illumination (one thread each, processor time).
// Usage: voxlume_accelerators SCENE_OR_VOLUME EDGE ROUNDS
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "measure.h"
#include "scene/tracking_choice.h"
#include "tracking/tracking.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;

struct Variant {
  std::string name;
  std::unique_ptr<CompiledScene> scene;
  std::vector<double> update_ms, locate_ms, render_ms;
  TraceCounters counters;
  double found_mm = 0;  ///< sum over pixels of the distances found
};

/// Where points are looked at along a ray: the same ones whatever the accelerator.
struct Sampling {
  IndexRay ray;  ///< from where it enters
  float length_mm, step_mm;
  bool visible(const Medium& medium, int i) const {
    return extinction_at(medium, ray.origin_index + ray.direction_index * at(i)) > 0;
  }
  float at(int i) const { return (static_cast<float>(i) + 0.5f) * step_mm; }
};

/// The first visible point, or the last, or -1: looks at the points in every run that may hold some.
float locate(const Medium& medium, const Sampling& s, bool farthest) {
  const Vec3f end = s.ray.origin_index + s.ray.direction_index * s.length_mm;
  const Vec3f origin = farthest ? end : s.ray.origin_index;
  const Vec3f direction = farthest ? s.ray.direction_index * -1.0f : s.ray.direction_index;
  float found = -1;
  with_walk(medium.accelerator, origin, direction, s.length_mm, [&](auto& walk) {
    MajorantSegment segment;
    while (walk.next(segment)) {
      if (!(segment.mu_maj > 0)) continue;
      const float lower = farthest ? s.length_mm - segment.t_far : segment.t_near;
      const float upper = farthest ? s.length_mm - segment.t_near : segment.t_far;
      const int first = std::max(0, static_cast<int>(std::ceil(lower / s.step_mm - 0.5f)));
      const int last = static_cast<int>(std::floor(upper / s.step_mm - 0.5f));
      for (int n = 0; n <= last - first; ++n) {
        const int i = farthest ? last - n : first + n;
        if (!s.visible(medium, i)) continue;
        found = s.at(i);
        return;
      }
    }
  });
  return found;
}

void locate_all(Variant& variant) {
  const SceneView& view = variant.scene->view();
  variant.found_mm = 0;
  const double start = processor_ms();
  for (int y = 0; y < view.height; ++y)
    for (int x = 0; x < view.width; ++x) {
      const CameraRay eye =
          camera_ray(view.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f, 0.5f);
      const IndexRay ray = to_index_ray(view.medium.grid, eye.origin, eye.direction);
      const Interval<float> run = clip_ray(view.domain_index, ray.origin_index, ray.direction_index, 0.0f,
                                           std::numeric_limits<float>::infinity());
      if (run.empty()) continue;
      const Sampling sampling{{ray.origin_index + ray.direction_index * run.t_near, ray.direction_index},
                              run.t_far - run.t_near,
                              0.5f * view.medium.grid.step_mm};
      const float nearest = locate(view.medium, sampling, false);
      if (nearest < 0) continue;
      const float farthest = locate(view.medium, sampling, true);
      variant.found_mm += static_cast<double>(nearest) + static_cast<double>(farthest);
    }
  variant.locate_ms.push_back(processor_ms() - start);
}

/// Times updates from another function to the scene's, which differ everywhere something is visible.
std::vector<double> time_updates(const CompiledScene& scene) {
  const GridView grid = make_grid_view(scene.volume());
  Accelerator accelerator(grid, accelerator_choice(scene.description(), grid));
  TransferDescription other = scene.description().transfer;
  other.density_scale *= 0.5;
  const TransferFunction before(other), after(scene.description().transfer);
  std::vector<double> times;
  for (int round = 0; round < 15; ++round) {
    accelerator.update(before);
    const double start = now_ms();
    accelerator.update(after);
    times.push_back(now_ms() - start);
  }
  return times;
}

std::vector<Variant> make_variants(const LoadedScene& loaded, int edge) {
  const GridView grid = make_grid_view(loaded.volume);
  std::vector<Variant> out;
  const auto add = [&](const char* name, const char* accelerator, const char* rule, int cell_voxels) {
    SceneDescription scene = loaded.description;
    scene.image.width = scene.image.height = edge;
    scene.render.simd = "scalar";
    scene.render.max_scatter = 0;
    scene.render.accelerator = accelerator;
    scene.render.hierarchy_rule = rule;
    scene.render.macrocell_voxels = cell_voxels;
    out.push_back({name, loaded.compile(scene), {}, {}, {}, {}});
  };
  add("none", "none", "cost", 0);
  add("macrocell", "macrocell", "cost", 0);
  add("octree + macrocell", "octree", "cost", 0);
  add("residency octree", "residency", "cost", 0);
  add("hierarchy, thresholds, leaf level 6", "hierarchy", "thresholds", octree_cell_voxels(grid, 6));
  add("hierarchy, thresholds, leaf level 7", "hierarchy", "thresholds", octree_cell_voxels(grid, 7));
  add("hierarchy, joined by cost", "hierarchy", "cost", 0);
  return out;
}

void print(const std::string& volume, const Variant& v) {
  std::printf("%s,\"%s\",%.2f,%.1f,%.1f,%.2f,%.2f\n", volume.c_str(), v.name.c_str(), median(v.update_ms),
              median(v.locate_ms), median(v.render_ms),
              static_cast<double>(v.counters.tracking_steps) / static_cast<double>(v.counters.paths),
              1e-3 * static_cast<double>(v.counters.paths) / median(v.render_ms));
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: voxlume_accelerators SCENE_OR_VOLUME EDGE ROUNDS\n");
    return 2;
  }
  try {
    const LoadedScene loaded(argv[1]);
    std::vector<Variant> variants = make_variants(loaded, std::max(1, std::atoi(argv[2])));
    for (Variant& v : variants) v.update_ms = time_updates(*v.scene);
    for (int round = 0; round < std::max(1, std::atoi(argv[3])); ++round)
      for (Variant& v : variants) {
        locate_all(v);
        const TimedRender render = render_on_one_thread(*v.scene, 10);
        v.render_ms.push_back(render.processor_ms);
        v.counters = render.counters;
      }
    const std::string path = argv[1], name = path.substr(path.find_last_of('/') + 1);
    for (const Variant& v : variants) {
      print(name.substr(0, name.find('.')), v);
      if (std::abs(v.found_mm / variants[0].found_mm - 1) > 1e-5) {
        std::fprintf(stderr, "voxlume_accelerators: %s finds other points than no accelerator\n",
                     v.name.c_str());
        return 1;
      }
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_accelerators: %s\n", error.what());
    return 1;
  }
  return 0;
}
