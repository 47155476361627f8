#pragma once
#include <span>

#include "film/film.h"
#include "film/tile.h"
#include "film/trace_counters.h"
#include "integrator/primary_ray.h"
#include "integrator/scene_view.h"

namespace voxlume {

/// One camera sample of pixel (x, y) (integrator/camera_path.h), by scalar code. `parts`, if not null, takes
/// what its radiance is made of; the scene must keep parts.
PixelSample trace_camera_sample(const SceneView& scene, int x, int y, std::uint32_t sample,
                                TraceCounters& counters, RadianceParts* parts = nullptr) noexcept;

/// As many samples of a pixel render_tile traces in one go at least, if it is given them, for a film that
/// keeps classes: Film::add_classes divides them together.
inline constexpr int kClassifiedTogether = 32;

/// Samples [sample_begin, sample_end) of every pixel of `tile`, row by row, a pixel's samples together;
/// `samples` has room for them, and so has `parts` unless it is empty; then the scene must keep parts. By the
/// instruction set that scene.simd names; the results are those of trace_camera_sample with every one.
void trace_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end,
                std::span<PixelSample> samples, std::span<RadianceParts> parts, TraceCounters& counters);

/// The samples that begin with `rays`, in their order; samples.size() == rays.size(). By the instruction set
/// that scene.simd names, with the results of every other.
void trace_rays(const SceneView& scene, std::span<const PrimaryRay> rays, std::span<PixelSample> samples,
                TraceCounters& counters);

/// Adds samples [sample_begin, sample_end) of every pixel of `tile` to `film`, in sample order, and to its
/// classes if it keeps them; then the scene must keep parts.
void render_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end, Film& film,
                 TraceCounters& counters);

}  // namespace voxlume
