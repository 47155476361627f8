#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/wrls_spatial.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/row-inl.h"
#include "denoise/wrls_rows.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// Standard deviation of the spatial filter [pixels].
constexpr float kPixelSigma = 1.5f;
/// What a difference of 1 in alpha is to the spatial filter in units of logarithmic brightness.
constexpr float kAlphaContrast = 2;

/// Means over the pixels around, weighted by how alike they are.
template <int d>
struct Blend {
  F weight, alpha;
  F3 z;
  F beta[3 * d];
};

template <int d>
HWY_INLINE void add_tap(const WrlsModels& models, F weight, int x, int y, Blend<d>& sum) {
  sum.weight = hn::Add(sum.weight, weight);
  sum.alpha = hn::MulAdd(weight, load(models.z_alpha, x, y), sum.alpha);
  if constexpr (d == 4) sum.z = add_scaled(sum.z, load(models.z, x, y), weight);
  for (int i = 0; i < 3 * d; ++i) sum.beta[i] = hn::MulAdd(weight, load(models.beta[i], x, y), sum.beta[i]);
}

template <int d>
void predict_row_of(const WrlsModels& models, const WrlsGuide& guide, int y, DenoisedFrame& out) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f);
  const F alpha_scale = hn::Set(kD, kAlphaContrast * kAlphaContrast);
  const int first = std::max(y - kWrlsReach, 0), last = std::min(y + kWrlsReach, out.alpha.height() - 1);
  for_row(out.alpha.width(), [&](int x, std::size_t lanes) HWY_ATTR {
    const F3 colour = load(guide.colour, x, y);
    const F alpha = load(models.z_alpha, x, y), sharpness = load(guide.sharpness, x, y);
    Blend<d> sum;
    sum.weight = sum.alpha = zero;
    sum.z = {zero, zero, zero};
    for (F& coefficient : sum.beta) coefficient = zero;
    for (int row = first; row <= last; ++row) {
      for (int column = x - kWrlsReach; column <= x + kWrlsReach; ++column) {
        const int dx = column - x, dy = row - y;
        const F3 difference = sub(load(guide.colour, column, row), colour);
        const F step = hn::Sub(load(models.z_alpha, column, row), alpha);
        const F distance = hn::MulAdd(hn::Mul(alpha_scale, step), step, dot(difference, difference));
        const F near =
            hn::Set(kD, -0.5f * static_cast<float>(dx * dx + dy * dy) / (kPixelSigma * kPixelSigma));
        const F alike = exp_approx(hn::MulAdd(distance, sharpness, near));
        add_tap(models, hn::Mul(alike, load(guide.inside, column, row)), column, row, sum);
      }
    }
    const F inverse = hn::Div(one, sum.weight);
    F3 prediction = scale(F3{sum.beta[0], sum.beta[1], sum.beta[2]}, inverse);
    if constexpr (d == 4) {
      const F3 z = scale(sum.z, hn::Mul(inverse, inverse));
      const auto beta = [&](int k) HWY_ATTR {
        return F3{sum.beta[3 * k], sum.beta[3 * k + 1], sum.beta[3 * k + 2]};
      };
      prediction = add_scaled(prediction, beta(1), z.x);
      prediction = add_scaled(prediction, beta(2), z.y);
      prediction = add_scaled(prediction, beta(3), z.z);
    }
    store({hn::Max(prediction.x, zero), hn::Max(prediction.y, zero), hn::Max(prediction.z, zero)},
          out.radiance, x, y, lanes);
    store(hn::Min(hn::Max(hn::Mul(sum.alpha, inverse), zero), one), out.alpha, x, y, lanes);
  });
}

void predict_row(const WrlsModels& models, const WrlsGuide& guide, int y, DenoisedFrame& out) {
  if (models.p.size() == 1)
    predict_row_of<1>(models, guide, y, out);
  else
    predict_row_of<4>(models, guide, y, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(predict_row);

void predict_row(const WrlsModels& models, const WrlsGuide& guide, int y, DenoisedFrame& out) {
  HWY_DYNAMIC_DISPATCH(predict_row)(models, guide, y, out);
}

}  // namespace voxlume
#endif  // HWY_ONCE
