#pragma once
#include <atomic>
#include <cstdint>
#include <functional>

namespace voxlume {

/// Caps the threads that parallel_for uses while it lives. The only place where the thread library shows is
/// parallel.cpp.
class ThreadLimit {
 public:
  /// `threads` >= 1, or 0 for all the machine has.
  explicit ThreadLimit(int threads);
  ~ThreadLimit();
  ThreadLimit(const ThreadLimit&) = delete;
  ThreadLimit& operator=(const ThreadLimit&) = delete;

 private:
  void* control_;
};

/// How many threads parallel_for uses now.
int thread_count();

/// What long work throws when it is not wanted any more.
struct Cancelled {};

/// While it lives, parallel_for and reading volumes, called by this thread, throw Cancelled soon after `flag`
/// is set; what they were at is left half done.
class CancelScope {
 public:
  explicit CancelScope(const std::atomic<bool>& flag);
  ~CancelScope();
  CancelScope(const CancelScope&) = delete;
  CancelScope& operator=(const CancelScope&) = delete;

 private:
  const std::atomic<bool>* outer_;
};

/// Throws Cancelled where a CancelScope of this thread has its flag set.
void throw_if_cancelled();

/// Calls body(i) once for each i in [0, count), in any order and on several threads. Exceptions thrown by
/// `body` reach the caller, as does Cancelled. Work is handed out in runs of `grain` indices.
void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t)>& body);

}  // namespace voxlume
