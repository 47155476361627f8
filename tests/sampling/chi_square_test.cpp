#include "support/chi_square.h"

#include <gtest/gtest.h>

#include "sampling/rng.h"
#include "sampling/warp.h"

// The tests of samplers rest on these tools, so the tools are tested first.
namespace voxlume {
namespace {

TEST(ChiSquare, SurvivalMatchesClosedForms) {
  for (double x : {0.1, 1.0, 3.0, 20.0, 100.0}) {
    EXPECT_NEAR(test::chi_square_survival(x, 1), std::erfc(std::sqrt(x / 2)), 1e-12);
    EXPECT_NEAR(test::chi_square_survival(x, 2), std::exp(-x / 2), 1e-12);
    EXPECT_NEAR(test::chi_square_survival(x, 4), std::exp(-x / 2) * (1 + x / 2), 1e-12);
  }
  // Large k: Wilson and Hilferty's normal approximation.
  for (double z : {-2.0, 0.0, 1.0, 3.0}) {
    const double k = 5000, v = 2 / (9 * k);
    const double x = k * std::pow(1 - v + z * std::sqrt(v), 3);
    EXPECT_NEAR(test::chi_square_survival(x, k), 0.5 * std::erfc(z / std::numbers::sqrt2), 2e-5);
  }
}

TEST(ChiSquare, PoolsSmallBins) {
  const auto result = test::chi_square({3, 3, 12, 10}, {2, 4, 12, 10});
  EXPECT_EQ(result.degrees, 2);
  EXPECT_DOUBLE_EQ(result.statistic, 0.0);
}

TEST(ChiSquare, BinsCoverTheSphere) {
  for (double angle : {2.0, 0.1, 1e-3}) {
    const test::SphereBins bins(Vec3f(0.6f, 0.0f, -0.8f), angle);
    double total = 0;
    for (double p : bins.integrate([](Vec3f) { return kUniformSpherePdf; })) total += p;
    EXPECT_NEAR(total, 1.0, 1e-6) << angle;
  }
}

/// A sampler whose density is off by 3 percent on one half of the sphere must not pass.
TEST(ChiSquare, RejectsAWrongDensity) {
  Rng rng(3, 0, 0, 0);
  test::SphereBins bins(Vec3f(0, 0, 1));
  for (int i = 0; i < test::kDirectionDraws; ++i) {
    const float u0 = rng.next(), u1 = rng.next();
    bins.add(uniform_sphere(u0, u1));
  }
  auto expected = bins.integrate([](Vec3f d) { return kUniformSpherePdf * (d.x > 0 ? 1.03f : 0.97f); });
  for (double& e : expected) e *= test::kDirectionDraws;
  EXPECT_LT(test::chi_square(bins.counts(), expected).p, 1e-6);
}

}  // namespace
}  // namespace voxlume
