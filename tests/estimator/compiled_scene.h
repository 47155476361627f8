#pragma once
#include "test_scene.h"

namespace voxlume::test {

/// A volume and its scene, ready to trace, as the test's accelerator and instruction set have it.
struct Compiled {
  Compiled(const SceneDescription& scene, const Volume& volume_)
      : volume(volume_),
        statistics(compute_statistics(make_grid_view(volume))),
        compiled(resolve(as_tested(scene), volume, statistics), volume, statistics) {}
  const SceneView& view() const { return compiled.view(); }
  PixelSample sample(int x, int y, std::uint32_t index = 0) const {
    TraceCounters counters;
    return trace_camera_sample(view(), x, y, index, counters);
  }
  const Volume volume;
  const VolumeStatistics statistics;
  const CompiledScene compiled;
};

}  // namespace voxlume::test
