#include <gtest/gtest.h>

#include "light_scenes.h"
#include "support/chi_square.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

using test::significance;

TEST(DirectionBins, AreEquallyLikely) {
  constexpr int kDraws = 400000;
  std::vector<double> observed(DirectionBins::kCount),
      expected(DirectionBins::kCount, double{kDraws} / DirectionBins::kCount);
  Rng rng(11, 0, 0, 0);
  for (int i = 0; i < kDraws; ++i)
    observed[static_cast<std::size_t>(DirectionBins::bin_of(test::random_direction(rng)))] += 1;
  EXPECT_GT(test::chi_square(observed, expected).p, significance(4));
}

TEST(DirectionBins, AreWhereTheirDirectionsAre) {
  Rng rng(12, 0, 0, 0);
  for (int bin = 0; bin < DirectionBins::kCount; ++bin)
    for (int i = 0; i < 100; ++i) {
      const float u0 = 0.001f + 0.998f * rng.next(), u1 = 0.001f + 0.998f * rng.next();
      const Vec3f d = DirectionBins::direction_in(bin, u0, u1);
      ASSERT_NEAR(length(d), 1, 1e-6);
      ASSERT_EQ(DirectionBins::bin_of(d), bin);
    }
  for (const float u0 : test::kEdgeNumbers)
    for (const float u1 : test::kEdgeNumbers) {
      const int bin = DirectionBins::bin_of(DirectionBins::direction_in(DirectionBins::kCount - 1, u0, u1));
      EXPECT_TRUE(bin >= 0 && bin < DirectionBins::kCount);
    }
}

/// Two cells with likings of their own, over a sky.
class Guide : public testing::Test {
 protected:
  Guide() : lights_(test::compile({}, EnvironmentDescription{}, &image_)) {
    Rng rng(13, 0, 0, 0);
    for (int cell = 0; cell < 2; ++cell) {
      std::vector<double> weights(DirectionBins::kCount);
      for (double& w : weights) w = std::max(0.0, double{rng.next()} - 0.3);
      const Distribution1D distribution(weights);
      cdf_.insert(cdf_.end(), distribution.view().cdf, distribution.view().cdf + DirectionBins::kCount + 1);
    }
    view_ = lights_.view();
    view_.guide = {{Vec3f(-1), Vec3f(1)}, {1, 1, 2}, cdf_.data()};
  }

  const EnvironmentImage image_ = test::sky();
  const Lights lights_;
  std::vector<float> cdf_;
  LightsView view_;
};

TEST_F(Guide, SamplesFitInEachCellAndOutside) {
  for (const Vec3f p : {Vec3f(0, 0, -0.5f), Vec3f(0, 0, 0.5f), Vec3f(3, 0, 9)}) {
    Rng rng(14, 0, 0, 0);
    const auto draw = [&] {
      const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
      const LightSample s = sample_light(view_, p, u_pick, u0, u1);
      EXPECT_NEAR(s.pdf, environment_hit(view_, p, s.wi).pdf, 1e-6f);
      return test::DirectionDraw{s.wi, s.pdf};
    };
    const double total = test::expect_directions_fit(
        test::SphereBins(Vec3f(0, 0, 1), 2), draw, [&](Vec3f d) { return environment_hit(view_, p, d).pdf; },
        6);
    EXPECT_NEAR(total, 1.0, 5e-3);
  }
}

TEST_F(Guide, CellsDiffer) {
  const Vec3f d = DirectionBins::direction_in(40, 0.5f, 0.5f);
  EXPECT_NE(environment_hit(view_, Vec3f(0, 0, -0.5f), d).pdf,
            environment_hit(view_, Vec3f(0, 0, 0.5f), d).pdf);
  EXPECT_EQ(environment_hit(view_, Vec3f(0, 0, 0.5f), d).pdf, environment_hit(view_, Vec3f(0, 0, 7), d).pdf);
}

TEST(UniformLightSamples, TakeAllDirectionsAndLightsAlike) {
  const EnvironmentImage image = test::sky();
  const Lights lights = test::compile({test::point({300, 0, 0}, 7), test::directional({0, 0, 1}, 50)},
                                      EnvironmentDescription{}, &image, EnvironmentSamples::kUniform);
  const LightsView view = lights.view();
  Rng rng(15, 0, 0, 0);
  for (int i = 0; i < 1000; ++i)
    EXPECT_NEAR(environment_hit(view, Vec3f(0), test::random_direction(rng)).pdf, kUniformSpherePdf / 3,
                1e-6f);
  EXPECT_NEAR(sample_light(view, Vec3f(0), 0.1f, 0, 0).pdf, 1.0 / 3, 1e-6);
  EXPECT_NEAR(sample_light(view, Vec3f(0), 0.5f, 0, 0).pdf, 1.0 / 3, 1e-6);
}

}  // namespace
}  // namespace voxlume
