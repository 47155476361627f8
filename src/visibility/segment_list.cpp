#include "visibility/segment_list.h"

#include <cmath>
#include <cstddef>

namespace voxlume {
namespace {

/// What is left to merge: old segments, samples, and ends of segments that were split.
class Candidates {
 public:
  Candidates(std::span<const ImportanceSegment> old, std::span<const ImportanceSample> samples)
      : old_(old), samples_(samples) {}

  bool next(ImportanceSegment& out) {
    const bool segment = at_ < old_.size(), sample = sample_at_ < samples_.size();
    if (has_tail_ && !(segment && old_[at_].t < tail_.t) && !(sample && samples_[sample_at_].t < tail_.t)) {
      out = tail_;
      has_tail_ = false;
    } else if (segment && !(sample && samples_[sample_at_].t < old_[at_].t)) {
      out = old_[at_++];
    } else if (sample) {
      out = {samples_[sample_at_].t, 0, samples_[sample_at_].k, 0};
      ++sample_at_;
    } else {
      return false;
    }
    return true;
  }
  /// Of two tails the one before is further on: it lies in what the later one splits.
  void put_tail(float t, float k) {
    tail_ = {t, 0, k, 0};
    has_tail_ = true;
  }

 private:
  const std::span<const ImportanceSegment> old_;
  const std::span<const ImportanceSample> samples_;
  std::size_t at_ = 0, sample_at_ = 0;
  ImportanceSegment tail_{};
  bool has_tail_ = false;
};

float mean_square(float before, float after) {
  const float mean = 0.5f * (before + after);
  return mean * mean;
}

}  // namespace

float importance_before(const SegmentListView& list, float t) noexcept {
  const ImportanceSegment* const end = list.segments + list.count;
  const ImportanceSegment* const after = std::upper_bound(
      list.segments, end, t, [](float value, const ImportanceSegment& s) { return value < s.t; });
  float from_t = list.entry, from = 0;
  if (after != list.segments) {
    const ImportanceSegment& s = after[-1];
    if (t <= s.end()) return s.integral + s.k * s.k * (t - s.t);
    from_t = s.end();
    from = s.integral + s.k * s.k * s.length;
  }
  const float to_t = after == end ? list.exit : after->t;
  const float to = after == end ? list.total : after->integral;
  if (!(to_t > from_t)) return from;
  return from + (to - from) * std::clamp((t - from_t) / (to_t - from_t), 0.0f, 1.0f);
}

void merge_samples(std::span<const ImportanceSegment> old, std::span<const ImportanceSample> samples,
                   float join, std::vector<ImportanceSegment>& out) {
  out.clear();
  Candidates candidates(old, samples);
  ImportanceSegment c;
  while (candidates.next(c)) {
    if (!out.empty()) {
      ImportanceSegment& last = out.back();
      if (c.k == last.k && c.t < last.end() + join) {
        last.length = std::max(last.end(), c.end()) - last.t;
        continue;
      }
      if (c.k != last.k && c.t < last.end()) {
        candidates.put_tail(last.end(), last.k);
        last.length = 0;
      }
    }
    out.push_back(c);
  }
}

float integrate_segments(std::span<ImportanceSegment> segments, float entry, float exit) noexcept {
  double sum = 0;
  float before_t = entry, before_k = 0;
  for (ImportanceSegment& s : segments) {
    sum += double{mean_square(before_k, s.k)} * std::max(s.t - before_t, 0.0f);
    s.integral = static_cast<float>(sum);
    sum += double{s.k} * s.k * s.length;
    before_t = s.end();
    before_k = s.k;
  }
  return static_cast<float>(sum + double{mean_square(before_k, 0)} * std::max(exit - before_t, 0.0f));
}

void adaptive_strata(std::span<const ImportanceSegment> segments, float entry, float exit, int count,
                     std::vector<StrataRun>& out) {
  out.clear();
  std::vector<float> weights;
  double total = 0;
  int differing = 0;
  const auto add = [&](float begin, float end, float weight, bool differs) {
    if (!(end > begin)) return;
    out.push_back({begin, end, differs && differing < count ? 1 : 0});
    differing += differs ? 1 : 0;
    weights.push_back(weight * (end - begin));
    total += weights.back();
  };
  float before = entry;
  for (std::size_t i = 0; i < segments.size(); ++i) {
    const bool first = i == 0, differs = !first && segments[i - 1].k != segments[i].k;
    add(before, segments[i].t, differs ? 4.0f : 2.0f, differs);
    add(segments[i].t, segments[i].end(), 1, false);
    before = segments[i].end();
  }
  add(before, exit, 2, false);
  // What the differing gaps did not get is shared by weight; parts of a stratum add up along the ray.
  const int shared = count - std::min(differing, count);
  double sum = 0;
  int given = 0;
  for (std::size_t i = 0; i < out.size(); ++i) {
    sum += weights[i] / total * shared;
    const int upto = i + 1 == out.size() ? shared : static_cast<int>(std::floor(sum + 0.5));
    out[i].count += upto - given;
    given = upto;
  }
}

}  // namespace voxlume
