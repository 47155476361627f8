#include "sampling/sobol.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "support/chi_square.h"

namespace voxlume {
namespace {

constexpr SobolPair kPairs[] = {SobolPair::kImage, SobolPair::kLens, SobolPair::kFirstFlight,
                                SobolPair::kFirstLight, SobolPair::kFirstDirection};

TEST(Sobol, BitsAreReversed) {
  EXPECT_EQ(reverse_bits(1), 0x80000000u);
  EXPECT_EQ(reverse_bits(0x12345678u), 0x1e6a2c48u);
}

TEST(Sobol, SecondDimensionIsPascalsTriangle) {
  // Row n of Pascal's triangle mod 2, reversed: C(n, k) is odd where k's bits are among n's.
  for (int column = 0; column < 32; ++column) {
    const std::uint32_t product = pascal_product(1u << column);
    for (int row = 0; row < 32; ++row) EXPECT_EQ(product >> row & 1, (row & column) == row ? 1u : 0u);
  }
}

TEST(Sobol, EveryElementaryIntervalHasOnePoint) {
  // (0, m, 2)-nets in base 2, for aligned runs of 2^m samples.
  constexpr int kM = 6, kCount = 1 << kM;
  for (const std::uint32_t seed :
       {sobol_pixel_seed(1, 0, 0), sobol_pixel_seed(1, 0, 1), sobol_pixel_seed(9, 3, 70000)})
    for (const SobolPair pair : kPairs)
      for (const std::uint32_t begin : {0u, 64u, 4096u - 64u})
        for (int a = 0; a <= kM; ++a) {
          std::set<std::pair<int, int>> cells;
          for (std::uint32_t i = begin; i < begin + kCount; ++i) {
            const UnitPair u = sobol_pair(seed, i, pair);
            cells.emplace(static_cast<int>(u.u0 * static_cast<float>(1 << a)),
                          static_cast<int>(u.u1 * static_cast<float>(1 << (kM - a))));
          }
          EXPECT_EQ(cells.size(), static_cast<std::size_t>(kCount));
        }
}

TEST(Sobol, OneSampleOfManyPixelsIsUniform) {
  constexpr int kSide = 32, kDraws = 1 << 18;
  for (const SobolPair pair : kPairs)
    for (const std::uint32_t sample : {0u, 1u, 77u}) {
      std::vector<double> observed(kSide * kSide), expected(kSide * kSide, double{kDraws} / (kSide * kSide));
      for (std::uint32_t pixel = 0; pixel < kDraws; ++pixel) {
        const UnitPair u = sobol_pair(sobol_pixel_seed(5, 2, pixel), sample, pair);
        ASSERT_TRUE(u.u0 >= 0 && u.u0 < 1 && u.u1 >= 0 && u.u1 < 1);
        observed[static_cast<std::size_t>(u.u1 * kSide) * kSide + static_cast<std::size_t>(u.u0 * kSide)] +=
            1;
      }
      EXPECT_GT(test::chi_square(observed, expected).p, test::significance(15));
    }
}

TEST(Sobol, PairsAndPixelsAreIndependent) {
  // A dimension of one pair against a dimension of another, and of a pixel against its neighbour.
  constexpr int kSide = 32, kDraws = 1 << 18;
  std::vector<double> pairs(kSide * kSide), pixels(kSide * kSide),
      expected(kSide * kSide, double{kDraws} / (kSide * kSide));
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const std::uint32_t seed = sobol_pixel_seed(6, 0, 2 * i), next = sobol_pixel_seed(6, 0, 2 * i + 1);
    const float a = sobol_pair(seed, 3, SobolPair::kFirstFlight).u0;
    const float b = sobol_pair(seed, 3, SobolPair::kFirstLight).u0;
    const float c = sobol_pair(next, 3, SobolPair::kFirstFlight).u0;
    pairs[static_cast<std::size_t>(a * kSide) * kSide + static_cast<std::size_t>(b * kSide)] += 1;
    pixels[static_cast<std::size_t>(a * kSide) * kSide + static_cast<std::size_t>(c * kSide)] += 1;
  }
  EXPECT_GT(test::chi_square(pairs, expected).p, test::significance(2));
  EXPECT_GT(test::chi_square(pixels, expected).p, test::significance(2));
}

}  // namespace
}  // namespace voxlume
