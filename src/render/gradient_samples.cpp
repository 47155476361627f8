#include "render/gradient_samples.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "base/parallel.h"
#include "integrator/path_tracer.h"
#include "sampling/sobol.h"

namespace voxlume {
namespace {

constexpr int kStratum = 3;  ///< edge of a stratum [pixels]
/// Rays that are traced together: enough to keep all lanes busy.
constexpr std::size_t kRaysTogether = 256;

int strata(int pixels) { return (pixels + kStratum - 1) / kStratum; }

/// How far, relative to what is seen, the scattering of a sample that has moved may be from where it was.
constexpr float kSameMatter = 0.02f;

}  // namespace

void GradientSampler::fill(const SceneView& scene, const Film& film, DenoiseFrame& frame) {
  if (width_ == scene.width && height_ == scene.height) {
    trace_again(scene, frame);
  } else {
    frame.gradients.reset();
  }
  keep(scene, film);
}

/// For each stratum of this frame the nearest of the samples that have moved into it.
std::vector<GradientSampler::Moved> GradientSampler::move(const SceneView& scene) const {
  const int columns = strata(width_);
  std::vector<Moved> nearest(static_cast<std::size_t>(columns) * strata(height_));
  for (const Sample& sample : samples_) {
    const PixelPosition before = project(camera_, sample.p_world);
    const PixelPosition now = project(scene.camera, sample.p_world);
    if (!scene.camera.orthographic && !(now.depth_mm > 0)) continue;
    // By the difference, which leaves a pixel of an unmoved camera exactly where it was, and a lens nearly.
    const Moved moved{&sample, sample.center_px + (now.px - before.px),
                      sample.center_py + (now.py - before.py), now.depth_mm};
    const bool inside = moved.center_px >= 0 && moved.center_px < scene.camera.width_px &&
                        moved.center_py >= 0 && moved.center_py < scene.camera.height_px;
    if (!inside) continue;
    const int column = static_cast<int>(moved.center_px) / kStratum;
    const int row = static_cast<int>(moved.center_py) / kStratum;
    Moved& there = nearest[static_cast<std::size_t>(row) * columns + column];
    if (there.sample == nullptr || moved.depth_mm < there.depth_mm) there = moved;
  }
  return nearest;
}

/// Whether a sample that was traced again tells how the light has changed. Where the picture stands still,
/// other matter than before is such a change; where it moves, it is only another view.
bool GradientSampler::tells(const Moved& moved, Vec3f eye_mm, const PixelSample& now, float size_mm) {
  if (!is_finite(now.radiance)) return false;
  const Sample& before = *moved.sample;
  if (moved.center_px == before.center_px && moved.center_py == before.center_py) return true;
  return now.alpha > 0 && std::abs(now.depth_mm - length(before.p_world - eye_mm)) <= kSameMatter * size_mm;
}

void GradientSampler::trace_again(const SceneView& scene, DenoiseFrame& frame) const {
  const int columns = strata(width_);
  const Plane zeros(columns, strata(height_));
  GradientSamples& out = frame.gradients.emplace(GradientSamples{zeros, zeros, zeros});
  const std::vector<Moved> nearest = move(scene);
  std::vector<std::size_t> filled;
  for (std::size_t i = 0; i < nearest.size(); ++i)
    if (nearest[i].sample != nullptr) filled.push_back(i);

  const auto trace = [&](std::span<const std::size_t> own) {
    std::vector<PrimaryRay> rays;
    for (const std::size_t i : own) {
      const Moved& moved = nearest[i];
      rays.push_back(make_primary_ray(scene, moved.sample->stream, moved.center_px, moved.center_py));
    }
    std::vector<PixelSample> samples(rays.size());
    TraceCounters counters;
    trace_rays(scene, rays, samples, counters);
    for (std::size_t i = 0; i < own.size(); ++i) {
      const Moved& moved = nearest[own[i]];
      if (!tells(moved, rays[i].origin_world, samples[i], frame.size_mm)) continue;
      const int x = static_cast<int>(own[i]) % columns, y = static_cast<int>(own[i]) / columns;
      out.now.at(x, y) = samples[i].alpha > 0 ? luminance(samples[i].radiance) : 0.0f;
      out.before.at(x, y) = moved.sample->luminance;
      out.valid.at(x, y) = 1;
    }
  };
  const auto runs = static_cast<std::int64_t>((filled.size() + kRaysTogether - 1) / kRaysTogether);
  parallel_for(runs, 1, [&](std::int64_t run) {
    const std::size_t begin = static_cast<std::size_t>(run) * kRaysTogether;
    trace(std::span(filled).subspan(begin, std::min(kRaysTogether, filled.size() - begin)));
  });
}

void GradientSampler::keep(const SceneView& scene, const Film& film) {
  width_ = scene.width;
  height_ = scene.height;
  camera_ = scene.camera;
  samples_.clear();
  for (int y0 = 0; y0 < height_; y0 += kStratum) {
    for (int x0 = 0; x0 < width_; x0 += kStratum) {
      const int wide = std::min(kStratum, width_ - x0), pixels = wide * std::min(kStratum, height_ - y0);
      const std::uint32_t hash = mix_bits(sample_stream(scene, x0, y0, 0).pixel ^ mix_bits(scene.frame));
      const int pick = static_cast<int>(hash % static_cast<std::uint32_t>(pixels));
      for (int i = 0; i < pixels; ++i) {
        const int at = (pick + i) % pixels, x = x0 + at % wide, y = y0 + at / wide;
        const PixelClasses& pixel = film.classes(x, y);
        if (!(pixel.first_depth_mm > 0)) continue;
        const PrimaryRay primary = make_primary_ray(scene, x, y, 0);
        samples_.push_back(
            {sample_stream(scene, x, y, 0), static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f,
             primary.origin_world + primary.direction_world * pixel.first_depth_mm, pixel.first_luminance});
        break;
      }
    }
  }
}

}  // namespace voxlume
