#include "tonemap/tone_map.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "tonemap/srgb.h"

namespace voxlume {
namespace {

Image one_pixel(float r, float g, float b, float a = 1) {
  Image image(1, 1);
  image.rgba = {r, g, b, a};
  return image;
}

std::vector<int> developed(const Image& image, const ToneMap& settings) {
  const Image8 out = tone_map(image, settings);
  return {out.values.begin(), out.values.end()};
}

TEST(Srgb, KnownValues) {
  // IEC 61966-2-1: 0.5 encoded is 0.21404 linear; mid-grey 0.18 encodes to 0.46136.
  EXPECT_NEAR(linear_from_srgb(0.5f), 0.2140411f, 1e-6f);
  EXPECT_NEAR(srgb_from_linear(0.18f), 0.4613561f, 1e-6f);
  EXPECT_NEAR(srgb_from_linear(0.001f), 0.01292f, 1e-7f);
  EXPECT_EQ(srgb_from_linear(0.0f), 0.0f);
  EXPECT_NEAR(srgb_from_linear(1.0f), 1.0f, 1e-6f);
}

TEST(Srgb, InverseAndMonotone) {
  float previous = -1;
  for (int i = 0; i <= 10000; ++i) {
    const float x = static_cast<float>(i) / 10000;
    EXPECT_NEAR(linear_from_srgb(srgb_from_linear(x)), x, 2e-6f);
    EXPECT_GT(srgb_from_linear(x), previous);
    previous = srgb_from_linear(x);
  }
  for (int i = 0; i < 256; ++i) {
    const float encoded = static_cast<float>(i) / 255;
    EXPECT_EQ(std::lround(255 * srgb_from_linear(linear_from_srgb(encoded))), i);
  }
}

TEST(Filmic, KeepsMidGreyAndLeavesRoomAboveWhite) {
  EXPECT_EQ(filmic(0), 0.0f);
  EXPECT_EQ(filmic(-1), 0.0f);
  EXPECT_NEAR(filmic(0.18f), 0.18f, 1e-6f);
  EXPECT_NEAR(filmic(1), 0.7261840f, 1e-6f);
  EXPECT_NEAR(filmic(4), 0.9508344f, 1e-6f);
  EXPECT_LT(filmic(9.5f), 1.0f);
  EXPECT_EQ(filmic(10.1f), 1.0f);
  EXPECT_EQ(filmic(1e30f), 1.0f);
  EXPECT_EQ(filmic(std::numeric_limits<float>::infinity()), 1.0f);
  EXPECT_EQ(filmic(std::nanf("")), 0.0f);
}

TEST(Filmic, IncreasesUntilItClips) {
  float previous = -1;
  for (float x = 0; x < 9.9f; x += 0.01f) {
    EXPECT_GT(filmic(x), previous) << x;
    previous = filmic(x);
  }
  for (float x = 10; x < 1000; x += 0.5f) EXPECT_GE(filmic(x), previous);
}

TEST(ToneMap, KnownColours) {
  const ToneMap srgb{.curve = ToneCurve::kSrgb};
  EXPECT_EQ(developed(one_pixel(0, 0.2158605f, 1), srgb), (std::vector<int>{0, 128, 255}));
  EXPECT_EQ(developed(one_pixel(-1, 2, 0.18f), srgb), (std::vector<int>{0, 255, 118}));
  EXPECT_EQ(developed(one_pixel(0.18f, 100, 0), ToneMap{}), (std::vector<int>{118, 255, 0}));
}

TEST(ToneMap, ExposureIsInStops) {
  const ToneMap up{.exposure_ev = 1, .curve = ToneCurve::kSrgb}, plain{.curve = ToneCurve::kSrgb};
  EXPECT_EQ(developed(one_pixel(0.1f, 0.2f, 0.3f), up), developed(one_pixel(0.2f, 0.4f, 0.6f), plain));
  const ToneMap down{.exposure_ev = -2, .curve = ToneCurve::kSrgb};
  EXPECT_EQ(developed(one_pixel(0.4f, 0.8f, 4), down), developed(one_pixel(0.1f, 0.2f, 1), plain));
}

TEST(ToneMap, TransparentColourIsThatOfTheCoveredPart) {
  for (const ToneCurve curve : {ToneCurve::kSrgb, ToneCurve::kFilmic}) {
    const ToneMap settings{.curve = curve, .transparent = true};
    std::vector<int> opaque = developed(one_pixel(0.6f, 0.3f, 0.1f, 1), settings);
    const std::vector<int> half = developed(one_pixel(0.3f, 0.15f, 0.05f, 0.5f), settings);
    EXPECT_EQ(opaque[3], 255);
    opaque[3] = 128;
    EXPECT_EQ(half, opaque);
  }
}

TEST(ToneMap, EmptyPixelIsTransparentBlack) {
  EXPECT_EQ(developed(one_pixel(0.3f, 0.2f, 0.1f, 0), {.transparent = true}), (std::vector<int>{0, 0, 0, 0}));
}

TEST(ToneMap, AlphaIsDroppedUnlessAskedFor) {
  EXPECT_EQ(developed(one_pixel(1, 1, 1, 0.25f), {.curve = ToneCurve::kSrgb}),
            (std::vector<int>{255, 255, 255}));
}

TEST(ToneMap, NonfiniteBecomesZero) {
  const float nan = std::nanf(""), infinity = std::numeric_limits<float>::infinity();
  EXPECT_EQ(developed(one_pixel(nan, infinity, 1), {.curve = ToneCurve::kSrgb}),
            (std::vector<int>{0, 0, 255}));
  EXPECT_EQ(developed(one_pixel(1, 1, 1, nan), {.transparent = true}), (std::vector<int>{0, 0, 0, 0}));
}

TEST(ToneMap, KeepsSizeAndMetadata) {
  Image image(5, 3);
  image.metadata["voxlume:seed"] = "7";
  const Image8 out = tone_map(image);
  EXPECT_EQ(out.width, 5);
  EXPECT_EQ(out.height, 3);
  EXPECT_EQ(out.channels, 3);
  EXPECT_EQ(out.values.size(), 45u);
  EXPECT_EQ(out.metadata.at("voxlume:seed"), "7");
}

TEST(ToneMap, DitherKeepsTheMeanAndWholeLevels) {
  // An 8 x 8 block halfway between two levels: plain rounding shows one level, dithering half of each.
  Image image(8, 8);
  const float between = linear_from_srgb(100.5f / 255);
  for (float& value : image.rgba) value = between;
  const std::vector<int> plain = developed(image, {.curve = ToneCurve::kSrgb});
  const std::vector<int> dithered = developed(image, {.curve = ToneCurve::kSrgb, .dither = true});
  EXPECT_EQ(std::set<int>(plain.begin(), plain.end()).size(), 1u);
  EXPECT_EQ(std::count(dithered.begin(), dithered.end(), 100), 96);
  EXPECT_EQ(std::count(dithered.begin(), dithered.end(), 101), 96);
  // A level that 8 bits hold is left alone.
  for (float& value : image.rgba) value = linear_from_srgb(100.0f / 255);
  const std::vector<int> exact = developed(image, {.curve = ToneCurve::kSrgb, .dither = true});
  EXPECT_EQ(std::set<int>(exact.begin(), exact.end()), std::set<int>{100});
}

}  // namespace
}  // namespace voxlume
