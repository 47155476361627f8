#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/signal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/parallel.h"
#include "denoise/row-inl.h"
#include "denoise/signal.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

void load_row(const DenoiseFrame& frame, int y, Signal& out) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F3 radiance = load(frame.radiance, x, y);
    const F alpha = load(frame.alpha, x, y);
    store(radiance, out.radiance, x, y, lanes);
    store(alpha, out.alpha, x, y, lanes);
    store(hn::Mul(luminance(radiance), inverse_or_zero(alpha)), out.luminance, x, y, lanes);
  });
}

void filter_alpha_row(const Plane& alpha, const Plane& counts, int y, Plane& out) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f);
  for_row(alpha.width(), [&](int x, std::size_t lanes) {
    F sum = zero, weights = zero;
    const auto for_taps = [&](const auto& body) {
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) body(load(alpha, x + dx, y + dy), load(counts, x + dx, y + dy));
      }
    };
    for_taps([&](F a, F n) {
      sum = hn::MulAdd(a, n, sum);
      weights = hn::Add(weights, n);
    });
    const F mean = hn::Div(sum, hn::Max(weights, hn::Set(kD, 1e-20f)));
    const F centre = load(alpha, x, y), count = load(counts, x, y);
    const F chance = hn::Mul(hn::Set(kD, 4.0f), hn::Mul(mean, hn::Max(hn::Sub(one, mean), zero)));
    const F rate = hn::Div(count, hn::Max(chance, hn::Set(kD, 1e-6f)));
    sum = weights = zero;
    for_taps([&](F a, F n) {
      const F difference = hn::Sub(a, centre);
      const F weight = hn::Mul(n, exp_approx(hn::Neg(hn::Mul(hn::Mul(difference, difference), rate))));
      sum = hn::MulAdd(a, weight, sum);
      weights = hn::Add(weights, weight);
    });
    const F filtered = hn::Min(one, hn::Div(sum, hn::Max(weights, hn::Set(kD, 1e-20f))));
    store(hn::IfThenElse(hn::Gt(count, zero), filtered, centre), out, x, y, lanes);
  });
}

void compose_row(const Signal& colors, int y, DenoisedFrame& out) {
  for_row(out.alpha.width(), [&](int x, std::size_t lanes) {
    const F part = hn::Mul(load(out.alpha, x, y), inverse_or_zero(load(colors.alpha, x, y)));
    const F3 radiance = scale(load(colors.radiance, x, y), part);
    const F zero = hn::Zero(kD);
    store(F3{hn::Max(radiance.x, zero), hn::Max(radiance.y, zero), hn::Max(radiance.z, zero)}, out.radiance,
          x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(load_row);
HWY_EXPORT(filter_alpha_row);
HWY_EXPORT(compose_row);

void Signal::resize(int width, int height) {
  if (alpha.width() == width && alpha.height() == height) return;
  radiance = make_planes3(width, height);
  alpha = luminance = variance = Plane(width, height);
}

void load_signal(const DenoiseFrame& frame, Signal& out) {
  out.resize(frame.width, frame.height);
  parallel_for(frame.height, 8, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(load_row)(frame, static_cast<int>(y), out);
  });
}

void filter_alpha(const Plane& alpha, const Plane& counts, Plane& out) {
  parallel_for(alpha.height(), 8, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(filter_alpha_row)(alpha, counts, static_cast<int>(y), out);
  });
}

void compose(const Signal& colors, DenoisedFrame& out) {
  parallel_for(out.alpha.height(), 8, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(compose_row)(colors, static_cast<int>(y), out);
  });
}

}  // namespace voxlume
#endif  // HWY_ONCE
