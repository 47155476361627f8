// Measures how fast a new transfer function reaches the majorants: builds a hierarchy over the head CT,
// stretched to cubes of several sizes, and times whole and partial updates: wall time on all
// threads, and processor time of all threads together. Prints a markdown table. Usage:
// voxlume_hierarchy_update VOLUME [EDGE...]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include "accel/hierarchy.h"
#include "grid/volume_statistics.h"
#include "measure.h"
#include "stretched.h"
#include "voxlume/error.h"

namespace {

using namespace voxlume;

struct Edit {
  const char* name;
  TransferFunction before, after;
};

std::vector<Edit> edits(const Volume& volume) {
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const auto preset = [&](const char* name) {
    SceneDescription scene;
    scene.transfer.preset = name;
    return resolve(scene, volume, statistics).transfer;
  };
  const TransferDescription bone = preset("ct-bone"), muscle = preset("ct-muscle-bone");
  TransferDescription denser = muscle, moved = muscle;
  denser.density_scale *= 1.25;
  moved.points[moved.points.size() - 2].value += 1;
  std::vector<Edit> out;
  out.push_back({"another preset", TransferFunction(bone), TransferFunction(muscle)});
  out.push_back({"another density", TransferFunction(muscle), TransferFunction(denser)});
  out.push_back({"one point moved", TransferFunction(muscle), TransferFunction(moved)});
  return out;
}

void measure(const Volume& volume, int cell_voxels) {
  const double start = now_ms();
  MajorantHierarchy hierarchy(make_grid_view(volume), cell_voxels);
  const double build_ms = now_ms() - start;
  for (const Edit& edit : edits(volume)) {
    std::vector<double> times, processor_times;
    for (int round = 0; round < 15; ++round) {
      hierarchy.update(edit.before);
      const double begin = now_ms(), processor_begin = processor_ms();
      hierarchy.update(edit.after);
      times.push_back(now_ms() - begin);
      processor_times.push_back(processor_ms() - processor_begin);
    }
    std::printf("| %lld^3 | %d | %.0f | %s | %.2f | %.2f | %.2f |\n", static_cast<long long>(volume.size[0]),
                cell_voxels, build_ms, edit.name, *std::min_element(times.begin(), times.end()),
                median(times), median(processor_times));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: voxlume_hierarchy_update VOLUME [EDGE...]\n");
    return 2;
  }
  try {
    VolumeDescription description;
    description.path = argv[1];
    const Volume head = open_volume(description);
    std::printf(
        "| voxels | cell | ranges, ms | edit | least, ms | median, ms | processor, ms "
        "|\n|---|---|---|---|---|---|---|\n");
    std::vector<int> edges{256, 512};
    if (argc > 2) edges.clear();
    for (int i = 2; i < argc; ++i) edges.push_back(std::atoi(argv[i]));
    for (const int edge : edges) {
      const Volume volume = stretched(head, edge);
      const int chosen = default_hierarchy_voxels(make_grid_view(volume));
      measure(volume, chosen);
      if (chosen > 2 && edge <= 512) measure(volume, chosen / 2);
    }
  } catch (const Error& error) {
    std::fprintf(stderr, "voxlume_hierarchy_update: %s\n", error.what());
    return 1;
  }
  return 0;
}
