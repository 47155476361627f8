#include <algorithm>
#include <cmath>
#include <optional>

#include "tracking/control_walk.h"
#include "tracking/estimators.h"

namespace voxlume {
namespace {

/// Majorant depth of a run. Longer ones stratify better, shorter ones end sooner behind opaque matter.
constexpr float kRunDepth = 12;

// kettunen2021: orders above 0 are evaluated with this probability, from the second on with P(N >= k)
// shrinking by kExpansion / k; kMeanOrder is the N to expect.
constexpr float kHigherOrders = 0.1f;
constexpr int kExpansion = 2;
constexpr float kMeanOrder = 0.31945f;
constexpr float kQueryShare = 0.7f;
constexpr int kMaxOrder = 24;  ///< P(N > 24) is 1e-19, nothing that 24 random bits a draw could resolve

/// A place on a ray that moves on by depths of what the control leaves over.
template <class Walk>
class DepthCursor {
 public:
  explicit DepthCursor(const Walk& walk) : walk_(walk) {}

  /// Moves on by `depth` or to the ray's end; returns how far that was.
  float advance(float depth) noexcept {
    float moved = 0;
    for (;;) {
      const float rate = segment_.mu_maj - segment_.mu_min;
      const float left_mm = segment_.t_far - t_, left = left_mm * rate;
      if (depth - moved < left) {
        const float step_mm = (depth - moved) / rate;
        t_ = std::min(t_ + step_mm, segment_.t_far);
        control_ += step_mm * segment_.mu_min;
        return depth;
      }
      moved += left;
      control_ += left_mm * segment_.mu_min;
      t_ = segment_.t_far;
      if (!walk_.next(segment_)) {
        ended_ = true;
        return moved;
      }
      t_ = segment_.t_near;
    }
  }

  bool ended() const noexcept { return ended_; }
  float t() const noexcept { return t_; }
  const MajorantSegment& segment() const noexcept { return segment_; }
  /// The control's depth from the ray's start to here.
  float control() const noexcept { return control_; }

 private:
  Walk walk_;
  MajorantSegment segment_{0, 0, 0, 0, {}};
  float t_ = 0, control_ = 0;
  bool ended_ = false;
};

/// The order of the expansion, and weight[k] = 1 / P(N >= k).
int sample_order(Rng& rng, float (&weight)[kMaxOrder + 1]) noexcept {
  weight[0] = 1;
  if (rng.next() >= kHigherOrders) return 0;
  float probability = kHigherOrders;
  int order = kExpansion;
  for (int k = 1; k <= kExpansion; ++k) weight[k] = 1 / probability;
  while (order < kMaxOrder) {
    const float goes_on = static_cast<float>(kExpansion) / static_cast<float>(order + 1);
    if (rng.next() >= goes_on) break;
    probability *= goes_on;
    weight[++order] = 1 / probability;
  }
  return order;
}

/// exp(-depth) from `order` + 1 independent estimates of it: the power series about each in turn, with the
/// means of the products of the others as powers.
float expand(const float* estimates, int order, const float (&weight)[kMaxOrder + 1]) noexcept {
  if (order == 0) return std::exp(-estimates[0]);
  float sum = 0;
  for (int pivot = 0; pivot <= order; ++pivot) {
    float symmetric[kMaxOrder + 1] = {1};  // elementary symmetric polynomials of pivot - others
    int used = 0;
    for (int i = 0; i <= order; ++i) {
      if (i == pivot) continue;
      ++used;
      for (int k = used; k > 0; --k) symmetric[k] += symmetric[k - 1] * (estimates[pivot] - estimates[i]);
    }
    // A mean is symmetric[k] over "order choose k"; its term is that over k!.
    float series = 0, falling = 1;
    for (int k = 0; k <= order; ++k) {
      series += weight[k] * symmetric[k] * falling;
      if (k < order) falling /= static_cast<float>(order - k);
    }
    sum += std::exp(-estimates[pivot]) * series;
  }
  return sum / static_cast<float>(order + 1);
}

/// Look-ups of one estimate over a run of majorant depth `depth`: kettunen2021's number for a variance below
/// ratio tracking's, times a share that lowered the time to equal error (./vx experiments estimators).
int query_size(float depth) noexcept {
  const float size = std::cbrt((0.015f + depth) * (0.65f + depth) * (60.3f + depth));
  return std::max(1, static_cast<int>(kQueryShare * size / (kMeanOrder + 1) + 0.5f));
}

/// An estimate of the transmittance of the next `depth` > 0, from where the cursor is. The control is left
/// out.
template <class Walk>
float march(const Medium& medium, const WalkRay& ray, DepthCursor<Walk> cursor, float depth, Rng& rng,
            TrackingCounters& counters) noexcept {
  float weight[kMaxOrder + 1];
  const int order = sample_order(rng, weight);
  float offset[kMaxOrder + 1], estimates[kMaxOrder + 1] = {};
  for (int i = 0; i <= order; ++i) offset[i] = rng.next();
  // All estimates are taken in one walk: their points alternate in the same order in every stratum.
  std::sort(offset, offset + order + 1);
  const int size = query_size(depth);
  const float stratum = depth / static_cast<float>(size);
  float at = 0;
  for (int j = 0; j < size; ++j)
    for (int i = 0; i <= order; ++i) {
      const float next = (static_cast<float>(j) + offset[i]) * stratum;
      cursor.advance(next - at);
      at = next;
      // Rounding may carry a point to where the control is everything.
      if (!(cursor.segment().mu_maj > cursor.segment().mu_min)) continue;
      ++counters.steps;
      const float mu_t = extinction_at(medium, point_on(ray, cursor.segment(), cursor.t()));
      estimates[i] += stratum * residual_share(cursor.segment(), mu_t, counters);
    }
  return expand(estimates, order, weight);
}

}  // namespace

float estimate_transmittance_marching(const Medium& medium, const TrackRay& track, Rng& rng,
                                      TrackingCounters& counters) noexcept {
  const WalkRay ray = to_walk_ray(medium, track);
  float transmittance = 1;
  with_walk(medium.accelerator, ray.origin, ray.direction, ray.length_mm, [&](auto& walk) {
    std::optional cursor = DepthCursor(walk);
    while (!cursor->ended()) {
      DepthCursor end = *cursor;
      const float depth = end.advance(kRunDepth);
      transmittance *= std::exp(cursor->control() - end.control());
      if (depth > 0) transmittance *= march(medium, ray, *cursor, depth, rng, counters);
      cursor.emplace(end);
      if (!cursor->ended() && roulette(transmittance, rng)) return;
    }
  });
  return transmittance;
}

}  // namespace voxlume
