#include "sampling/rng.h"

#include <gtest/gtest.h>

#include <vector>

#include "support/chi_square.h"

namespace voxlume {
namespace {

TEST(Rng, PhiloxKnownAnswers) {
  using Block = std::array<std::uint32_t, 4>;
  EXPECT_EQ(philox4x32_7({0, 0, 0, 0}, {0, 0}), (Block{0x5f6fb709u, 0x0d893f64u, 0x4f121f81u, 0x4f730a48u}));
  constexpr std::uint32_t kOnes = 0xffffffffu;
  EXPECT_EQ(philox4x32_7({kOnes, kOnes, kOnes, kOnes}, {kOnes, kOnes}),
            (Block{0x5207ddc2u, 0x45165e59u, 0x4d8ee751u, 0x8c52f662u}));
}

TEST(Rng, XoshiroKnownAnswers) {
  // Of the state 1, 2, 3, 4: by hand, 641 = rotl(1 + 4, 7) + 1, and from an independent implementation.
  Rng rng(std::array<std::uint32_t, 4>{1, 2, 3, 4});
  for (const std::uint32_t bits : {641u, 1573767u, 3222811527u, 3517856514u})
    EXPECT_EQ(rng.next(), unit_float(bits));
}

TEST(Rng, UnitFloatStaysBelowOne) {
  EXPECT_EQ(unit_float(0), 0.0f);
  EXPECT_EQ(unit_float(0xffffffffu), 1.0f - 0x1p-24f);
}

TEST(Rng, StreamIsAFunctionOfItsArguments) {
  const auto draw = [](Rng rng) {
    std::vector<float> out(13);
    for (float& x : out) x = rng.next();
    return out;
  };
  const auto reference = draw(Rng(1, 2, 3, 4));
  EXPECT_EQ(reference, draw(Rng(1, 2, 3, 4)));
  EXPECT_NE(reference, draw(Rng(2, 2, 3, 4)));
  EXPECT_NE(reference, draw(Rng(1ull << 32 | 1, 2, 3, 4)));
  EXPECT_NE(reference, draw(Rng(1, 3, 3, 4)));
  EXPECT_NE(reference, draw(Rng(1, 2, 4, 4)));
  EXPECT_NE(reference, draw(Rng(1, 2, 3, 5)));
}

TEST(Rng, PairsAreUniform) {
  constexpr int kSide = 64, kDraws = 1 << 20;
  std::vector<double> observed(kSide * kSide), expected(kSide * kSide, double{kDraws} / (kSide * kSide));
  for (int i = 0; i < kDraws; ++i) {
    Rng rng(7, 0, static_cast<std::uint32_t>(i % 1024), static_cast<std::uint32_t>(i / 1024));
    const int x = static_cast<int>(rng.next() * kSide), y = static_cast<int>(rng.next() * kSide);
    observed[static_cast<std::size_t>(y * kSide + x)] += 1;
  }
  EXPECT_GT(test::chi_square(observed, expected).p, test::significance(1));
}

}  // namespace
}  // namespace voxlume
