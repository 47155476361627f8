#include "sampling/warp.h"

#include <gtest/gtest.h>

#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

using test::DirectionDraw;
using test::SphereBins;

TEST(Warp, UniformSphereFits) {
  Rng rng(1, 0, 0, 0);
  const auto draw = [&] { return DirectionDraw{test::random_direction(rng), kUniformSpherePdf}; };
  const double total = test::expect_directions_fit(
      SphereBins(Vec3f(0, 1, 0)), draw, [](Vec3f) { return kUniformSpherePdf; }, 3);
  EXPECT_NEAR(total, 1.0, 1e-6);
}

TEST(Warp, CosineHemisphereFits) {
  Rng rng(2, 0, 0, 0);
  const auto draw = [&] {
    const float u0 = rng.next(), u1 = rng.next();
    const Vec3f d = cosine_hemisphere(u0, u1);
    return DirectionDraw{d, cosine_hemisphere_pdf(d.z)};
  };
  const double total = test::expect_directions_fit(
      SphereBins(Vec3f(0, 0, 1)), draw, [](Vec3f d) { return cosine_hemisphere_pdf(d.z); }, 3);
  EXPECT_NEAR(total, 1.0, 1e-5);
}

TEST(Warp, ConeFits) {
  Rng rng(3, 0, 0, 0);
  const float versine = 0.01f;
  const float density = 1.0f / (2.0f * std::numbers::pi_v<float> * versine);
  const auto draw = [&] {
    const float u0 = rng.next(), u1 = rng.next();
    return DirectionDraw{uniform_cone(versine, u0, u1), density};
  };
  test::expect_directions_fit(
      SphereBins(Vec3f(0, 0, 1), 0.14), draw, [&](Vec3f d) { return 1.0f - d.z < versine ? density : 0.0f; },
      3);
}

TEST(Warp, DiskFits) {
  constexpr int kSide = 64;
  Rng rng(4, 0, 0, 0);
  std::vector<double> observed(kSide * kSide), expected(observed.size(), double{1 << 20} / (kSide * kSide));
  for (int i = 0; i < 1 << 20; ++i) {
    const float u0 = rng.next(), u1 = rng.next();
    const DiskPoint p = concentric_disk(u0, u1);
    const double r2 = double{p.x} * p.x + double{p.y} * p.y;
    ASSERT_LE(r2, 1 + 1e-6);
    const int ring = std::min(kSide - 1, static_cast<int>(r2 * kSide));
    const int sector = std::clamp(
        static_cast<int>((std::atan2(p.y, p.x) / (2 * std::numbers::pi) + 0.5) * kSide), 0, kSide - 1);
    observed[static_cast<std::size_t>(ring * kSide + sector)] += 1;
  }
  EXPECT_GT(test::chi_square(observed, expected).p, test::significance(3));
}

TEST(Warp, InverseErfInverts) {
  for (double x = -0.9973; x <= 0.9973; x += 1e-4) {
    const float xf = static_cast<float>(x);
    EXPECT_NEAR(std::erf(double{inverse_erf(xf)}), double{xf}, 5e-7) << x;
  }
}

TEST(Warp, PixelFiltersFit) {
  constexpr int kBins = 1000;
  for (PixelFilter filter : {PixelFilter::kGaussian, PixelFilter::kBox}) {
    Rng rng(5, 0, 0, 0);
    const double radius = 1.5;
    const auto cdf = [&](double x) {
      if (filter == PixelFilter::kBox) return 0.5 + 0.5 * x / radius;
      return 0.5 + 0.5 * std::erf(3 * x / radius / std::numbers::sqrt2) / std::erf(3 / std::numbers::sqrt2);
    };
    std::vector<double> observed(kBins), expected(kBins);
    for (int i = 0; i < kBins; ++i)
      expected[static_cast<std::size_t>(i)] =
          (cdf(radius * (2.0 * (i + 1) / kBins - 1)) - cdf(radius * (2.0 * i / kBins - 1))) * (1 << 20);
    for (int i = 0; i < 1 << 20; ++i) {
      const float x = sample_filter(filter, static_cast<float>(radius), rng.next());
      ASSERT_LE(std::abs(x), radius);
      const int bin = std::min(kBins - 1, static_cast<int>((x / radius + 1) / 2 * kBins));
      observed[static_cast<std::size_t>(bin)] += 1;
    }
    EXPECT_GT(test::chi_square(observed, expected).p, test::significance(2)) << static_cast<int>(filter);
  }
}

TEST(Warp, FiltersReachTheirRadius) {
  EXPECT_FLOAT_EQ(sample_filter(PixelFilter::kGaussian, 1.5f, 0.0f), -1.5f);
  EXPECT_EQ(sample_filter(PixelFilter::kGaussian, 1.5f, 0.5f), 0.0f);
  EXPECT_EQ(sample_filter(PixelFilter::kBox, 0.5f, 0.0f), -0.5f);
}

TEST(Warp, EdgesAreFiniteUnitVectors) {
  for (float u0 : test::kEdgeNumbers)
    for (float u1 : test::kEdgeNumbers) {
      EXPECT_NEAR(length(uniform_sphere(u0, u1)), 1.0f, 1e-6f);
      EXPECT_NEAR(length(cosine_hemisphere(u0, u1)), 1.0f, 1e-6f);
      EXPECT_GE(cosine_hemisphere(u0, u1).z, 0.0f);
      EXPECT_NEAR(length(uniform_cone(0.01f, u0, u1)), 1.0f, 1e-6f);
    }
}

}  // namespace
}  // namespace voxlume
