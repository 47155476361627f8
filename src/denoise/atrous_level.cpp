#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/atrous_level.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/parallel.h"
#include "denoise/atrous_level.h"
#include "denoise/guides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

constexpr std::array<float, 3> kB3Spline{3.0f / 8, 1.0f / 4, 1.0f / 16};

struct SignalRows {
  Rows3 radiance;
  const float *alpha, *luminance, *variance;
  SignalRows(const Signal& signal, int row)
      : radiance(signal.radiance, row),
        alpha(signal.alpha.row(row)),
        luminance(signal.luminance.row(row)),
        variance(signal.variance.row(row)) {}
};

/// The mean over 3 x 3 pixels, weighted by a Gaussian and by alpha.
HWY_INLINE F mean_3x3(const float* values, const float* alpha, std::ptrdiff_t stride) {
  F sum = hn::Zero(kD), weights = hn::Zero(kD);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const std::ptrdiff_t i = dy * stride + dx;
      const F weight =
          hn::Mul(hn::Set(kD, (dx ? 0.25f : 0.5f) * (dy ? 0.25f : 0.5f)), hn::LoadU(kD, alpha + i));
      sum = hn::MulAdd(hn::LoadU(kD, values + i), weight, sum);
      weights = hn::Add(weights, weight);
    }
  }
  return hn::Mul(sum, inverse_or_zero(weights));
}

/// What |Y - Y'| is multiplied by. Zero where there is no luminance to compare with.
template <LuminanceStop kStop>
HWY_INLINE F luminance_rate(const SignalRows& in, std::ptrdiff_t stride, int x, float sigma) {
  constexpr bool kByVariance = kStop == LuminanceStop::kVariance;
  const F mean = mean_3x3((kByVariance ? in.variance : in.luminance) + x, in.alpha + x, stride);
  const F luminance = hn::LoadU(kD, in.luminance + x), alpha = hn::LoadU(kD, in.alpha + x);
  const F deviation = kByVariance ? hn::Sqrt(mean) : mean;
  // Rounding makes equal colours differ, and must not keep them apart where there is no noise.
  const F tolerance = hn::MulAdd(hn::Set(kD, sigma), deviation,
                                 hn::MulAdd(luminance, hn::Set(kD, 1e-4f), hn::Set(kD, 1e-30f)));
  return hn::IfThenElseZero(hn::Gt(alpha, hn::Zero(kD)), hn::Div(hn::Set(kD, 1.0f), tolerance));
}

template <LuminanceStop kStop>
void level_row(const Signal& in, const Guides& guides, int step, float sigma, int y, Signal& out) {
  const std::ptrdiff_t stride = in.alpha.stride();
  const auto taps = make_taps<2>(in.alpha.stride(), step, kB3Spline);
  const GuideRows guide_rows(guides, y);
  const SignalRows rows(in, y);
  for_row(in.alpha.width(), [&](int x, std::size_t lanes) {
    const GuideCentre centre = guide_centre(guide_rows, x);
    const F rate = luminance_rate<kStop>(rows, stride, x, sigma);
    const F own = hn::LoadU(kD, rows.luminance + x);
    F3 sum = zero3();
    F weights = hn::Zero(kD), sum_alpha = weights, sum_variance = weights;
    for (const Tap& tap : taps) {
      const std::ptrdiff_t i = x + tap.offset;
      const F difference = hn::AbsDiff(own, hn::LoadU(kD, rows.luminance + i));
      const F weight = exp_approx(hn::NegMulAdd(difference, rate, log_weight(centre, guide_rows, x, tap)));
      const F with_alpha = hn::Mul(weight, hn::LoadU(kD, rows.alpha + i));
      weights = hn::Add(weights, weight);
      sum_alpha = hn::Add(sum_alpha, with_alpha);
      sum = add_scaled(sum, rows.radiance.at(i), weight);
      if (kStop == LuminanceStop::kVariance)
        sum_variance =
            hn::MulAdd(hn::Mul(with_alpha, with_alpha), hn::LoadU(kD, rows.variance + i), sum_variance);
    }
    const F part = hn::Div(hn::Set(kD, 1.0f), weights), by_alpha = inverse_or_zero(sum_alpha);
    store(scale(sum, part), out.radiance, x, y, lanes);
    store(hn::Mul(sum_alpha, part), out.alpha, x, y, lanes);
    store(hn::Mul(luminance(sum), by_alpha), out.luminance, x, y, lanes);
    if (kStop == LuminanceStop::kVariance)
      store(hn::Mul(hn::Mul(sum_variance, by_alpha), by_alpha), out.variance, x, y, lanes);
  });
}

void level_row_by_variance(const Signal& in, const Guides& guides, int step, float sigma, int y,
                           Signal& out) {
  level_row<LuminanceStop::kVariance>(in, guides, step, sigma, y, out);
}
void level_row_by_luminance(const Signal& in, const Guides& guides, int step, float sigma, int y,
                            Signal& out) {
  level_row<LuminanceStop::kLuminance>(in, guides, step, sigma, y, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(level_row_by_variance);
HWY_EXPORT(level_row_by_luminance);

void filter_level(const Signal& in, const Guides& guides, int step, LuminanceStop stop, float sigma,
                  Signal& out) {
  // Rows `step` apart one after the other: they share their neighbours.
  const int height = in.alpha.height(), rows = (height + step - 1) / step;
  parallel_for(static_cast<std::int64_t>(rows) * step, 8, [&](std::int64_t i) {
    const int y = static_cast<int>(i % rows) * step + static_cast<int>(i / rows);
    if (y >= height) return;
    if (stop == LuminanceStop::kVariance) {
      HWY_DYNAMIC_DISPATCH(level_row_by_variance)(in, guides, step, sigma, y, out);
    } else {
      HWY_DYNAMIC_DISPATCH(level_row_by_luminance)(in, guides, step, sigma, y, out);
    }
  });
}

}  // namespace voxlume
#endif  // HWY_ONCE
