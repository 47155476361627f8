#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/gradient.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <utility>

#include "base/parallel.h"
#include "denoise/gradient.h"
#include "denoise/guides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

using Strata = TemporalGradient::Strata;

/// Tolerated difference in luminance, in standard deviations; as sigma_l of schied2017.
constexpr float kLuminanceSigma = 4;

void level_row(const Strata& in, const Plane& depth_mm, const Plane& depth_rate, int step, int y,
               Strata& out) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f);
  const auto taps = make_taps<1>(depth_mm.stride(), step, {1, 1});
  const auto at = [&](const Plane& plane, std::ptrdiff_t i) { return hn::LoadU(kD, plane.row(y) + i); };
  for_row(depth_mm.width(), [&](int x, std::size_t lanes) {
    const F depth = at(depth_mm, x), rate = at(depth_rate, x), own = at(in.luminance, x);
    const F tolerance = hn::MulAdd(hn::Set(kD, kLuminanceSigma), hn::Sqrt(at(in.variance, x)),
                                   hn::MulAdd(own, hn::Set(kD, 1e-4f), hn::Set(kD, 1e-30f)));
    const F luminance_rate = hn::IfThenElseZero(hn::Gt(depth, zero), hn::Div(one, tolerance));
    F weights = zero, difference = zero, larger = zero, luminance = zero, variance = zero;
    for (const Tap& tap : taps) {
      const std::ptrdiff_t i = x + tap.offset;
      const F far =
          hn::Mul(hn::AbsDiff(depth, at(depth_mm, i)), hn::Mul(rate, hn::Set(kD, tap.inverse_distance)));
      const F unlike = hn::MulAdd(hn::AbsDiff(own, at(in.luminance, i)), luminance_rate, far);
      const F weight = exp_approx(hn::Neg(unlike));
      weights = hn::Add(weights, weight);
      difference = hn::MulAdd(at(in.difference, i), weight, difference);
      larger = hn::MulAdd(at(in.larger, i), weight, larger);
      luminance = hn::MulAdd(at(in.luminance, i), weight, luminance);
      variance = hn::MulAdd(hn::Mul(weight, weight), at(in.variance, i), variance);
    }
    const F part = hn::Div(one, weights);
    store(hn::Mul(difference, part), out.difference, x, y, lanes);
    store(hn::Mul(larger, part), out.larger, x, y, lanes);
    store(hn::Mul(luminance, part), out.luminance, x, y, lanes);
    store(hn::Mul(variance, hn::Mul(part, part)), out.variance, x, y, lanes);
  });
}

void change_row(const Strata& in, int y, Plane& change) {
  for_row(change.width(), [&](int x, std::size_t lanes) {
    F most = hn::Zero(kD);
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        const F difference = hn::Abs(load(in.difference, x + dx, y + dy));
        most = hn::Max(most, hn::Mul(difference, inverse_or_zero(load(in.larger, x + dx, y + dy))));
      }
    }
    store(hn::Min(most, hn::Set(kD, 1.0f)), change, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(level_row);
HWY_EXPORT(change_row);

namespace {

struct Stratum {
  float depth_mm = 0, depth_rate = 0, luminance = 0, variance = 0;
};

/// Means over the pixels of a stratum that have matter, weighted by alpha; zero without.
Stratum mean_of_pixels(const DenoiseFrame& frame, const Guides& guides, int column, int row) {
  Stratum sum;
  float weights = 0;
  for (int y = 3 * row; y < std::min(3 * row + 3, frame.height); ++y) {
    for (int x = 3 * column; x < std::min(3 * column + 3, frame.width); ++x) {
      const float alpha = frame.alpha.at(x, y);
      if (!(alpha > 0)) continue;
      const float light = luminance(
          Vec3f(frame.radiance[0].at(x, y), frame.radiance[1].at(x, y), frame.radiance[2].at(x, y)));
      weights += alpha;
      sum.depth_mm += alpha * guides.depth_mm.at(x, y);
      sum.depth_rate += alpha * guides.depth_rate.at(x, y);
      sum.luminance += light;
      sum.variance += light * light / alpha;
    }
  }
  if (!(weights > 0)) return {};
  const float mean = sum.luminance / weights;
  return {sum.depth_mm / weights, sum.depth_rate / weights / 3, mean,
          std::max(0.0f, sum.variance / weights - mean * mean)};
}

}  // namespace

const Plane& TemporalGradient::operator()(const DenoiseFrame& frame, const Guides& guides) {
  const GradientSamples& samples = *frame.gradients;
  const int width = samples.now.width(), height = samples.now.height();
  if (change_.width() != width || change_.height() != height) {
    depth_mm_ = depth_rate_ = change_ = Plane(width, height);
    for (Strata& strata : strata_) strata = {change_, change_, change_, change_};
  }
  const auto for_rows = [&](const auto& body) {
    parallel_for(height, 4, [&](std::int64_t y) { body(static_cast<int>(y)); });
  };
  for_rows([&](int y) {
    for (int x = 0; x < width; ++x) {
      const Stratum stratum = mean_of_pixels(frame, guides, x, y);
      const float now = samples.now.at(x, y), before = samples.before.at(x, y);
      const bool valid = samples.valid.at(x, y) > 0;
      depth_mm_.at(x, y) = stratum.depth_mm;
      depth_rate_.at(x, y) = stratum.depth_rate;
      strata_[0].luminance.at(x, y) = stratum.luminance;
      strata_[0].variance.at(x, y) = stratum.variance;
      strata_[0].difference.at(x, y) = valid ? now - before : 0;
      strata_[0].larger.at(x, y) = valid ? std::max(now, before) : 0;
    }
  });
  int from = 0;
  for (int level = 0; level < 5; ++level, from = 1 - from) {
    for_rows([&](int y) {
      HWY_DYNAMIC_DISPATCH(level_row)
      (strata_[from], depth_mm_, depth_rate_, 1 << level, y, strata_[1 - from]);
    });
  }
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(change_row)(strata_[from], y, change_); });
  return change_;
}

}  // namespace voxlume
#endif  // HWY_ONCE
