#include "material/phase.h"

#include <gtest/gtest.h>

#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

constexpr float kAnisotropies[] = {-0.999f, -0.9f, -0.3f, 0.0f,  1e-4f, 0.01f,
                                   0.3f,    0.7f,  0.9f,  0.99f, 0.999f};
constexpr int kCount = static_cast<int>(std::size(kAnisotropies));

double textbook(double c, double g) {
  return (1 - g * g) / (4 * std::numbers::pi * std::pow(1 + g * g - 2 * g * c, 1.5));
}

TEST(PhaseHg, MatchesTheTextbookForm) {
  for (float g : kAnisotropies)
    for (float c : {-1.0f, -0.875f, -0.5f, 0.0f, 0.25f, 0.75f, 0.96875f, 1.0f}) {
      const double expected = textbook(c, g);
      EXPECT_NEAR(double{phase_hg(c, g)}, expected, expected * 1e-5) << g << " " << c;
    }
}

TEST(PhaseHg, OfDirectionsIsPreciseAtThePeak) {
  Rng rng(1, 0, 0, 0);
  for (float g : kAnisotropies)
    for (int i = 0; i < 1000; ++i) {
      const Vec3f wo = test::random_direction(rng);
      const float u0 = rng.next(), u1 = rng.next();
      const Vec3f wi = sample_hg(-wo, g, u0, u1);
      const Vec3d a = normalize(Vec3d(wo)), b = normalize(Vec3d(wi));
      const double expected = textbook(-dot(a, b), g);
      EXPECT_NEAR(double{phase_hg_between(wo, wi, g)}, expected, expected * 2e-3) << g;
    }
}

TEST(PhaseHg, SamplesFit) {
  Rng rng(2, 0, 0, 0);
  for (float g : kAnisotropies) {
    const Vec3f wo = test::random_direction(rng);
    const auto draw = [&] {
      const float u0 = rng.next(), u1 = rng.next();
      const Vec3f wi = sample_hg(-wo, g, u0, u1);
      return test::DirectionDraw{wi, phase_hg_between(wo, wi, g)};
    };
    SCOPED_TRACE(g);
    const test::SphereBins bins(g < 0 ? wo : -wo, 2 * (1 - std::abs(g)));
    const double total = test::expect_directions_fit(
        bins, draw, [&](Vec3f wi) { return phase_hg_between(wo, wi, g); }, kCount);
    EXPECT_NEAR(total, 1.0, 2e-4);
  }
}

TEST(PhaseHg, MeanCosineIsG) {
  for (float g : kAnisotropies) {
    Rng rng(3, 0, 0, 0);
    const Vec3f in = normalize(Vec3f(1, -2, 0.5f));
    test::Moments cosine;
    for (int i = 0; i < 1 << 18; ++i) {
      const float u0 = rng.next(), u1 = rng.next();
      cosine.add(double{dot(in, sample_hg(in, g, u0, u1))});
    }
    EXPECT_LT(std::abs(cosine.z(double{g}, 1e-7)), 4) << g;
  }
}

TEST(PhaseHg, EdgesAreFiniteUnitVectors) {
  const Vec3f directions[] = {{0, 0, 1}, {0, 0, -1}, {1, 0, 0}, {0, -1, 0}, normalize(Vec3f(1, 1, -1e-8f))};
  for (float g : {-0.999f, -0.5f, 0.0f, 1e-8f, 0.5f, 0.999f, 1.0f - 0x1p-24f})
    for (Vec3f in : directions)
      for (float u0 : test::kEdgeNumbers)
        for (float u1 : test::kEdgeNumbers) {
          const Vec3f wi = sample_hg(in, g, u0, u1);
          EXPECT_NEAR(length(wi), 1.0f, 1e-6f) << g << " " << u0 << " " << u1;
          const float p = phase_hg_between(-in, wi, g);
          EXPECT_TRUE(std::isfinite(p) && p >= 0.0f) << g << " " << u0 << " " << u1;
        }
}

}  // namespace
}  // namespace voxlume
