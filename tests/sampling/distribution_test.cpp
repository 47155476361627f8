#include "sampling/distribution.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sampling/rng.h"
#include "support/chi_square.h"

namespace voxlume {
namespace {

/// Every u that unit_float can return, counted: probabilities are exact, not nearly so.
TEST(Distribution1D, ProbabilitiesAreExact) {
  const std::vector<double> weights = {0, 3, 0, 1e-12, 5, 0.1, 0};
  const Distribution1D owner(weights);
  const Distribution1DView d = owner.view();
  ASSERT_EQ(d.count, 7);
  EXPECT_EQ(d.cdf[7], 1.0f);
  std::vector<double> counts(7);
  for (std::uint32_t i = 0; i < 1u << 24; ++i) {
    const BinSample s = sample_bin(d, static_cast<float>(i) * 0x1p-24f);
    ASSERT_GE(s.offset, 0.0f);
    ASSERT_LT(s.offset, 1.0f);
    counts[static_cast<std::size_t>(s.index)] += 1;
  }
  double total = 0;
  for (double w : weights) total += w;
  for (int i = 0; i < 7; ++i) {
    const auto k = static_cast<std::size_t>(i);
    EXPECT_EQ(counts[k] * 0x1p-24, double{bin_probability(d, i)}) << i;
    EXPECT_NEAR(double{bin_probability(d, i)}, weights[k] / total, 0x1p-23) << i;
    EXPECT_EQ(bin_probability(d, i) > 0, weights[k] > 0) << i;
  }
}

TEST(Distribution1D, KeepsFaintBinsNextToABlindingOne) {
  for (std::size_t blinding : {0u, 2000u, 4095u}) {
    std::vector<double> weights(4096, 1e-9);
    weights[blinding] = 1;
    weights[17] = 0;
    const Distribution1D owner(weights);
    for (int i = 0; i < 4096; ++i) {
      if (i == 17)
        EXPECT_EQ(bin_probability(owner.view(), i), 0.0f);
      else
        EXPECT_GE(bin_probability(owner.view(), i), 0x1p-24f) << i;
    }
    EXPECT_EQ(owner.view().cdf[4096], 1.0f);
  }
}

TEST(Distribution1D, AllZeroIsUniform) {
  const std::vector<double> weights(8, 0.0);
  const Distribution1D owner(weights);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(bin_probability(owner.view(), i), 0.125f);
}

TEST(Distribution1D, EmptyHasNoBins) { EXPECT_EQ(Distribution1D().view().count, 0); }

TEST(Distribution1D, PositionsFitTheirDensity) {
  const std::vector<double> weights = {1, 4, 0, 2, 2, 0.5};
  const Distribution1D owner(weights);
  constexpr int kBins = 300;
  std::vector<double> observed(kBins), expected(kBins);
  for (int i = 0; i < kBins; ++i)
    expected[static_cast<std::size_t>(i)] =
        double{position_pdf(owner.view(), (static_cast<float>(i) + 0.5f) / kBins)} * (1 << 20) / kBins;
  Rng rng(1, 0, 0, 0);
  for (int i = 0; i < 1 << 20; ++i) {
    const PositionSample s = sample_position(owner.view(), rng.next());
    ASSERT_LT(s.x, 1.0f);
    observed[static_cast<std::size_t>(s.x * kBins)] += 1;
  }
  EXPECT_GT(test::chi_square(observed, expected).p, test::significance(1));
}

TEST(Distribution2D, TexelsFitTheirWeights) {
  constexpr int kWidth = 40, kHeight = 20;
  std::vector<double> weights(kWidth * kHeight);
  double total = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = i % 7 == 0 || i / kWidth == 5 ? 0.0 : 1.0 + std::sin(static_cast<double>(i));
    total += weights[i];
  }
  weights[333] += total;  // more than all others together
  total *= 2;
  const Distribution2D owner(weights, kWidth, kHeight);
  std::vector<double> observed(weights.size()), expected(weights.size());
  for (std::size_t i = 0; i < weights.size(); ++i) {
    expected[i] = weights[i] / total * (1 << 20);
    const float p =
        texel_probability(owner.view(), static_cast<int>(i % kWidth), static_cast<int>(i / kWidth));
    EXPECT_NEAR(double{p}, weights[i] / total, 2e-7);
  }
  Rng rng(2, 0, 0, 0);
  for (int i = 0; i < 1 << 20; ++i) {
    const float u0 = rng.next(), u1 = rng.next();
    const TexelSample s = sample_texel(owner.view(), u0, u1);
    ASSERT_EQ(s.probability, texel_probability(owner.view(), s.column, s.row));
    observed[static_cast<std::size_t>(s.row * kWidth + s.column)] += 1;
  }
  EXPECT_GT(test::chi_square(observed, expected).p, test::significance(1));
}

}  // namespace
}  // namespace voxlume
