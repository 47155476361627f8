#pragma once
#include <bit>
#include <cstdint>

namespace voxlume {

// Functions whose vector twins (sampling/vector_math-inl.h) do the same arithmetic, so that scalar and vector
// lanes agree to the last bit. Polynomials: the coefficients of Cephes' sinf, cosf and expf (Moshier 1992).

// sin x = x + x^3 kSine(x^2) and cos x = 1 - x^2/2 + x^4 kCosine(x^2) for |x| <= pi/4.
inline constexpr float kSinePolynomial[3] = {-1.9515295891e-4f, 8.3321608736e-3f, -1.6666654611e-1f};
inline constexpr float kCosinePolynomial[3] = {2.443315711809948e-5f, -1.388731625493765e-3f,
                                               4.166664568298827e-2f};
inline constexpr float kTwoPi = 6.28318530717958647692f;

struct SineCosine {
  float sine, cosine;
};

/// Sine and cosine of 2 pi `turns`, to 2e-7; turns in [-1, 2].
inline SineCosine sine_cosine_of_turns(float turns) noexcept {
  const std::int32_t quarter = static_cast<std::int32_t>(4.0f * turns + 4.5f) - 4;  // the nearest
  const float x = (turns - 0.25f * static_cast<float>(quarter)) * kTwoPi, x2 = x * x;
  float s = kSinePolynomial[0], c = kCosinePolynomial[0];
  for (int i = 1; i < 3; ++i) {
    s = s * x2 + kSinePolynomial[i];
    c = c * x2 + kCosinePolynomial[i];
  }
  s = (s * x2) * x + x;
  c = ((c * x2) * x2 - 0.5f * x2) + 1.0f;
  const bool swapped = (quarter & 1) != 0;
  const float sine = swapped ? c : s, cosine = swapped ? s : c;
  return {(quarter & 2) != 0 ? -sine : sine, ((quarter + 1) & 2) != 0 ? -cosine : cosine};
}

// exp(r) = 1 + r + r^2 kExp(r) for |r| <= ln(2) / 2; ln 2 in two parts.
inline constexpr float kExpPolynomial[6] = {1.9875691500e-4f, 1.3981999507e-3f, 8.3334519073e-3f,
                                            4.1665795894e-2f, 1.6666665459e-1f, 5.0000001201e-1f};
inline constexpr float kLog2OfE = 1.44269504088896341f;
inline constexpr float kExpLn2High = 0.693359375f, kExpLn2Low = -2.12194440e-4f;
inline constexpr float kExpEnd = 87;  ///< exp(-87) is nothing beside 1

/// 1 - exp(-x) for x >= 0, with a relative error below 3e-7; 1 for NaN.
inline float one_minus_exp(float x) noexcept {
  const float within = x < kExpEnd ? x : kExpEnd;
  const auto halvings = static_cast<std::int32_t>(within * kLog2OfE + 0.5f);
  const float n = static_cast<float>(halvings);
  const float r = (n * kExpLn2High - within) + n * kExpLn2Low;
  float p = kExpPolynomial[0];
  for (int i = 1; i < 6; ++i) p = p * r + kExpPolynomial[i];
  const float expm1 = (p * r) * r + r;
  const float scale = std::bit_cast<float>((127 - halvings) << 23);
  return (1.0f - scale) - scale * expm1;
}

}  // namespace voxlume
