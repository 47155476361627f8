#include "integrator/visibility.h"

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "camera/camera.h"
#include "sampling/sobol.h"

namespace voxlume {
namespace {

/// A stream of random numbers that no camera sample has.
constexpr std::uint32_t kListStream = 0xFFFFFFFEu;
/// Neighbours of one importance are joined when less than this many strata apart.
constexpr float kJoinStrata = 2;

float importance_on(const SceneView& scene, const TrackRay& ray, float t) noexcept {
  const Box3f& domain = scene.domain_index;
  const Vec3f p = ray.ray.origin_index + ray.ray.direction_index * t;
  return importance_at(scene.visibility.importance, min(max(p, domain.lower), domain.upper));
}

/// Another stream, which a path's own one decides and does not notice: where nothing is important, its numbers
/// are what they would be.
Rng beside(const Rng& stream) noexcept {
  std::array<std::uint32_t, 4> state = stream.state();
  for (std::uint32_t& word : state) word = mix_bits(word + 0x9E3779B9u);
  state[0] |= 1;
  return Rng(state);
}

TrackRay pixel_ray(const SceneView& scene, int x, int y) {
  const CameraRay ray =
      camera_ray(scene.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f, 0.5f);
  return visible_part(scene, to_index_ray(scene.medium.grid, ray.origin, ray.direction), ray.origin,
                      ray.direction, std::numeric_limits<float>::infinity(), true);
}

}  // namespace

SegmentListView find_importance(const SceneView& scene, int x, int y, const ListRefinement& refinement,
                                std::vector<ImportanceSegment>& segments) {
  segments.clear();
  const TrackRay ray = pixel_ray(scene, x, y);
  if (!(ray.t_near < ray.t_far)) return {};
  const float join = kJoinStrata * (ray.t_far - ray.t_near) / static_cast<float>(refinement.samples);
  Rng rng(scene.seed, 0, static_cast<std::uint32_t>(y * scene.width + x), kListStream);
  std::vector<ImportanceSegment> next;
  std::vector<ImportanceSample> samples;
  std::vector<StrataRun> runs;
  for (int pass = 0; pass < refinement.passes; ++pass) {
    if (pass % 4 == 0)
      runs = {{ray.t_near, ray.t_far, refinement.samples}};
    else
      adaptive_strata(segments, ray.t_near, ray.t_far, refinement.samples, runs);
    samples.clear();
    for (const StrataRun& run : runs)
      for (int i = 0; i < run.count; ++i) {
        const float t = run.begin + (run.end - run.begin) * (static_cast<float>(i) + rng.next()) /
                                        static_cast<float>(run.count);
        samples.push_back({t, importance_on(scene, ray, t)});
      }
    merge_samples(segments, samples, join, next);
    std::swap(segments, next);
  }
  const float total = integrate_segments(segments, ray.t_near, ray.t_far);
  return {segments.data(), static_cast<std::int32_t>(segments.size()), ray.t_near, ray.t_far, total};
}

PixelLists::PixelLists(const SceneView& scene, const ListRefinement& refinement)
    : heads_(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height)) {
  std::vector<std::vector<ImportanceSegment>> rows(static_cast<std::size_t>(scene.height));
  parallel_for(scene.height, 1, [&](std::int64_t y) {
    std::vector<ImportanceSegment> segments, &row = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < scene.width; ++x) {
      const SegmentListView list = find_importance(scene, x, static_cast<int>(y), refinement, segments);
      PixelListsView::Head& head = heads_[static_cast<std::size_t>(y * scene.width + x)];
      head = {0, 0, list.entry, list.exit, list.total};
      // Where nothing is important the total says all.
      if (!(list.total > 0)) continue;
      head.first = row.size();
      head.count = list.count;
      row.insert(row.end(), segments.begin(), segments.end());
    }
  });
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (int x = 0; x < scene.width; ++x)
      heads_[y * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x)].first += pool_.size();
    pool_.insert(pool_.end(), rows[y].begin(), rows[y].end());
    rows[y] = {};
  }
}

SegmentListView list_at(const SceneView& scene, float px, float py) noexcept {
  const int x = std::clamp(static_cast<int>(px), 0, scene.width - 1);
  const int y = std::clamp(static_cast<int>(py), 0, scene.height - 1);
  const PixelListsView& lists = scene.visibility.pixels;
  const PixelListsView::Head& head =
      lists.heads[static_cast<std::size_t>(y) * static_cast<std::size_t>(scene.width) +
                  static_cast<std::size_t>(x)];
  return {lists.pool + head.first, head.count, head.entry, head.exit, head.total};
}

SegmentListView find_light_importance(const SceneView& scene, const TrackRay& ray, const Rng& stream,
                                      std::vector<ImportanceSegment>& segments) {
  Rng rng = beside(stream);
  const Affinef& world = scene.medium.grid.world_from_index;
  const Vec3f back_index = -ray.ray.direction_index;
  const TrackRay behind =
      visible_part(scene, {ray.ray.origin_index, back_index}, world.point(ray.ray.origin_index),
                   world.vector(back_index), std::numeric_limits<float>::infinity(), true);
  const float reach = behind.t_near < behind.t_far ? behind.t_far : 0.0f;
  const int count = scene.visibility.light_samples;
  const float length = ray.t_far + reach;
  const float stratum = length / static_cast<float>(count), join = kJoinStrata * stratum;
  segments.clear();
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + rng.next()) * stratum;
    const float k = importance_on(scene, ray, ray.t_far - t);
    if (!segments.empty() && segments.back().k == k && t < segments.back().end() + join)
      segments.back().length = t - segments.back().t;
    else
      segments.push_back({t, 0, k, 0});
  }
  const float total = integrate_segments(segments, 0, length);
  return {segments.data(), static_cast<std::int32_t>(segments.size()), 0, length, total};
}

}  // namespace voxlume
