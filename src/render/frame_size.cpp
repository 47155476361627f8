#include "render/frame_size.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace voxlume {
namespace {

/// What the sides are divided by.
constexpr std::array<double, 10> kShrink{1, 1.25, 1.5, 2, 2.5, 3, 4, 5, 6, 8};
/// A size is left when it takes so many budgets, for a finer one when that is expected to take so few.
constexpr double kTooSlow = 1.2, kFastEnough = 0.8;
constexpr int kMaxSpp = 4;  // more are worth less than a smoother motion
/// How much the newest frame counts.
constexpr double kNew = 0.3;

/// With so many samples for each that a frame has, a still picture errs at most 3/4 as much as the moving one
/// even on smooth matter, where one sees mottles (bench/first_still.cpp): after a moving picture that is less
/// coarse and has a history, and after another.
constexpr int kAfterGood = 8, kAfterPoor = 4;
constexpr int kLongHistory = 4;  // frames
constexpr double kCoarse = 2.75;

FrameSize shrunk(int full_width, int full_height, int step) {
  const auto side = [&](int full) {
    return std::max(1, static_cast<int>(std::lround(full / kShrink[static_cast<std::size_t>(step)])));
  };
  return {side(full_width), side(full_height), 1};
}

}  // namespace

int first_still_spp(const FrameSize& moving, int frames, int full_width) {
  const bool good = frames >= kLongHistory && full_width < kCoarse * moving.width;
  return moving.spp * (good ? kAfterGood : kAfterPoor);
}

double FrameSizeChoice::expected_s(const FrameSize& size) const {
  const double pixels = static_cast<double>(size.width) * size.height;
  return cost_.fixed_s + pixels * (size.spp * cost_.per_sample_s + cost_.per_pixel_s);
}

FrameSize FrameSizeChoice::next(int full_width, int full_height) {
  const auto expected = [&](int step) { return expected_s(shrunk(full_width, full_height, step)); };
  constexpr int kLast = static_cast<int>(kShrink.size()) - 1;
  if (known_) {
    if (expected(step_) > kTooSlow * budget_s_)
      while (step_ < kLast && expected(step_) > budget_s_) ++step_;
    else
      while (step_ > 0 && expected(step_ - 1) < kFastEnough * budget_s_) --step_;
  }
  FrameSize size = shrunk(full_width, full_height, step_);
  if (!known_ || step_ > 0) return size;
  for (FrameSize more = size; more.spp <= kMaxSpp && expected_s(more) < kFastEnough * budget_s_; ++more.spp)
    size = more;
  return size;
}

void FrameSizeChoice::learn(const FrameSize& size, double fixed_s, double trace_s, double rest_s) {
  const double pixels = static_cast<double>(size.width) * size.height;
  const FrameCost now{fixed_s, trace_s / (pixels * size.spp), rest_s / pixels};
  const auto blend = [&](double& old, double value) { old = known_ ? old + kNew * (value - old) : value; };
  blend(cost_.fixed_s, now.fixed_s);
  blend(cost_.per_sample_s, now.per_sample_s);
  blend(cost_.per_pixel_s, now.per_pixel_s);
  known_ = true;
}

}  // namespace voxlume
