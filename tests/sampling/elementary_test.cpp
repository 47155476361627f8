#include "sampling/elementary.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace voxlume {
namespace {

TEST(Elementary, SineAndCosineOfTurns) {
  double worst = 0;
  for (int i = -(1 << 20); i <= 2 << 20; ++i) {
    const float turns = static_cast<float>(i) * 0x1p-20f;
    const SineCosine at = sine_cosine_of_turns(turns);
    const double angle = 2 * std::numbers::pi * turns;
    worst = std::max({worst, std::abs(at.sine - std::sin(angle)), std::abs(at.cosine - std::cos(angle))});
  }
  EXPECT_LT(worst, 2e-7);
}

TEST(Elementary, QuarterTurnsAreExact) {
  const float sines[] = {0, 1, 0, -1}, cosines[] = {1, 0, -1, 0};
  for (int q = 0; q < 4; ++q) {
    const SineCosine at = sine_cosine_of_turns(0.25f * static_cast<float>(q));
    EXPECT_EQ(at.sine, sines[q]);
    EXPECT_EQ(at.cosine, cosines[q]);
  }
}

TEST(Elementary, OneMinusExpKeepsItsPrecisionNearZero) {
  double worst = 0;
  for (double x = 1e-30; x < 200; x *= 1.0001) {
    const auto argument = static_cast<float>(x);
    const double expected = -std::expm1(-double{argument});
    worst = std::max(worst, std::abs(one_minus_exp(argument) / expected - 1));
  }
  EXPECT_LT(worst, 3e-7);
}

TEST(Elementary, OneMinusExpAtItsLimits) {
  EXPECT_EQ(one_minus_exp(0.0f), 0.0f);
  EXPECT_EQ(one_minus_exp(1000.0f), 1.0f);
  EXPECT_EQ(one_minus_exp(std::numeric_limits<float>::infinity()), 1.0f);
  EXPECT_EQ(one_minus_exp(std::numeric_limits<float>::quiet_NaN()), 1.0f);
}

}  // namespace
}  // namespace voxlume
