#include "integrator/path_tracer.h"

#include "integrator/camera_path.h"

namespace voxlume {

PixelSample trace_camera_sample(const SceneView& scene, int x, int y, std::uint32_t sample,
                                TraceCounters& counters) noexcept {
  using Wait = CameraPath::Wait;
  CameraPath path;
  TrackingCounters tracking;
  Wait wait = path.begin(scene, x, y, sample, counters);
  while (wait != Wait::kNothing) {
    wait = wait == Wait::kFlight
               ? path.end_flight(scene, sample_free_flight(scene.medium, path.ray(), path.rng(), tracking),
                                 counters)
               : path.end_shadow_ray(
                     scene, estimate_transmittance(scene.medium, path.ray(), path.rng(), tracking), counters);
  }
  counters.tracking_steps += tracking.steps;
  counters.majorant_violations += tracking.majorant_violations;
  return path.sample();
}

void render_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end, Film& film,
                 TraceCounters& counters) {
  for (int y = tile.y0; y < tile.y1; ++y)
    for (int x = tile.x0; x < tile.x1; ++x)
      for (int sample = sample_begin; sample < sample_end; ++sample)
        film.add(x, y, trace_camera_sample(scene, x, y, static_cast<std::uint32_t>(sample), counters));
}

}  // namespace voxlume
