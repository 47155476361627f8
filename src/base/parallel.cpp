#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <utility>
#ifdef __SANITIZE_THREAD__
#include <algorithm>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>
#endif

namespace voxlume {

ThreadLimit::ThreadLimit(int threads)
    : control_(threads > 0 ? new tbb::global_control(tbb::global_control::max_allowed_parallelism, threads)
                           : nullptr) {}

ThreadLimit::~ThreadLimit() { delete static_cast<tbb::global_control*>(control_); }

int thread_count() {
  return static_cast<int>(tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism));
}

namespace {
thread_local const std::atomic<bool>* t_cancel = nullptr;

void check(const std::atomic<bool>* cancel) {
  if (cancel != nullptr && cancel->load(std::memory_order_relaxed)) throw Cancelled();
}
}  // namespace

CancelScope::CancelScope(const std::atomic<bool>& flag) : outer_(std::exchange(t_cancel, &flag)) {}
CancelScope::~CancelScope() { t_cancel = outer_; }

void throw_if_cancelled() { check(t_cancel); }

#ifdef __SANITIZE_THREAD__
// The sanitizer sees nothing of how a thread library that is not built with it hands work over, and takes
// that for races. Plain threads show it our own.
void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t)>& body) {
  const std::atomic<bool>* const cancel = t_cancel;
  std::atomic<std::int64_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::int64_t begin = next.fetch_add(grain); begin < count; begin = next.fetch_add(grain)) {
        check(cancel);
        for (std::int64_t i = begin; i < std::min(count, begin + grain); ++i) body(i);
      }
    } catch (...) {
      const std::lock_guard lock(failure_mutex);
      failure = std::current_exception();
      next = count;
    }
  };
  std::vector<std::thread> threads;
  for (int t = 1; t < thread_count(); ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();
  if (failure) std::rethrow_exception(failure);
}
#else
void parallel_for(std::int64_t count, std::int64_t grain, const std::function<void(std::int64_t)>& body) {
  const std::atomic<bool>* const cancel = t_cancel;
  // An arena of its own: the default one has as many slots as the machine has cores, and would ignore a
  // request for more threads than that.
  tbb::task_arena arena(thread_count());
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::int64_t>(0, count, grain),
        [&](const tbb::blocked_range<std::int64_t>& range) {
          check(cancel);
          for (std::int64_t i = range.begin(); i != range.end(); ++i) body(i);
        },
        tbb::simple_partitioner());
  });
}
#endif

}  // namespace voxlume
