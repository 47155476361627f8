#include "material/scatter.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

const Vec3f kNormal = normalize(Vec3f(0.2f, -0.5f, 0.7f));

/// A few mixtures that differ in what dominates.
std::vector<ScatterPoint> mixtures() {
  return {
      {kNormal, 0.5f, {0.8f, 0.6f, 0.4f}, 0.0f, 0.16f, 0.04f},    // the default material
      {kNormal, 0.02f, {0.9f, 0.9f, 0.9f}, 0.8f, 0.5f, 0.08f},    // almost a medium: P_b is clamped
      {kNormal, 0.99f, {0.3f, 0.3f, 0.3f}, -0.6f, 0.05f, 0.04f},  // almost a surface
      {kNormal, 1.0f, {0.7f, 0.7f, 0.7f}, 0.0f, 1.0f, 0.5f},      // nothing but a surface
      {{0, 0, 0}, 0.0f, {0.7f, 0.7f, 0.7f}, 0.5f, 0.3f, 0.04f},   // nothing but a medium
      {kNormal, 0.6f, {0.5f, 0.5f, 0.5f}, 0.3f, 0.3f, 0.0f},      // Lambert and phase
      {kNormal, 0.5f, {0.0f, 0.0f, 0.0f}, 0.3f, 0.2f, 0.04f},     // black: specular alone
  };
}

Vec3f outgoing(Rng& rng, double least_cosine) {
  for (;;) {
    const Vec3f wo = test::random_direction(rng);
    if (std::abs(dot(wo, kNormal)) > least_cosine) return wo;
  }
}

TEST(Scatter, SamplesFitTheMixtureDensity) {
  Rng rng(1, 0, 0, 0);
  const auto all = mixtures();
  for (std::size_t i = 0; i < all.size(); ++i) {
    const ScatterPoint& s = all[i];
    const Vec3f wo = outgoing(rng, 0.2);
    const auto draw = [&] {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample sample = sample_scatter(s, wo, u_lobe, u0, u1);
      return test::DirectionDraw{sample.wi, sample.pdf};
    };
    SCOPED_TRACE(i);
    const double total = test::expect_directions_fit(
        test::SphereBins(kNormal), draw, [&](Vec3f wi) { return eval_scatter(s, wo, wi).pdf; },
        static_cast<int>(all.size()));
    if (s.f0 == 0.0f || s.p_brdf == 0.0f) {
      EXPECT_NEAR(total, 1.0, 1e-4);
    }
  }
}

TEST(Scatter, WeightsAverageToTheIntegralOfH) {
  Rng rng(2, 0, 0, 0);
  for (const ScatterPoint& s : mixtures()) {
    const Vec3f wo = outgoing(rng, 0.1);
    const auto parts =
        test::SphereBins(kNormal).integrate([&](Vec3f wi) { return eval_scatter(s, wo, wi).value.y; });
    const double expected = std::accumulate(parts.begin(), parts.end(), 0.0);
    test::Moments mean;
    for (int i = 0; i < 1 << 18; ++i) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample sample = sample_scatter(s, wo, u_lobe, u0, u1);
      mean.add(sample.pdf > 0 ? double{sample.value.y / sample.pdf} : 0.0);
    }
    EXPECT_LT(std::abs(mean.z(expected, 1e-4 * expected)), 4) << s.p_brdf << " " << s.g << " " << s.f0;
  }
}

/// Whatever the share, white matter with a Lambert surface loses and gains nothing.
TEST(Scatter, WhiteLambertAndPhaseConserveEnergy) {
  Rng rng(3, 0, 0, 0);
  for (float p_brdf : {0.0f, 0.001f, 0.3f, 0.999f, 1.0f})
    for (float g : {-0.9f, 0.0f, 0.9f}) {
      const ScatterPoint s{kNormal, p_brdf, Vec3f(1.0f), g, 0.3f, 0.0f};
      const Vec3f wo = outgoing(rng, 0.05);
      const auto parts = test::SphereBins(g < 0 ? wo : -wo, 2 * (1 - std::abs(g))).integrate([&](Vec3f wi) {
        return eval_scatter(s, wo, wi).value.x;
      });
      EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0), 1.0, 1e-4) << p_brdf << " " << g;
    }
}

TEST(Scatter, NeverAddsEnergy) {
  Rng rng(4, 0, 0, 0);
  for (int i = 0; i < 300; ++i) {
    const float p_brdf = rng.next(), g = 1.9f * rng.next() - 0.95f, alpha = rng.next(), f0 = rng.next();
    const ScatterPoint s{kNormal, p_brdf, Vec3f(1.0f), g, alpha, f0};
    const Vec3f wo = test::random_direction(rng);
    test::Moments mean;
    for (int k = 0; k < 3000; ++k) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample sample = sample_scatter(s, wo, u_lobe, u0, u1);
      mean.add(sample.pdf > 0 ? double{sample.value.x / sample.pdf} : 0.0);
    }
    EXPECT_LE(mean.mean(), 1.0 + 4.2 * mean.standard_error() + 1e-6)
        << p_brdf << " " << g << " " << alpha << " " << f0;
  }
}

TEST(Scatter, ReportedDensityIsTheEvaluatedOne) {
  Rng rng(5, 0, 0, 0);
  for (const ScatterPoint& s : mixtures())
    for (int i = 0; i < 5000; ++i) {
      const Vec3f wo = test::random_direction(rng);
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample sample = sample_scatter(s, wo, u_lobe, u0, u1);
      if (!(sample.pdf > 0)) continue;
      const ScatterValue v = eval_scatter(s, wo, sample.wi);
      ASSERT_EQ(sample.pdf, v.pdf);
      ASSERT_EQ(sample.value, v.value);
    }
}

TEST(Scatter, PartsAddUp) {
  Rng rng(6, 0, 0, 0);
  for (const ScatterPoint& s : mixtures())
    for (int i = 0; i < 200; ++i) {
      const Vec3f wo = test::random_direction(rng), wi = test::random_direction(rng);
      const ScatterParts parts = eval_scatter_parts(s, wo, wi);
      const SurfaceValue surface =
          s.p_brdf > 0 ? eval_surface(surface_lobe(s), s.normal, wo, wi) : SurfaceValue{};
      ASSERT_EQ(parts.diffuse, surface.diffuse * s.p_brdf);
      ASSERT_EQ(parts.specular, surface.specular * s.p_brdf);
      const float rho = phase_hg(-dot(wo, wi), s.g);
      ASSERT_NEAR(parts.phase.x, s.albedo.x * (1 - s.p_brdf) * rho, 1e-4f * rho);
      ASSERT_EQ(eval_scatter(s, wo, wi).value, parts.diffuse + parts.specular + parts.phase);
    }
}

/// h(a,b)/cos is symmetric for the surface, and the phase function is symmetric as it is.
TEST(Scatter, PhaseIsReciprocal) {
  Rng rng(7, 0, 0, 0);
  const ScatterPoint s{{0, 0, 0}, 0.0f, Vec3f(0.9f), 0.7f, 0.3f, 0.04f};
  for (int i = 0; i < 1000; ++i) {
    const Vec3f a = test::random_direction(rng), b = test::random_direction(rng);
    ASSERT_EQ(eval_scatter(s, a, b).value, eval_scatter(s, b, a).value);
  }
}

TEST(Scatter, ChoiceFollowsTheLuminancesWithinItsClamp) {
  const Vec3f wo = kNormal;
  // Lambert and phase of one albedo: P_b = P_brdf.
  EXPECT_NEAR(scatter_choice({kNormal, 0.3f, Vec3f(0.5f), 0.0f, 0.3f, 0.0f}, wo).surface, 0.3f, 1e-6f);
  EXPECT_EQ(scatter_choice({kNormal, 0.01f, Vec3f(0.5f), 0.0f, 0.3f, 0.0f}, wo).surface, 0.05f);
  EXPECT_EQ(scatter_choice({kNormal, 0.99f, Vec3f(0.5f), 0.0f, 0.3f, 0.0f}, wo).surface, 0.95f);
  EXPECT_EQ(scatter_choice({kNormal, 1.0f, Vec3f(0.5f), 0.0f, 0.3f, 0.0f}, wo).surface, 1.0f);
  EXPECT_EQ(scatter_choice({kNormal, 0.0f, Vec3f(0.5f), 0.0f, 0.3f, 0.0f}, wo).surface, 0.0f);
  EXPECT_EQ(scatter_choice({kNormal, 0.5f, Vec3f(0.0f), 0.0f, 0.3f, 0.0f}, wo).any, 0.0f);
  EXPECT_EQ(sample_scatter({kNormal, 0.5f, Vec3f(0.0f), 0.0f, 0.3f, 0.0f}, wo, 0.5f, 0.5f, 0.5f).pdf, 0.0f);
  EXPECT_EQ(eval_scatter({kNormal, 0.5f, Vec3f(0.0f), 0.0f, 0.3f, 0.0f}, wo, wo).pdf, 0.0f);
}

TEST(Scatter, EdgesAreFinite) {
  const Vec3f n(0, 0, 1);
  for (float p_brdf : {0.0f, 0.5f, 1.0f})
    for (float g : {-0.999f, 0.0f, 0.999f})
      for (float albedo : {0.0f, 1e-20f, 1.0f})
        for (Vec3f wo : {n, -n, Vec3f(0, 1, 0), normalize(Vec3f(0, 1, -1e-20f))})
          for (float u_lobe : test::kEdgeNumbers)
            for (float u0 : test::kEdgeNumbers)
              for (float u1 : test::kEdgeNumbers) {
                const ScatterPoint s{p_brdf > 0 ? n : Vec3f(0.0f), p_brdf, Vec3f(albedo), g, 0.0f, 0.04f};
                const ScatterSample sample = sample_scatter(s, wo, u_lobe, u0, u1);
                ASSERT_TRUE(is_finite(sample.wi) && is_finite(sample.value));
                ASSERT_TRUE(std::isfinite(sample.pdf) && sample.pdf >= 0.0f);
                ASSERT_NEAR(length(sample.wi), 1.0f, 2e-6f);
              }
}

}  // namespace
}  // namespace voxlume
