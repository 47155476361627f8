#pragma once
#include <atomic>

namespace voxlume::cli {

/// Takes SIGINT and SIGTERM while it lives. Until defer() the first one ends the process with code 130, as
/// there is nothing to save; afterwards it only sets flag(), and a second one ends the process.
class InterruptGuard {
 public:
  InterruptGuard();
  ~InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;

  /// From now on there is something to save.
  void defer();
  const std::atomic<bool>& flag() const;
};

}  // namespace voxlume::cli
