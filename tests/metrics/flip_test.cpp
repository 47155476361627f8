#include "metrics/flip.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "base/parallel.h"
#include "flip_reference.h"
#include "pictures.h"
#include "voxlume/error.h"

namespace voxlume::test {
namespace {

constexpr double kPpd = kFlipPixelsPerDegree;

float largest(const FlipError& error) { return *std::max_element(error.map.begin(), error.map.end()); }

// A scene of sorts: a soft gradient, a bright square, a coloured line.
Image drawing(int width, int height) {
  Image image = constant(width, height, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      float* p = image.pixel(x, y);
      p[0] = 0.4f * static_cast<float>(x) / static_cast<float>(width);
      p[1] = 0.3f * static_cast<float>(y) / static_cast<float>(height);
      p[2] = 0.1f;
      if (x > width / 3 && x < width / 2 && y > height / 4 && y < height / 2) p[0] = p[1] = p[2] = 0.9f;
      if (y == 3 * height / 4) p[1] = 0.8f;
    }
  }
  return image;
}

Image with_noise(Image image, float sigma, unsigned seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<float> normal(0, sigma);
  for (float& value : image.rgba) value = std::max(value + normal(generator), 0.0f);
  return image;
}

TEST(Flip, IdenticalIsZero) {
  const Image image = noise(70, 66, 1);
  EXPECT_EQ(flip(image, image).mean, 0.0);
  EXPECT_EQ(largest(flip(image, image)), 0.0f);
  EXPECT_EQ(flip_hdr(image, image)->mean, 0.0);
}

TEST(Flip, OfAReferenceThatIsKeptIsTheSame) {
  const Image reference = drawing(150, 70);
  const FlipReference kept(reference);
  for (const unsigned seed : {1u, 2u}) {
    const Image image = noise(150, 70, seed);
    EXPECT_EQ(kept.compare(image).map, flip(image, reference).map);
    EXPECT_EQ(kept.compare(image).mean, flip(image, reference).mean);
  }
  EXPECT_EQ(kept.compare(reference).mean, 0.0);
  EXPECT_THROW(kept.compare(drawing(70, 150)), Error);
}

TEST(Flip, IsSymmetric) {
  const Image a = noise(70, 66, 1), b = drawing(70, 66);
  EXPECT_GT(flip(a, b).mean, 0.1);
  EXPECT_EQ(flip(a, b).map, flip(b, a).map);
}

TEST(Flip, GrowsWithNoise) {
  const Image image = drawing(100, 80);
  double ldr = 0, hdr = 0;
  for (const float sigma : {0.005f, 0.01f, 0.02f, 0.05f, 0.1f, 0.2f}) {
    const Image noisy = with_noise(image, sigma, 5);
    EXPECT_GT(flip(noisy, image).mean, ldr) << sigma;
    EXPECT_GT(flip_hdr(noisy, image)->mean, hdr) << sigma;
    ldr = flip(noisy, image).mean;
    hdr = flip_hdr(noisy, image)->mean;
  }
  EXPECT_LT(ldr, 1);
}

// Filters leave a constant picture as it is and find no features in it: what stays is the colour difference.
TEST(Flip, BlackAndWhiteByHand) {
  // CIELAB 0 and 100, no chroma. Green and blue are 203.30 apart.
  const double distance = std::pow(100, 0.7), most = std::pow(203.30, 0.7);
  const double expected = 0.95 + 0.05 * (distance - 0.4 * most) / (0.6 * most);
  EXPECT_NEAR(expected, 0.9674, 1e-4);
  EXPECT_NEAR(flip(constant(20, 30, 0), constant(20, 30, 1)).mean, expected, 1e-4);
}

TEST(Flip, GreysByHand) {
  // Luminances of lightness 50 and 53: 3^0.7 = 2.1577 of 0.4 * 203.30^0.7 = 16.510, times 0.95.
  const auto luminance = [](double lightness) {
    return static_cast<float>(std::pow((lightness + 16) / 116, 3));
  };
  const double mean = flip(constant(20, 30, luminance(50)), constant(20, 30, luminance(53))).mean;
  EXPECT_NEAR(mean, 0.95 * 2.1577 / 16.510, 3e-4);
}

TEST(Flip, GreenAndBlueAreTheMost) {
  const FlipError error = flip(constant(9, 9, Vec3f(0, 1, 0)), constant(9, 9, Vec3f(0, 0, 1)));
  EXPECT_NEAR(error.mean, 1, 1e-5);
  EXPECT_LE(largest(error), 1.0f);
}

TEST(Flip, ConstantColors) {
  const Vec3f colors[] = {
      {0.2f, 0.1f, 0.6f}, {0.21f, 0.1f, 0.6f}, {1, 0, 0}, {0.01f, 0.02f, 0.0f}, {0.9f, 0.8f, 0.1f}};
  for (const Vec3f a : colors) {
    for (const Vec3f b : colors) {
      if (a == b) continue;
      const double expected = reference_color_error({a.x, a.y, a.z}, {b.x, b.y, b.z});
      EXPECT_NEAR(flip(constant(12, 11, a), constant(12, 11, b)).mean, expected, 1e-3 * expected);
    }
  }
}

void expect_as_defined(const Image& image, const Image& reference, double ppd) {
  const FlipError error = flip(image, reference, ppd);
  const ReferenceFlip expected = reference_flip(image, reference, ppd);
  ASSERT_EQ(error.map.size(), expected.error.size());
  double farthest = 0, feature_part = 0;
  for (std::size_t i = 0; i < error.map.size(); ++i) {
    farthest = std::max(farthest, std::abs(error.map[i] - expected.error[i]));
    feature_part = std::max(feature_part, expected.error[i] - expected.color_error[i]);
  }
  EXPECT_LT(farthest, 2e-4) << ppd;
  EXPECT_GT(feature_part, 0.05) << ppd;  // the features count in this pair
}

TEST(Flip, ImpulseAsDefined) {
  const Image black = constant(31, 29, 0);
  Image impulse = black;
  std::fill_n(impulse.pixel(15, 14), 3, 1.0f);
  expect_as_defined(impulse, black, kPpd);
  expect_as_defined(impulse, black, 20);
}

TEST(Flip, EdgeAsDefined) {
  const Image black = constant(25, 24, 0.1f);
  Image edge = black;
  for (int y = 0; y < edge.height; ++y) {
    for (int x = 11; x < edge.width; ++x) edge.pixel(x, y)[0] = 0.8f;
  }
  expect_as_defined(edge, black, kPpd);
}

// Wider and higher than a tile, so that tiles meet and end on the way.
TEST(Flip, TilesAsDefined) {
  const Image image = drawing(71, 67);
  expect_as_defined(with_noise(image, 0.1f, 3), image, kPpd);
  expect_as_defined(with_noise(image, 0.1f, 4), image, 15);
}

TEST(Flip, SmallestPicture) {
  EXPECT_NEAR(flip(constant(1, 1, 0), constant(1, 1, 1)).mean, 0.9674, 1e-4);
  EXPECT_NEAR(flip(constant(1, 1, 0), constant(1, 1, 1), 1).mean, 0.9674, 1e-4);
  EXPECT_NEAR(flip(constant(1, 1, 0), constant(1, 1, 1), 1000).mean, 0.9674, 1e-4);
}

TEST(Flip, LooksAtWhatADisplayShows) {
  EXPECT_EQ(flip(constant(4, 4, 3), constant(4, 4, 5)).mean, 0.0);
  EXPECT_EQ(flip(constant(4, 4, -1), constant(4, 4, 0)).mean, 0.0);
  Image no_alpha = constant(4, 4, 0.5f);
  for (std::size_t i = 0; i < 16; ++i) no_alpha.rgba[4 * i + 3] = std::nanf("");
  EXPECT_EQ(flip(no_alpha, constant(4, 4, 0.5f)).mean, 0.0);
}

TEST(Flip, MapAndMean) {
  const Image a = drawing(130, 70), b = with_noise(a, 0.1f, 6);
  for (const FlipError& error : {flip(b, a), *flip_hdr(b, a)}) {
    EXPECT_EQ(error.width, 130);
    EXPECT_EQ(error.height, 70);
    ASSERT_EQ(error.map.size(), 130u * 70u);
    EXPECT_DOUBLE_EQ(error.mean, std::accumulate(error.map.begin(), error.map.end(), 0.0) / (130 * 70));
    EXPECT_GE(*std::min_element(error.map.begin(), error.map.end()), 0.0f);
    EXPECT_LE(largest(error), 1.0f);
  }
}

TEST(Flip, AnyNumberOfThreads) {
  const Image a = drawing(200, 150), b = with_noise(a, 0.1f, 7);
  const FlipError ldr = flip(b, a), hdr = *flip_hdr(b, a);
  for (const int threads : {1, 3}) {
    const ThreadLimit limit(threads);
    EXPECT_EQ(flip(b, a).map, ldr.map);
    EXPECT_EQ(flip_hdr(b, a)->map, hdr.map);
    EXPECT_EQ(flip_hdr(b, a)->mean, hdr.mean);
  }
}

// The tone curve of HDR-FLIP, and where it reaches 0.85, by bisection.
double tone_curve(double x) { return (0.9036 * x * x + 0.018 * x) / (0.8748 * x * x + 0.354 * x + 0.14); }
double brightest_shown() {
  double low = 0, high = 10;
  for (int i = 0; i < 60; ++i) (tone_curve((low + high) / 2) < 0.85 ? low : high) = (low + high) / 2;
  return low;
}

// Greys: `dark` pixels of 0, `middle` of 2, one of 100.
Image greys(int dark, int middle) {
  Image image = constant(dark + middle + 1, 1, 2);
  std::fill_n(image.rgba.begin(), 4 * dark, 0.0f);
  std::fill_n(image.pixel(image.width - 1, 0), 3, 100.0f);
  return image;
}

TEST(FlipExposures, FromTheBrightestAndTheMedian) {
  const FlipExposures exposures = flip_exposures(greys(4, 6)).value();
  EXPECT_NEAR(exposures.start_ev, std::log2(brightest_shown() / 100), 1e-5);
  EXPECT_NEAR(exposures.stop_ev, std::log2(brightest_shown() / 2), 1e-5);
  EXPECT_EQ(exposures.count, 6);  // 5.6 stops
}

TEST(FlipExposures, AtLeastTwo) {
  const FlipExposures exposures = flip_exposures(constant(3, 3, 7)).value();
  EXPECT_EQ(exposures.start_ev, exposures.stop_ev);
  EXPECT_EQ(exposures.count, 2);
}

TEST(FlipExposures, LeaveOutABlackMajority) {
  const FlipExposures exposures = flip_exposures(greys(40, 6)).value();
  EXPECT_NEAR(exposures.stop_ev, std::log2(brightest_shown() / 2), 1e-5);
  Image negative = greys(40, 6);
  std::fill_n(negative.rgba.begin(), 4 * 40, -1.0f);
  EXPECT_EQ(flip_exposures(negative)->stop_ev, exposures.stop_ev);
}

TEST(FlipExposures, NoneOfABlackPicture) {
  EXPECT_FALSE(flip_exposures(constant(5, 5, 0)).has_value());
  EXPECT_FALSE(flip_exposures(constant(5, 5, -2)).has_value());
  EXPECT_FALSE(flip_hdr(constant(5, 5, 1), constant(5, 5, 0)).has_value());
  EXPECT_TRUE(flip_hdr(constant(5, 5, 0), constant(5, 5, 1)).has_value());
}

TEST(FlipExposures, RefuseWhatIsNoPicture) {
  EXPECT_THROW(flip_exposures(Image()), Error);
  EXPECT_THROW(flip_exposures(constant(2, 2, std::numeric_limits<float>::infinity())), Error);
}

// Of every pixel the largest error over the exposures, developed here.
TEST(FlipHdr, IsTheLargestOverTheExposures) {
  Image reference = drawing(60, 50);
  for (float& value : reference.rgba) value = 8 * value * value;
  const Image image = with_noise(reference, 0.2f, 8);
  const FlipExposures exposures{-3, 1, 3};
  std::vector<float> expected(image.pixel_count());
  for (const double ev : {-3.0, -1.0, 1.0}) {
    Image pair[] = {image, reference};
    for (Image& picture : pair) {
      for (float& value : picture.rgba) value = static_cast<float>(tone_curve(value * std::exp2(ev)));
    }
    const FlipError error = flip(pair[0], pair[1]);
    for (std::size_t i = 0; i < expected.size(); ++i) expected[i] = std::max(expected[i], error.map[i]);
  }
  const FlipError error = flip_hdr(image, reference, exposures);
  for (std::size_t i = 0; i < expected.size(); ++i) ASSERT_NEAR(error.map[i], expected[i], 1e-3) << i;
  const FlipExposures own = flip_exposures(reference).value();
  EXPECT_EQ(flip_hdr(image, reference)->map, flip_hdr(image, reference, own).map);
}

TEST(FlipHdr, SeesWhatTheDisplayClips) {
  const Image a = constant(12, 12, 3), b = constant(12, 12, 5);
  EXPECT_EQ(flip(a, b).mean, 0.0);
  EXPECT_GT(flip_hdr(a, b)->mean, 0.1);
}

TEST(FlipHdr, ExtremeValues) {
  Image a = constant(12, 12, 1e-30f), b = constant(12, 12, 1e-30f);
  b.pixel(3, 3)[1] = 1e30f;
  const FlipError error = flip_hdr(a, b).value();
  for (const float value : error.map) EXPECT_TRUE(value >= 0 && value <= 1);
  EXPECT_GT(error.map[3 * 12 + 3], 0.5f);
}

TEST(Flip, RefusesWhatCannotBeCompared) {
  const Image a = constant(12, 12, 1), wider = constant(13, 12, 1);
  Image bad = a;
  bad.pixel(5, 3)[1] = std::nanf("");
  for (const Image* b : {&wider, const_cast<const Image*>(&bad)}) {
    EXPECT_THROW(flip(a, *b), Error);
    EXPECT_THROW(flip(*b, a), Error);
    EXPECT_THROW(flip_hdr(a, *b), Error);
    EXPECT_THROW(flip_hdr(*b, a), Error);
  }
  EXPECT_THROW(flip(Image(), Image()), Error);
  EXPECT_THROW(flip_hdr(Image(), Image()), Error);
  for (const double ppd : {0.0, 0.5, -3.0, 2000.0, std::nan("")}) {
    EXPECT_THROW(flip(a, a, ppd), Error) << ppd;
    EXPECT_THROW(flip_hdr(a, a, ppd), Error) << ppd;
  }
  for (const FlipExposures& exposures :
       {FlipExposures{0, 1, 0}, FlipExposures{1, 0, 3}, FlipExposures{std::nan(""), 1, 3}}) {
    EXPECT_THROW(flip_hdr(a, a, exposures), Error);
  }
}

}  // namespace
}  // namespace voxlume::test
