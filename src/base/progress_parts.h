#pragma once
#include <algorithm>
#include <chrono>

#include "base/progress.h"

namespace voxlume {

/// What tells `whole` of the `index`-th of `count` equal parts of its work; empty where `whole` is.
inline Progress part_of(const Progress& whole, int index, int count) {
  if (!whole) return {};
  return [whole, index, count](double share) { whole((index + std::clamp(share, 0.0, 1.0)) / count); };
}

/// Passes on how far work is that takes long, ten times a second at most and ever growing, and 1 at its end.
/// Nothing of work that is over sooner than `patience_s`. One thread at a time.
class LongWork {
 public:
  /// `tell` may be empty; it must outlive this.
  LongWork(const Progress& tell, double patience_s)
      : tell_(tell), due_(Clock::now() + duration(patience_s)) {}
  ~LongWork() {
    if (told_ > 0 && told_ < 1) tell_(1);
  }
  LongWork(const LongWork&) = delete;
  LongWork& operator=(const LongWork&) = delete;

  void is_done(double share) {
    if (!tell_ || share <= told_ || Clock::now() < due_) return;
    due_ = Clock::now() + duration(kEvery_s);
    told_ = std::min(share, 1.0);
    tell_(told_);
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr double kEvery_s = 0.1;
  static Clock::duration duration(double s) {
    return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(s));
  }

  const Progress& tell_;
  Clock::time_point due_;
  double told_ = 0;
};

}  // namespace voxlume
