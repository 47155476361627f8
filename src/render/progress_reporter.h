#pragma once
#include <atomic>
#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

#include "voxlume/renderer.h"

namespace voxlume {

/// Calls a progress callback from a thread of its own, ten times a second and once at the end.
class ProgressReporter {
 public:
  /// Starts reporting what `measure` returns; does nothing when `callback` is empty. Both must outlive this.
  ProgressReporter(const std::function<void(const RenderProgress&)>& callback,
                   std::function<RenderProgress()> measure);
  /// Stops without a last report.
  ~ProgressReporter();
  ProgressReporter(const ProgressReporter&) = delete;
  ProgressReporter& operator=(const ProgressReporter&) = delete;

  /// Whether the callback threw; it is not called again then.
  bool failed() const { return failed_; }
  /// Stops after a last report. Throws what the callback threw.
  void finish();

 private:
  void report_until_stopped();
  void report();
  void stop();

  const std::function<void(const RenderProgress&)>& callback_;
  std::function<RenderProgress()> measure_;
  std::mutex mutex_;
  std::condition_variable stop_requested_;
  bool stopping_ = false;
  bool last_report_ = false;
  std::atomic<bool> failed_{false};
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace voxlume
