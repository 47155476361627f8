#pragma once
#include "film/film.h"
#include "film/tile.h"
#include "film/trace_counters.h"
#include "integrator/scene_view.h"

namespace voxlume {

/// One camera sample of pixel (x, y): an unbiased estimate of its radiance. Scattering positions by delta
/// tracking, direct light by next-event estimation with ratio-tracked shadow rays, combined with direction
/// sampling by the power heuristic; after the last allowed scattering the sampled direction still collects
/// light that reaches it unscattered. The random stream depends on (seed, frame, pixel, sample) alone.
PixelSample trace_camera_sample(const SceneView& scene, int x, int y, std::uint32_t sample,
                                TraceCounters& counters) noexcept;

/// Adds samples [sample_begin, sample_end) of every pixel of `tile` to `film`, in sample order.
void render_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end, Film& film,
                 TraceCounters& counters);

}  // namespace voxlume
