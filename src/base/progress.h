#pragma once
#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>

namespace voxlume {

/// Takes how much of some work is done, in (0, 1] and growing.
using Progress = std::function<void(double share)>;

/// Counts the steps of work that several threads do, and tells of every percent: from one thread at a time.
class ProgressCounter {
 public:
  /// `tell` may be empty; it must outlive this.
  ProgressCounter(std::int64_t steps, const Progress& tell) : steps_(steps), tell_(tell) {}

  /// So many more are done.
  void add(std::int64_t steps = 1) {
    if (!tell_) return;
    done_ += steps;
    if (percent() <= told_) return;
    const std::lock_guard lock(mutex_);
    const int now = percent();
    if (now <= told_) return;
    told_ = now;
    tell_(0.01 * now);
  }

 private:
  int percent() const { return static_cast<int>(100 * done_ / steps_); }

  const std::int64_t steps_;
  const Progress& tell_;
  std::atomic<std::int64_t> done_{0};
  std::atomic<int> told_{0};
  std::mutex mutex_;
};

}  // namespace voxlume
