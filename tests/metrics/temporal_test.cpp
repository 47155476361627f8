#include "metrics/temporal.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pictures.h"
#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume::test {
namespace {

TEST(TemporalVariance, ByTheDefinition) {
  constexpr int kPictures = 50, kPixels = 7 * 5;
  for (const PixelValues values : {PixelValues::kLinear, PixelValues::kDisplay}) {
    std::vector<Image> pictures;
    TemporalVariance variance(values);
    for (int i = 0; i < kPictures; ++i) {
      pictures.push_back(noise(7, 5, 100 + i));
      variance.add(pictures.back());
    }
    EXPECT_EQ(variance.count(), kPictures);
    const auto value_of = [&](const Image& picture, int i) -> double {
      return values == PixelValues::kLinear ? picture.rgba[i] : srgb_from_linear(picture.rgba[i]);
    };
    double total = 0;
    for (int pixel = 0; pixel < kPixels; ++pixel) {
      double expected = 0;
      for (int c = 0; c < 3; ++c) {
        double mean = 0, squares = 0;
        for (const Image& picture : pictures) mean += value_of(picture, 4 * pixel + c) / kPictures;
        for (const Image& picture : pictures) squares += std::pow(value_of(picture, 4 * pixel + c) - mean, 2);
        expected += squares / (kPictures - 1);
      }
      EXPECT_NEAR(variance.per_pixel()[pixel], expected, 1e-12);
      total += expected;
    }
    EXPECT_NEAR(variance.sum(), total, 1e-10);
    EXPECT_NEAR(variance.mean(), total / kPixels, 1e-12);
  }
}

TEST(TemporalVariance, HandComputed) {
  TemporalVariance variance(PixelValues::kLinear);
  for (const float value : {1.0f, 2.0f, 6.0f}) variance.add(constant(2, 2, Vec3f(value, 0, 0)));
  EXPECT_DOUBLE_EQ(variance.mean(), 7.0);  // (4 + 1 + 9) / 2, of R alone
  EXPECT_DOUBLE_EQ(variance.sum(), 28.0);
}

// The difference of a mean of squares and a squared mean would be lost in 1e6^2 * 2^-53 = 1e-4.
TEST(TemporalVariance, FarFromZero) {
  TemporalVariance variance(PixelValues::kLinear);
  for (int i = 0; i < 1000; ++i) variance.add(constant(1, 1, Vec3f(1e6f + (i % 2 ? 0.0625f : 0.0f), 0, 0)));
  EXPECT_NEAR(variance.sum(), 0.03125 * 0.03125 * 1000 / 999, 1e-9);
}

TEST(TemporalVariance, OfTheSamePictureIsZero) {
  TemporalVariance variance;
  for (int i = 0; i < 3; ++i) variance.add(noise(6, 4, 9));
  EXPECT_EQ(variance.sum(), 0.0);
}

TEST(TemporalVariance, RefusesWhatDoesNotFit) {
  TemporalVariance variance;
  EXPECT_THROW(variance.sum(), Error);
  EXPECT_THROW(variance.add(Image()), Error);
  variance.add(constant(3, 2, 1));
  EXPECT_THROW(variance.per_pixel(), Error);
  EXPECT_THROW(variance.add(constant(2, 3, 1)), Error);
  EXPECT_THROW(variance.add(constant(3, 2, std::nanf(""))), Error);
  EXPECT_EQ(variance.count(), 1);
  variance.add(constant(3, 2, 0.5f));
  EXPECT_GT(variance.mean(), 0);
}

// Frame i shows 1/2 + 2^-i / 4: the change of frame i is 2^-i / 4.
Image decaying(int frame) { return constant(4, 3, 0.5f + 0.25f * std::exp2f(static_cast<float>(-frame))); }

TEST(ConvergenceTime, ExponentialDecay) {
  ConvergenceTime time(0.01, PixelValues::kLinear);
  for (int i = 0; i < 12; ++i) {
    time.add(decaying(i), 0.25 * i);
    EXPECT_EQ(time.converged().has_value(), i >= 5) << i;
  }
  // 2^-4 / 4 = 0.0156, 2^-5 / 4 = 0.0078.
  EXPECT_EQ(time.converged()->frame, 5);
  EXPECT_EQ(time.converged()->seconds, 1.25);
  EXPECT_EQ(time.settled()->frame, 5);
  ASSERT_EQ(time.changes().size(), 11u);
  for (int i = 1; i < 12; ++i) EXPECT_NEAR(time.changes()[i - 1], 0.25 * std::exp2(-i), 1e-7);
}

TEST(ConvergenceTime, SettlesLaterThanItConvergesByLuck) {
  ConvergenceTime time(0.01, PixelValues::kLinear);
  const float values[] = {0.5f, 0.505f, 0.6f, 0.602f, 0.603f};
  for (int i = 0; i < 5; ++i) {
    time.add(constant(4, 3, values[i]), 10 + i);
    if (i == 1) {
      EXPECT_EQ(time.settled()->frame, 1);
    }
    if (i == 2) {
      EXPECT_FALSE(time.settled().has_value());
    }
  }
  EXPECT_EQ(time.converged()->frame, 1);
  EXPECT_EQ(time.converged()->seconds, 11);
  EXPECT_EQ(time.settled()->frame, 3);
  EXPECT_EQ(time.settled()->seconds, 13);
}

TEST(ConvergenceTime, ThresholdIsNotBelowItself) {
  ConvergenceTime time(0.25, PixelValues::kLinear);
  time.add(constant(2, 2, 0.5f), 0);
  time.add(constant(2, 2, 0.75f), 1);
  EXPECT_FALSE(time.converged().has_value());
  time.add(constant(2, 2, 0.8125f), 2);
  EXPECT_EQ(time.converged()->frame, 2);
}

TEST(ConvergenceTime, LooksAtWhatADisplayShows) {
  ConvergenceTime time;
  time.add(constant(2, 2, linear_from_srgb(0.50f)), 0);
  time.add(constant(2, 2, linear_from_srgb(0.52f)), 1);
  EXPECT_NEAR(time.changes()[0], 0.02, 1e-6);
  EXPECT_FALSE(time.converged().has_value());
  time.add(constant(2, 2, 5), 2);
  time.add(constant(2, 2, 9), 3);
  EXPECT_EQ(time.converged()->frame, 3);
}

TEST(ConvergenceTime, RefusesWhatDoesNotFit) {
  ConvergenceTime time;
  EXPECT_THROW(time.add(Image(), 0), Error);
  time.add(constant(3, 2, 1), 0);
  EXPECT_THROW(time.add(constant(2, 3, 1), 1), Error);
  EXPECT_THROW(time.add(constant(3, 2, std::nanf("")), 1), Error);
  EXPECT_TRUE(time.changes().empty());
  time.add(constant(3, 2, 1), 1);
  EXPECT_EQ(time.converged()->frame, 1);
}

}  // namespace
}  // namespace voxlume::test
