#pragma once
#include <bit>
#include <cstdint>

namespace voxlume {

// log(1 + f) = f - f^2/2 + f^3 * polynomial for f in [sqrt(1/2) - 1, sqrt(2) - 1]: the coefficients of
// Cephes' logf (Moshier 1992); ln 2 in two parts.
inline constexpr std::int32_t kSqrtHalfBits = 0x3f3504f3;
inline constexpr float kLogPolynomial[9] = {7.0376836292e-2f,  -1.1514610310e-1f, 1.1676998740e-1f,
                                            -1.2420140846e-1f, 1.4249322787e-1f,  -1.6668057665e-1f,
                                            2.0000714765e-1f,  -2.4999993993e-1f, 3.3333331174e-1f};
inline constexpr float kLn2High = 0.693359375f, kLn2Low = -2.12194440e-4f;

/// -ln x of a normal positive float, to 2 ulp. The vector code does the same arithmetic, so that scalar and
/// vector lanes agree to the last bit.
inline float negative_log(float x) noexcept {
  const auto bits = std::bit_cast<std::int32_t>(x);
  const std::int32_t exponent = (bits - kSqrtHalfBits) >> 23;
  const float f = std::bit_cast<float>(bits - (exponent << 23)) - 1.0f;
  float p = kLogPolynomial[0];
  for (int i = 1; i < 9; ++i) p = p * f + kLogPolynomial[i];
  const float f2 = f * f, e = static_cast<float>(exponent);
  const float tail = (p * f) * f2 + e * kLn2Low - 0.5f * f2;
  const float log = (tail + f) + e * kLn2High;
  return 0.0f - log;
}

}  // namespace voxlume
