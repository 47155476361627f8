#pragma once
#include <utility>
#include <vector>

#include "visibility/segment_list.h"

namespace voxlume {

/// Neighbours of one importance are joined when less than this many strata apart.
inline constexpr float kJoinStrata = 2;

/// Refines what is known along a ray, pass by pass (lerzer2025 section 5). Keeps the memory that it takes.
class ListRefiner {
 public:
  /// Looks once in each of `count` strata of [entry, exit] and merges what it found into `segments`. Strata
  /// are even in every fourth pass, counted from 0, and lie where they find out most in the others. `look(t)`
  /// is the importance at t, `uniform()` a random number in [0, 1).
  template <class Look, class Uniform>
  void refine(int pass, float entry, float exit, int count, Look&& look, Uniform&& uniform,
              std::vector<ImportanceSegment>& segments) {
    if (pass % 4 == 0)
      runs_.assign(1, {entry, exit, count});
    else
      adaptive_strata(segments, entry, exit, count, runs_);
    samples_.clear();
    for (const StrataRun& run : runs_)
      for (int i = 0; i < run.count; ++i) {
        const float t = run.begin + (run.end - run.begin) * (static_cast<float>(i) + uniform()) /
                                        static_cast<float>(run.count);
        samples_.push_back({t, look(t)});
      }
    merge_samples(segments, samples_, kJoinStrata * (exit - entry) / static_cast<float>(count), next_);
    std::swap(segments, next_);
  }

 private:
  std::vector<StrataRun> runs_;
  std::vector<ImportanceSample> samples_;
  std::vector<ImportanceSegment> next_;
};

}  // namespace voxlume
