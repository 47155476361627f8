// Weighted recursive least squares, one model a lane; included once for every target.
#if defined(VOXLUME_DENOISE_RECURSIVE_LEAST_SQUARES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_RECURSIVE_LEAST_SQUARES_INL_H_
#undef VOXLUME_DENOISE_RECURSIVE_LEAST_SQUARES_INL_H_
#else
#define VOXLUME_DENOISE_RECURSIVE_LEAST_SQUARES_INL_H_
#endif

#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// The place of P(a, b) in the upper triangle of a d x d matrix, a <= b.
constexpr int triangle_index(int d, int a, int b) { return a * d - a * (a - 1) / 2 + b - a; }

/// Linear models of three channels over one predictor of d elements.
template <int d>
struct LinearModel {
  static constexpr int kTriangle = d * (d + 1) / 2;
  F p[kTriangle];  ///< inverse covariance of the predictors, upper triangle
  F beta[3 * d];   ///< coefficient a of channel c at 3 a + c

  HWY_INLINE F& at(int a, int b) { return p[triangle_index(d, a < b ? a : b, a < b ? b : a)]; }

  HWY_INLINE F3 predict(const F (&predictor)[d]) const {
    F3 sum{beta[0], beta[1], beta[2]};
    for (int a = 1; a < d; ++a)
      sum = add_scaled(sum, F3{beta[3 * a], beta[3 * a + 1], beta[3 * a + 2]}, predictor[a]);
    return sum;
  }

  /// Moves along `direction` by the error, and takes gain * direction direction^T from P.
  HWY_INLINE void learn(const F (&direction)[d], F gain, F3 error) {
    const F3 step = scale(error, gain);
    for (int a = 0; a < d; ++a) {
      beta[3 * a] = hn::MulAdd(direction[a], step.x, beta[3 * a]);
      beta[3 * a + 1] = hn::MulAdd(direction[a], step.y, beta[3 * a + 1]);
      beta[3 * a + 2] = hn::MulAdd(direction[a], step.z, beta[3 * a + 2]);
      const F along = hn::Mul(gain, direction[a]);
      for (int b = a; b < d; ++b) at(a, b) = hn::NegMulAdd(along, direction[b], at(a, b));
    }
  }

  /// iglesias2020 eqs. 8, 9, 11 and 14 with forgetting factor lambda, written so that nothing is divided by
  /// the weight, which may be 0. predictor[0] is 1. The weight is lowered where w p P p^T > largest_gain.
  HWY_INLINE void observe(const F (&predictor)[d], F3 value, F weight, float lambda, float largest_gain) {
    F direction[d];  // P p^T
    F spread = hn::Zero(kD);
    for (int a = 0; a < d; ++a) {
      direction[a] = at(a, 0);
      for (int b = 1; b < d; ++b) direction[a] = hn::MulAdd(at(a, b), predictor[b], direction[a]);
      spread = hn::MulAdd(predictor[a], direction[a], spread);
    }
    // Past rounding, P is positive definite and the spread above 0.
    spread = hn::Max(spread, hn::Set(kD, 1e-30f));
    weight = hn::Min(weight, hn::Div(hn::Set(kD, largest_gain), spread));
    const F gain = hn::Div(weight, hn::MulAdd(weight, spread, hn::Set(kD, lambda)));
    learn(direction, gain, sub(value, predict(predictor)));
    for (F& element : p) element = hn::Mul(element, hn::Set(kD, 1 / lambda));
  }

  /// Where P(k, k) exceeds `limit`, nothing has been learned about coefficient k for long: takes it for
  /// observed to be `expected`, with the weight that brings P(k, k) down to the limit.
  HWY_INLINE void limit_ignorance(int k, F limit, F3 expected) {
    const F variance = at(k, k), one = hn::Set(kD, 1.0f);
    const F weight = hn::Max(hn::Zero(kD), hn::Sub(hn::Div(one, limit), hn::Div(one, variance)));
    F direction[d];
    for (int a = 0; a < d; ++a) direction[a] = at(a, k);
    const F gain = hn::Div(weight, hn::MulAdd(weight, variance, one));
    learn(direction, gain, sub(expected, F3{beta[3 * k], beta[3 * k + 1], beta[3 * k + 2]}));
  }
};

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
