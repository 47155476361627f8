#include "render/progress_reporter.h"

#include <chrono>
#include <utility>

namespace voxlume {

ProgressReporter::ProgressReporter(const std::function<void(const RenderProgress&)>& callback,
                                   std::function<RenderProgress()> measure)
    : callback_(callback), measure_(std::move(measure)) {
  if (callback_) thread_ = std::thread([this] { report_until_stopped(); });
}

ProgressReporter::~ProgressReporter() { stop(); }

void ProgressReporter::finish() {
  last_report_ = true;
  stop();
  if (failure_) std::rethrow_exception(failure_);
}

void ProgressReporter::stop() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  stop_requested_.notify_one();
  thread_.join();
}

void ProgressReporter::report_until_stopped() {
  std::unique_lock lock(mutex_);
  while (!stop_requested_.wait_for(lock, std::chrono::milliseconds(100), [this] { return stopping_; })) {
    lock.unlock();
    report();
    lock.lock();
  }
  lock.unlock();
  if (last_report_) report();
}

void ProgressReporter::report() {
  if (failed_) return;
  try {
    callback_(measure_());
  } catch (...) {
    failure_ = std::current_exception();
    failed_ = true;
  }
}

}  // namespace voxlume
