#include "denoise/signal.h"

#include <gtest/gtest.h>

#include <random>

#include "support/every_target.h"

namespace voxlume {
namespace {

using test::for_every_target;

constexpr int kWidth = 61, kHeight = 45, kSamples = 8;

/// Shares of kSamples that hit matter of this opacity.
template <class Opacity>
Plane noisy_alpha(const Opacity& opacity, unsigned seed) {
  std::mt19937 random(seed);
  Plane alpha(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      alpha.at(x, y) =
          static_cast<float>(std::binomial_distribution<int>(kSamples, opacity(x, y))(random)) / kSamples;
  }
  return alpha;
}

Plane counts(float value) {
  Plane plane(kWidth, kHeight);
  plane.fill(value);
  return plane;
}

template <class Opacity>
double error(const Plane& alpha, const Opacity& opacity) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) sum += std::pow(alpha.at(x, y) - opacity(x, y), 2);
  }
  return std::sqrt(sum / (kWidth * kHeight));
}

TEST(FilterAlpha, TakesMoreThanHalfOfTheNoiseAway) {
  for_every_target([] {
    const auto translucent = [](int, int) { return 0.4; };
    const Plane noisy = noisy_alpha(translucent, 3);
    Plane out(kWidth, kHeight);
    filter_alpha(noisy, counts(kSamples), out);
    EXPECT_LT(error(out, translucent), error(noisy, translucent) / 2);
  });
}

TEST(FilterAlpha, KeepsOutlinesAndWhatIsOpaqueOrEmpty) {
  for_every_target([] {
    const auto half = [](int x, int) { return x < 30 ? 1.0 : 0.0; };
    const Plane exact = noisy_alpha(half, 1);
    Plane out(kWidth, kHeight);
    filter_alpha(exact, counts(kSamples), out);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(out.at(x, y), exact.at(x, y), 0.01f) << x << ' ' << y;
    }
  });
}

TEST(FilterAlpha, TrustsManySamples) {
  for_every_target([] {
    const Plane noisy = noisy_alpha([](int, int) { return 0.4; }, 3);
    Plane out(kWidth, kHeight);
    filter_alpha(noisy, counts(1e6f), out);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) ASSERT_NEAR(out.at(x, y), noisy.at(x, y), 1e-3f);
    }
  });
}

TEST(FilterAlpha, LeavesPixelsWithoutSamplesAlone) {
  for_every_target([] {
    Plane alpha = counts(0.5f), samples = counts(kSamples), out(kWidth, kHeight);
    alpha.at(10, 10) = 0;
    samples.at(10, 10) = 0;
    filter_alpha(alpha, samples, out);
    EXPECT_EQ(out.at(10, 10), 0);
    EXPECT_NEAR(out.at(11, 10), 0.5f, 1e-6f) << "and nobody takes them";
  });
}

TEST(Compose, GivesColoursTheAlphaOfTheFrame) {
  for_every_target([] {
    Signal colors;
    colors.resize(kWidth, kHeight);
    DenoisedFrame out;
    out.resize(kWidth, kHeight);
    colors.radiance[0].fill(0.3f);
    colors.radiance[1].fill(-0.1f);
    colors.alpha.fill(0.5f);
    out.alpha.fill(0.25f);
    colors.alpha.at(7, 7) = 0;
    compose(colors, out);
    EXPECT_FLOAT_EQ(out.radiance[0].at(3, 3), 0.15f);
    EXPECT_EQ(out.radiance[1].at(3, 3), 0) << "never negative";
    EXPECT_EQ(out.radiance[0].at(7, 7), 0) << "no colour is known";
  });
}

}  // namespace
}  // namespace voxlume
