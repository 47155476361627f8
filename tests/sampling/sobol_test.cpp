#include "sampling/sobol.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "support/chi_square.h"

namespace voxlume {
namespace {

constexpr SobolSet kSets[] = {SobolSet::kCamera, SobolSet::kFirstFlight, SobolSet::kFirstScattering,
                              SobolSet::kFirstLight};

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

TEST(Sobol, FirstPointsAreThePublishedOnes) {
  // Joe and Kuo's sequence in natural order, in 32nds.
  constexpr int kPoints[8][4] = {{0, 0, 0, 0},   {16, 16, 16, 16}, {8, 24, 24, 24},  {24, 8, 8, 8},
                                 {4, 20, 12, 4}, {20, 4, 28, 20},  {12, 12, 20, 28}, {28, 28, 4, 12}};
  for (std::uint32_t i = 0; i < 8; ++i)
    for (int d = 0; d < 4; ++d)
      EXPECT_EQ(reverse_bits(sobol_reversed(i)[d]), static_cast<std::uint32_t>(kPoints[i][d]) << 27)
          << i << ", " << d;
}

TEST(Sobol, EveryDimensionIsStratified) {
  constexpr std::uint32_t kCount = 256;
  for (const SobolSet set : kSets)
    for (int d = 0; d < 4; ++d) {
      std::set<int> cells;
      for (std::uint32_t i = 512; i < 512 + kCount; ++i)
        cells.insert(static_cast<int>(sobol_quad(sobol_pixel_seed(3, 1, 4), i, set)[d] * kCount));
      EXPECT_EQ(cells.size(), kCount);
    }
}

TEST(Sobol, EveryElementaryIntervalHasOnePoint) {
  // (0, m, 2)-nets in base 2, for aligned runs of 2^m samples.
  constexpr int kM = 6, kCount = 1 << kM;
  for (const std::uint32_t seed :
       {sobol_pixel_seed(1, 0, 0), sobol_pixel_seed(1, 0, 1), sobol_pixel_seed(9, 3, 70000)})
    for (const SobolSet set : kSets)
      for (const std::uint32_t begin : {0u, 64u, 4096u - 64u})
        for (int a = 0; a <= kM; ++a) {
          std::set<std::pair<int, int>> cells;
          for (std::uint32_t i = begin; i < begin + kCount; ++i) {
            const UnitQuad u = sobol_quad(seed, i, set);
            cells.emplace(static_cast<int>(u[0] * static_cast<float>(1 << a)),
                          static_cast<int>(u[1] * static_cast<float>(1 << (kM - a))));
          }
          EXPECT_EQ(cells.size(), static_cast<std::size_t>(kCount));
        }
}

TEST(Sobol, OneSampleOfManyPixelsIsUniform) {
  constexpr int kSide = 32, kDraws = 1 << 18;
  for (const SobolSet set : kSets)
    for (const std::uint32_t sample : {0u, 1u, 77u}) {
      const std::vector<double> expected(kSide * kSide, double{kDraws} / (kSide * kSide));
      std::vector<double> observed[2] = {std::vector<double>(kSide * kSide),
                                         std::vector<double>(kSide * kSide)};
      for (std::uint32_t pixel = 0; pixel < kDraws; ++pixel) {
        const UnitQuad u = sobol_quad(sobol_pixel_seed(5, 2, pixel), sample, set);
        for (const float x : u) ASSERT_TRUE(x >= 0 && x < 1);
        for (int p = 0; p < 2; ++p)
          observed[p][static_cast<std::size_t>(u[2 * p + 1] * kSide) * kSide +
                      static_cast<std::size_t>(u[2 * p] * kSide)] += 1;
      }
      for (const auto& pair : observed) EXPECT_GT(test::chi_square(pair, expected).p, test::significance(24));
    }
}

TEST(Sobol, SetsAndPixelsAreIndependent) {
  // A dimension of one set against a dimension of another, and of a pixel against its neighbour.
  constexpr int kSide = 32, kDraws = 1 << 18;
  std::vector<double> sets(kSide * kSide), pixels(kSide * kSide),
      expected(kSide * kSide, double{kDraws} / (kSide * kSide));
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const std::uint32_t seed = sobol_pixel_seed(6, 0, 2 * i), next = sobol_pixel_seed(6, 0, 2 * i + 1);
    const float a = sobol_quad(seed, 3, SobolSet::kFirstFlight)[0];
    const float b = sobol_quad(seed, 3, SobolSet::kFirstScattering)[0];
    const float c = sobol_quad(next, 3, SobolSet::kFirstFlight)[0];
    sets[static_cast<std::size_t>(a * kSide) * kSide + static_cast<std::size_t>(b * kSide)] += 1;
    pixels[static_cast<std::size_t>(a * kSide) * kSide + static_cast<std::size_t>(c * kSide)] += 1;
  }
  EXPECT_GT(test::chi_square(sets, expected).p, test::significance(2));
  EXPECT_GT(test::chi_square(pixels, expected).p, test::significance(2));
}

}  // namespace
}  // namespace voxlume
