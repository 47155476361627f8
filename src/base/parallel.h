#pragma once
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

/// Calls body(i) once for each i in [0, count), in any order and on several threads. Exceptions thrown by
/// `body` reach the caller. Work is handed out in runs of `grain` indices.
void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t)>& body);

}  // namespace voxlume
