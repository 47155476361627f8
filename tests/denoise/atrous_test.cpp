#include "denoise/atrous.h"

#include <gtest/gtest.h>

#include "denoise/atrous_level.h"
#include "denoise/brute_force.h"
#include "support/every_target.h"

namespace voxlume {
namespace {

using test::for_every_target;

constexpr int kWidth = 43, kHeight = 31;
constexpr double kKernel[] = {3.0 / 8, 1.0 / 4, 1.0 / 16};

/// A pixel of filter_level.
struct Filtered {
  double color = 0, alpha = 0, variance = 0;
};

double mean_3x3(const Plane& plane, const Plane& alpha, int x, int y) {
  double sum = 0, weights = 0;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const double weight = (dx ? 0.25 : 0.5) * (dy ? 0.25 : 0.5) * alpha.at(x + dx, y + dy);
      sum += weight * plane.at(x + dx, y + dy);
      weights += weight;
    }
  }
  return weights > 0 ? sum / weights : 0;
}

Filtered brute_force(const Signal& in, const Guides& guides, int step, LuminanceStop stop, double sigma,
                     int x, int y) {
  const double tolerance =
      sigma * (stop == LuminanceStop::kVariance ? std::sqrt(mean_3x3(in.variance, in.alpha, x, y))
                                                : mean_3x3(in.luminance, in.alpha, x, y));
  Filtered out;
  double weights = 0;
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const int qx = x + dx * step, qy = y + dy * step;
      double weight = kKernel[std::abs(dx)] * kKernel[std::abs(dy)] * guide_weight(guides, x, y, qx, qy);
      if (in.alpha.at(x, y) > 0)
        weight *= std::exp(-std::abs(in.luminance.at(x, y) - in.luminance.at(qx, qy)) /
                           (tolerance + 1e-4 * in.luminance.at(x, y)));
      weights += weight;
      out.color += weight * in.radiance[1].at(qx, qy);
      out.alpha += weight * in.alpha.at(qx, qy);
      out.variance += std::pow(weight * in.alpha.at(qx, qy), 2) * in.variance.at(qx, qy);
    }
  }
  out.variance = out.alpha > 0 ? out.variance / (out.alpha * out.alpha) : 0;
  out.color /= weights;
  out.alpha /= weights;
  return out;
}

class EveryStop : public testing::TestWithParam<LuminanceStop> {};

TEST_P(EveryStop, ALevelIsTheSumOverFiveByFivePixels) {
  const DenoiseFrame frame = random_frame(kWidth, kHeight, 8);
  Guides guides;
  make_guides(frame, guides);
  Signal in, out;
  load_signal(frame, in);
  out.resize(kWidth, kHeight);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) in.variance.at(x, y) = 0.01f * static_cast<float>((x + 3 * y) % 7);
  }
  for_every_target([&] {
    for (const int step : {1, 4, 16}) {
      filter_level(in, guides, step, GetParam(), 1.5f, out);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          SCOPED_TRACE(testing::Message() << step << ": " << x << ' ' << y);
          const Filtered expected = brute_force(in, guides, step, GetParam(), 1.5, x, y);
          ASSERT_NEAR(out.radiance[1].at(x, y), expected.color, 1e-3 * expected.color + 1e-6);
          ASSERT_NEAR(out.alpha.at(x, y), expected.alpha, 1e-3 * expected.alpha + 1e-6);
          const double variance = GetParam() == LuminanceStop::kVariance ? expected.variance : 0;
          ASSERT_NEAR(out.variance.at(x, y), variance, 2e-3 * variance + 1e-8);
          const double light =
              luminance(Vec3d(out.radiance[0].at(x, y), out.radiance[1].at(x, y), out.radiance[2].at(x, y)));
          ASSERT_NEAR(out.luminance.at(x, y) * out.alpha.at(x, y), light, 1e-4 * light + 1e-6);
        }
      }
    }
  });
}

INSTANTIATE_TEST_SUITE_P(Stops, EveryStop,
                         testing::Values(LuminanceStop::kVariance, LuminanceStop::kLuminance));

TEST(ATrous, DoesNotCrossEdgesOfDepth) {
  const auto near_and_far = [](int x, int) {
    return TestPixel{.radiance = Vec3f(x < 20 ? 1.0f : 0.8f), .depth_mm = x < 20 ? 400.0f : 600.0f};
  };
  const DenoiseFrame frame = test_frame(kWidth, kHeight, near_and_far, 0, 1, 1000);
  DenoisedFrame out;
  make_atrous()->denoise(frame, out);
  EXPECT_LT(difference(out.radiance, frame.radiance), 1e-3);
}

TEST(ATrous, SmoothsFartherThanABilateralFilterOfItsFirstLevel) {
  const auto grey = [](int, int) { return TestPixel{}; };
  const DenoiseFrame noisy = test_frame(kWidth, kHeight, grey, 0.4, 6);
  const Planes3 exact = test_frame(kWidth, kHeight, grey).radiance;
  DenoisedFrame out;
  make_atrous()->denoise(noisy, out);
  EXPECT_LT(difference(out.radiance, exact), difference(noisy.radiance, exact) / 10);
}

}  // namespace
}  // namespace voxlume
