#include "cli/terminal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace voxlume::cli {
namespace {

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::ceil(std::min(seconds, 1e9)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

}  // namespace

ProgressLine::ProgressLine() : visible_(::isatty(STDERR_FILENO) == 1) {}
ProgressLine::~ProgressLine() { clear(); }

void ProgressLine::show(const std::string& text) {
  if (!visible_) return;
  fmt::print(stderr, "\r\033[K{}", text);  // ANSI: back to the first column, erase the line
  std::fflush(stderr);
}

Progress ProgressLine::of(const std::string& what) {
  if (!visible_) return {};
  return [this, what](double share) { show(fmt::format("{}: {:.0f} %", what, 100 * share)); };
}

void ProgressLine::clear() { show(""); }

std::string progress_text(const RenderProgress& progress, const StopRule& stop) {
  std::string text = fmt::format("{:.0f}", std::floor(progress.spp));
  if (stop.spp) text += fmt::format(" of {}", *stop.spp);
  text += fmt::format(" spp, {:.3g} M paths/s", progress.samples_per_s * 1e-6);
  if (progress.noise && stop.noise)
    text += fmt::format(", noise {:.3g} of {:.3g}", *progress.noise, *stop.noise);
  if (progress.remaining_s) text += ", " + duration_text(*progress.remaining_s) + " left";
  return text;
}

std::string progress_text(const SequenceProgress& progress) {
  std::string text = fmt::format("frame {}/{}", progress.position, progress.count);
  if (progress.s_per_frame) text += fmt::format(", {:.3g} s/frame", *progress.s_per_frame);
  if (progress.remaining_s) text += ", " + duration_text(*progress.remaining_s) + " left";
  return text;
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (std::string line : warnings) {
    std::replace_if(
        line.begin(), line.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    fmt::print(stderr, "warning: {}\n", line);
  }
}

}  // namespace voxlume::cli
