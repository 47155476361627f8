#include "film/film.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <thread>

#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr FilmLayers kAllLayers{.depth = true, .normal = true, .albedo = true};

std::vector<PixelSample> random_samples(int count, unsigned seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<float> uniform;
  const auto vector = [&] { return Vec3f(uniform(generator), uniform(generator), uniform(generator)); };
  std::vector<PixelSample> samples(count);
  for (PixelSample& s : samples) {
    s.radiance = vector() * 3.0f;
    s.alpha = uniform(generator) < 0.6f ? 1.0f : 0.0f;
    s.albedo = vector();
    s.normal = vector();
    s.depth_mm = 100 * uniform(generator);
  }
  return samples;
}

std::vector<std::byte> all_bytes(const Film& film) {
  std::vector<std::byte> bytes;
  for (const auto span : film.accumulators()) bytes.insert(bytes.end(), span.begin(), span.end());
  return bytes;
}

TEST(Film, EmptyPixelIsZero) {
  const Film film(3, 2, kAllLayers);
  EXPECT_EQ(film.sample_count(2, 1), 0u);
  EXPECT_EQ(film.mean(2, 1), Vec3d(0));
  EXPECT_EQ(film.alpha(2, 1), 0);
  EXPECT_EQ(film.albedo(2, 1), Vec3d(0));
  EXPECT_EQ(film.variance_of_mean(2, 1), 0);
  EXPECT_EQ(film.noise(), 0);
}

TEST(Film, SumsEqualDirectComputation) {
  const std::vector<PixelSample> samples = random_samples(200, 1);
  Film film(4, 3, kAllLayers);
  Vec3d radiance, normal, albedo;
  double depth = 0, hits = 0;
  for (const PixelSample& s : samples) {
    film.add(3, 1, s);
    radiance += Vec3d(s.radiance);
    if (s.alpha == 0) continue;
    hits += 1;
    depth += s.depth_mm;
    normal += Vec3d(s.normal);
    albedo += Vec3d(s.albedo);
  }
  EXPECT_EQ(film.sample_count(3, 1), 200u);
  EXPECT_EQ(film.mean(3, 1), radiance / 200.0);
  EXPECT_EQ(film.alpha(3, 1), hits / 200);
  EXPECT_EQ(film.depth_mm(3, 1), depth / hits);
  EXPECT_EQ(film.normal(3, 1), normal / hits);
  EXPECT_EQ(film.albedo(3, 1), albedo / hits);
  EXPECT_EQ(film.total_samples(), 200u);
  EXPECT_EQ(film.sample_count(2, 1), 0u);
}

TEST(Film, VarianceIsThatOfTheMeanLuminance) {
  const std::vector<PixelSample> samples = random_samples(500, 2);
  Film film(1, 1);
  double mean = 0;
  for (const PixelSample& s : samples) {
    film.add(0, 0, s);
    mean += luminance(Vec3d(s.radiance)) / 500;
  }
  double squares = 0;  // two-pass, the textbook definition
  for (const PixelSample& s : samples) squares += std::pow(luminance(Vec3d(s.radiance)) - mean, 2);
  EXPECT_NEAR(film.variance_of_mean(0, 0), squares / 499 / 500, 1e-12);
  EXPECT_NEAR(film.standard_error(0, 0), std::sqrt(squares / 499 / 500), 1e-10);
}

TEST(Film, EqualSamplesHaveNoVariance) {
  Film film(1, 1);
  for (int i = 0; i < 1000; ++i) film.add(0, 0, {.radiance = {0.1f, 0.7f, 0.3f}});
  EXPECT_GE(film.variance_of_mean(0, 0), 0);
  EXPECT_LT(film.standard_error(0, 0), 1e-8);
}

TEST(Film, OneSampleHasNoVariance) {
  Film film(1, 1);
  film.add(0, 0, {.radiance = {1, 2, 3}});
  EXPECT_EQ(film.variance_of_mean(0, 0), 0);
}

TEST(Film, NoiseAndMeanLuminanceAreMeansOverPixels) {
  Film film(2, 1);
  // Grey pixels: luminances {1, 3} (mean 2, variance of the mean 1) and {0, 0}.
  film.add(0, 0, {.radiance = Vec3f(1)});
  film.add(0, 0, {.radiance = Vec3f(3)});
  film.add(1, 0, {});
  film.add(1, 0, {});
  EXPECT_NEAR(film.mean_luminance(), 1.0, 1e-12);
  EXPECT_NEAR(film.noise(), 0.5 * 1.0 / 2.01, 1e-12);
}

TEST(Film, SharesOfVarianceAreOneOfIndependentSamples) {
  std::mt19937 generator(5);
  std::uniform_real_distribution<float> uniform;
  for (const int samples : {31, 32, 80, 640}) {
    Film film(64, 64);
    for (int y = 0; y < 64; ++y) {
      for (int x = 0; x < 64; ++x) {
        for (int s = 0; s < samples; ++s) film.add(x, y, {.radiance = Vec3f(uniform(generator))});
      }
    }
    const std::vector<float> shares = film.variance_shares();
    ASSERT_EQ(shares.size(), 64u * 64);
    double mean = 0;
    for (const float share : shares) mean += share / 4096;
    // The variance of n blocks has the relative variance 2 / (n - 1).
    const int blocks = samples / 16;
    if (blocks < 2) {
      EXPECT_EQ(mean, 1);
    } else {
      EXPECT_LT(std::abs(mean - 1), 4 * std::sqrt(2.0 / (blocks - 1) / 4096)) << samples;
    }
  }
}

TEST(Film, SharesOfVarianceAreThoseOfStratifiedSamples) {
  std::mt19937 generator(6);
  std::uniform_real_distribution<float> uniform;
  for (const int samples : {32, 40, 160}) {
    Film film(32, 32);
    for (int y = 0; y < 32; ++y) {
      for (int x = 0; x < 32; ++x) {
        // In a corner they are independent: stratification helps there by nothing.
        const bool stratified = x >= 16 || y >= 16;
        for (int s = 0; s < samples; ++s) {
          const float u = uniform(generator), stratum = static_cast<float>(s * 7 % 16);
          film.add(x, y, {.radiance = Vec3f(stratified ? (stratum + u) / 16 : u)});
        }
      }
    }
    const std::vector<float> shares = film.variance_shares();
    double even = 0, corner = 0;
    for (int y = 0; y < 16; ++y) {
      for (int x = 0; x < 16; ++x) {
        corner += shares[y * 32 + x] / 256;
        even += shares[(y + 16) * 32 + x + 16] / 256;
      }
    }
    // One sample in each of 16 strata: 1 / 16^2 of the variance of independent samples.
    EXPECT_NEAR(even * 256, 1, 0.25) << samples;
    EXPECT_NEAR(corner, 1, 0.25) << samples;
    EXPECT_GT(film.noise(), 0);
  }
}

TEST(Film, NonfiniteBecomesZeroAndIsCountedOnce) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Film film(1, 1, kAllLayers);
  film.add(0, 0, {.radiance = {1, 1, 1}, .alpha = 1, .normal = {0, 0, 1}, .depth_mm = 5});
  film.add(0, 0, {.radiance = {1, kNan, 1}});
  film.add(0, 0, {.radiance = {kInfinity, 0, 0}, .alpha = 1, .depth_mm = kNan});
  film.add(0, 0, {.radiance = {1, 1, 1}, .alpha = kNan});
  EXPECT_EQ(film.nonfinite_samples(), 3u);
  EXPECT_EQ(film.sample_count(0, 0), 4u);
  EXPECT_EQ(film.mean(0, 0), Vec3d(0.5));
  EXPECT_EQ(film.alpha(0, 0), 0.5);
  EXPECT_EQ(film.depth_mm(0, 0), 2.5);
  EXPECT_TRUE(std::isfinite(film.noise()));
}

TEST(Film, NonfiniteAovsOfAMissAreIgnored) {
  Film film(1, 1, kAllLayers);
  film.add(0, 0, {.radiance = {1, 1, 1}, .depth_mm = std::numeric_limits<float>::infinity()});
  EXPECT_EQ(film.nonfinite_samples(), 0u);
  EXPECT_EQ(film.depth_mm(0, 0), 0);
}

TEST(Film, NonfiniteCountIsExactFromManyThreads) {
  Film film(8, 1);
  std::vector<std::thread> threads;
  for (int x = 0; x < 8; ++x) {
    threads.emplace_back([&film, x] {
      for (int i = 0; i < 10000; ++i) film.add(x, 0, {.radiance = Vec3f(std::nanf(""))});
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(film.nonfinite_samples(), 80000u);
}

TEST(Film, AccumulatorsCopyBitForBit) {
  Film film(5, 4, kAllLayers);
  int pixel = 0;
  for (const PixelSample& s : random_samples(400, 3)) {
    film.add(pixel % 5, pixel / 5 % 4, s);
    pixel = (pixel + 7) % 20;
  }
  film.add(0, 0, {.radiance = Vec3f(std::nanf(""))});
  Film copy(5, 4, kAllLayers);
  const auto from = std::as_const(film).accumulators();
  const auto to = copy.accumulators();
  ASSERT_EQ(from.size(), to.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    ASSERT_EQ(from[i].size(), to[i].size());
    if (!from[i].empty()) std::memcpy(to[i].data(), from[i].data(), from[i].size());
  }
  EXPECT_EQ(all_bytes(copy), all_bytes(film));
  EXPECT_EQ(copy.mean(2, 3), film.mean(2, 3));
  EXPECT_EQ(copy.noise(), film.noise());
  EXPECT_EQ(copy.nonfinite_samples(), 1u);
  // And both go on alike.
  copy.add(1, 1, {.radiance = {0.1f, 0.2f, 0.3f}});
  EXPECT_NE(all_bytes(copy), all_bytes(film));
  film.add(1, 1, {.radiance = {0.1f, 0.2f, 0.3f}});
  EXPECT_EQ(all_bytes(copy), all_bytes(film));
}

TEST(Film, KeepsOnlyTheLayersAskedFor) {
  for (const FilmLayers layers : {FilmLayers{}, FilmLayers{.normal = true}, kAllLayers}) {
    const Film film(7, 3, layers);
    EXPECT_EQ(all_bytes(film).size(), 21 * Film::bytes_per_pixel(layers) + 8);
  }
  EXPECT_LT(Film::bytes_per_pixel({}), Film::bytes_per_pixel({.depth = true}));
  Film film(1, 1);
  film.add(0, 0, {.radiance = {1, 1, 1}, .alpha = 1, .albedo = Vec3f(1), .normal = {0, 0, 1}, .depth_mm = 5});
  EXPECT_EQ(film.depth_mm(0, 0), 0);
  EXPECT_EQ(film.normal(0, 0), Vec3d(0));
}

TEST(Film, RefusesImpossibleSizes) {
  for (const auto& [width, height] : {std::pair{0, 1}, {1, 0}, {-1, 5}, {65537, 1}}) {
    EXPECT_THROW(Film(width, height), Error) << width << " x " << height;
  }
}

}  // namespace
}  // namespace voxlume
