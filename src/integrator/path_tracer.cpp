#include "integrator/path_tracer.h"

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "integrator/camera_path.h"
#include "integrator/ray_march.h"
#include "tracking/rgb_tracking.h"

namespace voxlume {
namespace {

/// Samples of a tile that are held back until they can be added in order.
constexpr int kHeldSamples = 4096;

/// The pixels of a tile, row by row.
std::pair<int, int> pixel_at(const TileRect& tile, int index) {
  const int width = tile.x1 - tile.x0;
  return {tile.x0 + index % width, tile.y0 + index / width};
}

/// The rays of samples [sample_begin, sample_end) of every pixel of a tile. Samples of one pixel follow each
/// other: neighbouring lanes take like ways.
class TileRays {
 public:
  TileRays(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end)
      : scene_(scene),
        tile_(tile),
        sample_begin_(sample_begin),
        samples_per_pixel_(sample_end - sample_begin),
        count_(static_cast<std::size_t>(tile.pixel_count()) * static_cast<std::size_t>(samples_per_pixel_)) {}

  /// To be asked for in order.
  PrimaryRay operator[](std::size_t job) {
    if (!fill_) {
      const auto [x, y] = pixel_of(job);
      return make_primary_ray(scene_, x, y, sample_of(job));
    }
    const int at = static_cast<int>(job % PrimaryRayBatch::kCount);
    if (at == 0) {
      for (std::size_t i = 0; i < PrimaryRayBatch::kCount; ++i) {
        const std::size_t one = std::min(job + i, count_ - 1);
        std::tie(batch_.x[i], batch_.y[i]) = pixel_of(one);
        batch_.sample[i] = static_cast<std::int32_t>(sample_of(one));
      }
      fill_(scene_, batch_);
    }
    return batch_.at(at);
  }

 private:
  std::pair<int, int> pixel_of(std::size_t job) const {
    return pixel_at(tile_, static_cast<int>(job) / samples_per_pixel_);
  }

  std::uint32_t sample_of(std::size_t job) const {
    return static_cast<std::uint32_t>(sample_begin_ + static_cast<int>(job) % samples_per_pixel_);
  }

  const SceneView& scene_;
  const TileRect tile_;
  const int sample_begin_, samples_per_pixel_;
  const std::size_t count_;
  const FillPrimaryRays fill_ = vector_primary_rays(scene_.simd, scene_.camera);
  PrimaryRayBatch batch_;
};

/// Follows many paths at once, those that begin with Rays. A lane of the vector tracker has the ray of one of
/// them, and takes another's as soon as it is done; collisions wait until there is a vector of them to shade.
/// The rest is scalar code.
template <class Rays>
class LaneTracer {
 public:
  LaneTracer(const SceneView& scene, Rays rays, std::span<PixelSample> results,
             std::span<RadianceParts> parts, TraceCounters& counters)
      : scene_(scene), rays_(rays), results_(results), parts_(parts), counters_(counters) {
    for (int path = 0; path < kPaths; ++path) idle_[path] = path;
  }

  void trace() {
    for (int lane = 0; lane < Lanes::kCount; ++lane) start_next(lane);
    while (busy_lanes_ > 0) {
      track_lanes_(scene_.medium, lanes_);
      resume_done();
      if (next_job_ == results_.size()) drain();
    }
  }

 private:
  using Wait = CameraPath::Wait;
  /// Beside those in the lanes, a batch of paths waits to be shaded.
  static constexpr int kPaths = Lanes::kCount + ScatteringBatch::kCount;

  struct Ready {
    int path;
    Wait wait;
  };

  /// Gives a lane the next ray, if there is one: of a path under way, else of a new one.
  void start_next(int lane) {
    lanes_.state[lane] = Lanes::kIdle;
    if (ready_count_ > 0) {
      const Ready next = ready_[--ready_count_];
      return put(lane, next.path, next.wait);
    }
    while (next_job_ < results_.size()) {
      const int path = idle_[idle_count_ - 1];
      jobs_[path] = next_job_;
      const Wait wait = paths_[path].begin(scene_, rays_[next_job_++], counters_);
      if (wait == Wait::kNothing) {
        store_result(path);
      } else {
        --idle_count_;
        return put(lane, path, wait);
      }
    }
  }

  void put(int lane, int path, Wait wait) {
    ++busy_lanes_;
    path_of_[lane] = path;
    lanes_.put(lane, paths_[path].ray(), wait == Wait::kTransmittance, paths_[path].rng());
  }

  /// Finds the lanes that are done before it resumes any: without branches that mispredict.
  void resume_done() {
    int done[Lanes::kCount], count = 0;
    for (int lane = 0; lane < Lanes::kCount; ++lane) {
      done[count] = lane;
      count += lanes_.state[lane] == Lanes::kDone ? 1 : 0;
    }
    for (int i = 0; i < count; ++i) resume(done[i]);
  }

  /// Takes what the tracker found and gives the lane its next ray.
  void resume(int lane) {
    const int at = path_of_[lane];
    CameraPath& path = paths_[at];
    counters_.tracking_steps += lanes_.steps[lane];
    counters_.majorant_violations += lanes_.violations[lane];
    path.rng() = lanes_.stream(lane);
    const Wait wait = lanes_.is_shadow[lane]
                          ? path.end_shadow_ray(scene_, lanes_.transmittance[lane], counters_)
                          : path.end_flight(scene_, lanes_.collision(lane, path.ray().t_near), counters_);
    --busy_lanes_;
    if (wait == Wait::kFlight || wait == Wait::kTransmittance) return put(lane, at, wait);
    if (wait == Wait::kScattering)
      collect(at);
    else
      finish(at);
    start_next(lane);
  }

  void store_result(int path) {
    results_[jobs_[path]] = paths_[path].sample();
    if (!parts_.empty()) parts_[jobs_[path]] = paths_[path].parts();
  }
  void finish(int path) {
    store_result(path);
    idle_[idle_count_++] = path;
  }

  /// Has the path's collision shaded, with others'.
  void collect(int path) {
    collided_[batch_.count] = path;
    batch_.add(paths_[path].query());
    if (batch_.count == ScatteringBatch::kCount) shade();
  }

  void shade() {
    if (!scene_.shades_singly) fill_scatterings_(scene_, batch_);
    for (int i = 0; i < batch_.count; ++i) {
      const int path = collided_[i];
      const Scattering scattering =
          scene_.shades_singly ? scatter_at(scene_, paths_[path].query()) : batch_.at(scene_, i);
      const Wait wait = paths_[path].end_scattering(scene_, scattering, counters_);
      if (wait == Wait::kNothing)
        finish(path);
      else
        ready_[ready_count_++] = {path, wait};
    }
    batch_.clear();
  }

  /// When no new path can fill the batch or a lane: what waits goes on.
  void drain() {
    shade();
    for (int lane = 0; lane < Lanes::kCount && ready_count_ > 0; ++lane)
      if (lanes_.state[lane] == Lanes::kIdle) start_next(lane);
  }

  const SceneView& scene_;
  Rays rays_;
  const std::span<PixelSample> results_;
  const std::span<RadianceParts> parts_;
  TraceCounters& counters_;
  const VectorTracker track_lanes_ = vector_tracker(scene_.simd, scene_.medium);
  const FillScatterings fill_scatterings_ = vector_scatterings(scene_.simd);
  std::size_t next_job_ = 0;
  int busy_lanes_ = 0;
  Lanes lanes_;
  int path_of_[Lanes::kCount];
  CameraPath paths_[kPaths];
  std::size_t jobs_[kPaths];
  int idle_[kPaths], idle_count_ = kPaths;  ///< paths without a job
  ScatteringBatch batch_;
  int collided_[ScatteringBatch::kCount];  ///< paths of the batch
  Ready ready_[ScatteringBatch::kCount];   ///< paths that wait for a lane
  int ready_count_ = 0;
};

/// Has the path go on from kFlight or kTransmittance, by scalar code.
CameraPath::Wait track(const SceneView& scene, CameraPath::Wait wait, CameraPath& path,
                       TrackingCounters& tracking, TraceCounters& counters) noexcept {
  const Medium& medium = scene.medium;
  if (wait == CameraPath::Wait::kFlight)
    return path.end_flight(
        scene, sample_free_flight(scene.trackers, medium, path.ray(), path.rng(), tracking), counters);
  return path.end_shadow_ray(
      scene, estimate_transmittance(scene.trackers, medium, path.ray(), path.rng(), tracking), counters);
}

/// The same where channels have extinctions of their own.
CameraPath::Wait track_rgb(const SceneView& scene, CameraPath::Wait wait, CameraPath& path,
                           TrackingCounters& tracking, TraceCounters& counters) noexcept {
  const Medium& medium = scene.medium;
  if (wait == CameraPath::Wait::kFlight) {
    const RgbFlight flight = sample_rgb_flight(medium, path.ray(), path.carried(), path.rng(), tracking);
    path.weigh_flight(flight.weight);
    return path.end_flight(scene, flight.collision, counters);
  }
  path.weigh_shadow_ray(estimate_rgb_transmittance(medium, path.ray(), path.rng(), tracking));
  return path.end_shadow_ray(scene, 1, counters);
}

/// One path, or one marched ray, by scalar code; `path` is begun anew.
PixelSample trace_ray(const SceneView& scene, const PrimaryRay& primary, CameraPath& path,
                      TraceCounters& counters, RadianceParts* parts) noexcept {
  using Wait = CameraPath::Wait;
  if (scene.ray_march.on) return march_camera_ray(scene, primary, counters, parts);
  TrackingCounters tracking;
  Wait wait = path.begin(scene, primary, counters);
  for (;;) switch (wait) {
      case Wait::kFlight:
      case Wait::kTransmittance:
        wait = scene.extinction == Extinction::kRgb ? track_rgb(scene, wait, path, tracking, counters)
                                                    : track(scene, wait, path, tracking, counters);
        break;
      case Wait::kScattering:
        wait = path.end_scattering(scene, scatter_at(scene, path.query()), counters);
        break;
      case Wait::kNothing:
        counters.tracking_steps += tracking.steps;
        counters.majorant_violations += tracking.majorant_violations;
        if (parts != nullptr) *parts = path.parts();
        return path.sample();
    }
}

}  // namespace

PixelSample trace_camera_sample(const SceneView& scene, int x, int y, std::uint32_t sample,
                                TraceCounters& counters, RadianceParts* parts) noexcept {
  CameraPath path;
  return trace_ray(scene, make_primary_ray(scene, x, y, sample), path, counters, parts);
}

void trace_rays(const SceneView& scene, std::span<const PrimaryRay> rays, std::span<PixelSample> samples,
                TraceCounters& counters) {
  if (scene.simd != SimdTarget::kScalar) return LaneTracer(scene, rays, samples, {}, counters).trace();
  CameraPath path;
  for (std::size_t i = 0; i < rays.size(); ++i)
    samples[i] = trace_ray(scene, rays[i], path, counters, nullptr);
}

void trace_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end,
                std::span<PixelSample> samples, std::span<RadianceParts> parts, TraceCounters& counters) {
  if (scene.simd != SimdTarget::kScalar)
    return LaneTracer(scene, TileRays(scene, tile, sample_begin, sample_end), samples, parts, counters)
        .trace();
  std::size_t next = 0;
  CameraPath path;
  for (int pixel = 0; pixel < tile.pixel_count(); ++pixel) {
    const auto [x, y] = pixel_at(tile, pixel);
    for (int sample = sample_begin; sample < sample_end; ++sample, ++next)
      samples[next] = trace_ray(scene, make_primary_ray(scene, x, y, static_cast<std::uint32_t>(sample)),
                                path, counters, parts.empty() ? nullptr : &parts[next]);
  }
}

void render_tile(const SceneView& scene, const TileRect& tile, int sample_begin, int sample_end, Film& film,
                 TraceCounters& counters) {
  const auto pixels = static_cast<std::size_t>(tile.pixel_count());
  const bool classes = film.layers().classes;
  const int at_once =
      std::max(classes ? kClassifiedTogether : 1, kHeldSamples / static_cast<int>(tile.pixel_count()));
  const std::size_t held = pixels * std::max(0, std::min(at_once, sample_end - sample_begin));
  std::vector<PixelSample> samples(held);
  std::vector<RadianceParts> parts(classes ? held : 0);
  for (int begin = sample_begin; begin < sample_end; begin += at_once) {
    const int end = std::min(begin + at_once, sample_end);
    const auto count = static_cast<std::size_t>(end - begin);
    const std::span some(samples.data(), pixels * count);
    trace_tile(scene, tile, begin, end, some, std::span(parts.data(), classes ? some.size() : 0), counters);
    for (std::size_t pixel = 0; pixel < pixels; ++pixel) {
      const auto [x, y] = pixel_at(tile, static_cast<int>(pixel));
      const std::span own = some.subspan(pixel * count, count);
      for (const PixelSample& sample : own) film.add(x, y, sample);
      if (classes) film.add_classes(x, y, own, std::span(parts).subspan(pixel * count, count));
    }
  }
}

}  // namespace voxlume
