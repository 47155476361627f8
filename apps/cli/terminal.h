#pragma once
#include <string>
#include <vector>

#include "base/progress.h"
#include "render/sequence.h"
#include "voxlume/renderer.h"

namespace voxlume::cli {

/// The progress line on standard error. Silent unless that is a terminal.
class ProgressLine {
 public:
  ProgressLine();
  /// Erases the line.
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  bool visible() const { return visible_; }
  void show(const std::string& text);
  /// Shows `what` with the share of it that is done; lives as long as this.
  Progress of(const std::string& what);
  void clear();

 private:
  bool visible_;
};

/// "64 of 128 spp, 1.25 M paths/s, 12 s left".
std::string progress_text(const RenderProgress& progress, const StopRule& stop);

/// "frame 12/120, 3.1 s/frame, 5 min 35 s left".
std::string progress_text(const SequenceProgress& progress);

/// Writes "warning: ..." lines to standard error.
void print_warnings(const std::vector<std::string>& warnings);

}  // namespace voxlume::cli
