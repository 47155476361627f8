#include "integrator/visibility.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <utility>

#include "base/parallel.h"
#include "camera/camera.h"
#include "sampling/sobol.h"
#include "visibility/important_blocks.h"
#include "visibility/list_refiner.h"

namespace voxlume {
namespace {

using Clock = std::chrono::steady_clock;

/// A stream of random numbers that no camera sample has.
constexpr std::uint32_t kListStream = 0xFFFFFFFEu;

/// Lists are of step functions. What is interpolated between two importances of rules is taken to have this
/// many steps there, so that its runs join, too: else a list would keep every point that was looked at. The
/// squares' mean over a step is off by a 768th.
constexpr float kStepsBetween = 8;

/// An importance between those of rules as the nearest step. Theirs stay what they are.
float nearest_step(const ImportanceView& view, float k) noexcept {
  float below = 0, above = std::numeric_limits<float>::infinity();
  for (std::int32_t i = 0; i < view.rule_count; ++i) {
    const float importance = std::round(view.rules[i].importance / kImportanceStep) * kImportanceStep;
    if (importance <= k)
      below = std::max(below, importance);
    else
      above = std::min(above, importance);
  }
  if (!(k > below) || std::isinf(above)) return below;
  const float step = std::round((k - below) / (above - below) * kStepsBetween);
  return step == kStepsBetween ? above : below + (above - below) * (step / kStepsBetween);
}

/// What is important along a line.
class LineImportance {
 public:
  /// The line is asked about from t_min to t_max [mm]. `blocks`, which may be null, are those of the scene.
  LineImportance(const SceneView& scene, const IndexRay& line, float t_min, float t_max,
                 const ImportantBlocks* blocks = nullptr) noexcept
      : view_(scene.visibility.importance), domain_(scene.domain_index), line_(line) {
    const Box3f& important = view_.cells.important;
    if (view_.cells.levels == nullptr) within_ = {t_min, t_max};
    if (view_.cells.levels == nullptr || important.empty()) return;
    // Points and distances in floats are off by a few roundings of what they are made from.
    float reach = 0;
    for (int a = 0; a < 3; ++a)
      reach = std::max(reach, std::abs(line.origin_index[a]) +
                                  std::abs(line.direction_index[a]) * std::max(-t_min, t_max));
    const float slack = 1e-3f + 32 * std::numeric_limits<float>::epsilon() * reach;
    within_ = clip_ray(Box3f{important.lower - Vec3f(slack), important.upper + Vec3f(slack)},
                       line.origin_index, line.direction_index, t_min, t_max);
    if (blocks != nullptr && !is_none() && slack < 0.25f)
      within_ = blocks->part_of(line.origin_index, line.direction_index, within_.t_near, within_.t_far);
  }

  /// Whether nothing on it can be important.
  bool is_none() const noexcept { return !(within_.t_near <= within_.t_far); }

  float operator()(float t) const noexcept {
    if (!(t >= within_.t_near && t <= within_.t_far)) return 0;
    const Vec3f on_line = line_.origin_index + line_.direction_index * t;
    const Vec3f p = min(max(on_line, domain_.lower), domain_.upper);
    // As importance_at does, of a point that is inside the volume.
    if (view_.cells.levels != nullptr) {
      const std::uint8_t level = view_.cells.level_at(p);
      if (level != ImportanceCellsView::kMixed) return view_.cells.importance[level];
    }
    const float k = look_up_importance(view_, p);
    return view_.lookup == ImportanceLookup::kInterpolated ? k : nearest_step(view_, k);
  }

 private:
  const ImportanceView& view_;
  const Box3f& domain_;
  const IndexRay line_;
  Interval<float> within_{1, 0};
};

/// Another stream, which a path's own one decides and does not notice: where nothing is important, its
/// numbers are what they would be.
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

/// Finds list after list; keeps the memory that it takes.
class ListBuilder {
 public:
  ListBuilder(const SceneView& scene, const ListRefinement& refinement, const ImportantBlocks* blocks)
      : scene_(scene), refinement_(refinement), blocks_(blocks) {}

  SegmentListView find(int x, int y, std::vector<ImportanceSegment>& segments) {
    segments.clear();
    const TrackRay ray = pixel_ray(scene_, x, y);
    if (!(ray.t_near < ray.t_far)) return {};
    const LineImportance importance(scene_, ray.ray, ray.t_near, ray.t_far, blocks_);
    if (importance.is_none()) return {segments.data(), 0, ray.t_near, ray.t_far, 0};
    Rng rng(scene_.seed, 0,
            static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(scene_.width) +
                static_cast<std::uint32_t>(x),
            kListStream);
    for (int pass = 0; pass < refinement_.passes; ++pass)
      refiner_.refine(
          pass, ray.t_near, ray.t_far, refinement_.samples, importance, [&] { return rng.next(); }, segments);
    const float total = integrate_segments(segments, ray.t_near, ray.t_far);
    return {segments.data(), static_cast<std::int32_t>(segments.size()), ray.t_near, ray.t_far, total};
  }

 private:
  const SceneView& scene_;
  const ListRefinement refinement_;
  const ImportantBlocks* const blocks_;
  ListRefiner refiner_;
};

/// Calls a progress callback ten times a second, whichever threads the work is done by.
class ProgressTicks {
 public:
  ProgressTicks(const ListProgress& progress, std::int64_t count) : progress_(progress), count_(count) {}

  void finish_one() {
    const std::int64_t done = ++done_;
    if (!progress_) return;
    std::unique_lock lock(mutex_, std::defer_lock);
    if (done == count_) {
      lock.lock();  // the end is told even where another thread is telling
    } else if (!lock.try_lock()) {
      return;
    }
    const Clock::time_point now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(100) && done < count_) return;
    last_ = now;
    progress_(static_cast<double>(done) / static_cast<double>(count_));
  }

 private:
  const ListProgress& progress_;
  const std::int64_t count_;
  std::atomic<std::int64_t> done_{0};
  std::mutex mutex_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace

SegmentListView find_importance(const SceneView& scene, int x, int y, const ListRefinement& refinement,
                                std::vector<ImportanceSegment>& segments) {
  return ListBuilder(scene, refinement, nullptr).find(x, y, segments);
}

PixelLists::PixelLists(const SceneView& scene, const ListRefinement& refinement, const ListProgress& progress)
    : heads_(static_cast<std::size_t>(scene.width) * static_cast<std::size_t>(scene.height)) {
  const Clock::time_point start = Clock::now();
  std::vector<std::vector<ImportanceSegment>> rows(static_cast<std::size_t>(scene.height));
  std::optional<ImportantBlocks> blocks;
  if (scene.visibility.importance.cells.levels != nullptr) blocks.emplace(scene.visibility.importance.cells);
  ProgressTicks ticks(progress, scene.height);
  parallel_for(scene.height, 1, [&](std::int64_t y) {
    ListBuilder builder(scene, refinement, blocks ? &*blocks : nullptr);
    std::vector<ImportanceSegment> segments, &row = rows[static_cast<std::size_t>(y)];
    for (int x = 0; x < scene.width; ++x) {
      const SegmentListView list = builder.find(x, static_cast<int>(y), segments);
      PixelListsView::Head& head = heads_[static_cast<std::size_t>(y * scene.width + x)];
      head = {0, 0, list.entry, list.exit, list.total};
      // Where nothing is important the total says all.
      if (!(list.total > 0)) continue;
      head.first = row.size();
      head.count = list.count;
      row.insert(row.end(), segments.begin(), segments.end());
    }
    ticks.finish_one();
  });
  std::size_t count = 0;
  for (const auto& row : rows) count += row.size();
  pool_.reserve(count);
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (int x = 0; x < scene.width; ++x)
      heads_[y * static_cast<std::size_t>(scene.width) + static_cast<std::size_t>(x)].first += pool_.size();
    pool_.insert(pool_.end(), rows[y].begin(), rows[y].end());
    rows[y] = {};
  }
  seconds_ = std::chrono::duration<double>(Clock::now() - start).count();
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
  const LineImportance importance(scene, ray.ray, -reach, ray.t_far);
  if (importance.is_none()) return {segments.data(), 0, 0, length, 0};
  for (int i = 0; i < count; ++i) {
    const float t = (static_cast<float>(i) + rng.next()) * stratum;
    const float k = importance(ray.t_far - t);
    if (!segments.empty() && segments.back().k == k && t < segments.back().end() + join)
      segments.back().length = t - segments.back().t;
    else
      segments.push_back({t, 0, k, 0});
  }
  const float total = integrate_segments(segments, 0, length);
  return {segments.data(), static_cast<std::int32_t>(segments.size()), 0, length, total};
}

}  // namespace voxlume
