#include "material/surface.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

constexpr Vec3f kWhite(1.0f, 1.0f, 1.0f);

/// A unit vector at `degrees` from the unit normal.
Vec3f tilted(Vec3f normal, double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return normalize(Frame(normal).to_world(Vec3f(Vec3d(std::sin(a) * 0.6, std::sin(a) * 0.8, std::cos(a)))));
}

SurfaceLobe random_lobe(Rng& rng) {
  const float r = rng.next(), g = rng.next(), b = rng.next(), alpha = rng.next(), f0 = rng.next();
  return {Vec3f(r, g, b), alpha, f0 < 0.2f ? 0.0f : f0 < 0.4f ? 0.04f : f0};
}

double specular_albedo(const SurfaceLobe& lobe, Vec3f n, Vec3f wo) {
  const test::SphereBins bins(n);
  const auto parts = bins.integrate([&](Vec3f wi) { return eval_surface(lobe, n, wo, wi).specular.x; });
  return std::accumulate(parts.begin(), parts.end(), 0.0);
}

TEST(Surface, LambertReflectsExactlyItsAlbedo) {
  const SurfaceLobe lobe{{0.8f, 0.5f, 0.1f}, 0.3f, 0.0f};
  Rng rng(1, 0, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const Vec3f n = test::random_direction(rng), wo = test::random_direction(rng);
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
    if (!(s.pdf > 0)) continue;  // grazing beyond float
    const Vec3f weight = s.diffuse / s.pdf;
    EXPECT_NEAR(weight.x, 0.8f, 1e-6f);
    EXPECT_NEAR(weight.y, 0.5f, 1e-6f);
    EXPECT_NEAR(weight.z, 0.1f, 1e-6f);
    EXPECT_EQ(s.specular, Vec3f(0.0f));
  }
}

TEST(Surface, LambertValueIsAlbedoOverPi) {
  const SurfaceLobe lobe{{0.5f, 0.5f, 0.5f}, 0.3f, 0.0f};
  const Vec3f n(0, 0, 1);
  for (double angle : {0.0, 45.0, 89.0, 89.99}) {
    const Vec3f wi = tilted(n, angle);
    const double expected = 0.5 / std::numbers::pi * double{wi.z};
    EXPECT_NEAR(double{eval_surface(lobe, n, n, wi).diffuse.x}, expected, expected * 1e-6);
  }
}

TEST(Surface, LambertSamplesFit) {
  Rng rng(2, 0, 0, 0);
  const SurfaceLobe lobe{kWhite, 0.3f, 0.0f};
  const Vec3f n = test::random_direction(rng);
  const Vec3f wo = tilted(n, 100);  // from behind: the normal is flipped
  const auto draw = [&] {
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
    return test::DirectionDraw{s.wi, s.pdf};
  };
  const double total = test::expect_directions_fit(
      test::SphereBins(-n), draw, [&](Vec3f wi) { return eval_surface(lobe, n, wo, wi).pdf; }, 1);
  EXPECT_NEAR(total, 1.0, 1e-5);
}

struct GgxCase {
  float alpha;
  double degrees;
};
class Ggx : public testing::TestWithParam<GgxCase> {};

/// The specular part alone: a black base is never sampled.
TEST_P(Ggx, SamplesFit) {
  const auto [alpha, degrees] = GetParam();
  Rng rng(3, 0, 0, 0);
  const SurfaceLobe lobe{Vec3f(0.0f), alpha, 0.04f};
  const Vec3f n = test::random_direction(rng);
  const Vec3f wo = tilted(n, degrees);
  const Vec3f mirrored = n * (2 * dot(n, wo)) - wo;
  const auto draw = [&] {
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
    return test::DirectionDraw{s.wi, s.pdf};
  };
  const double width = 2 * std::max(1e-3, double{alpha});
  test::expect_directions_fit(
      test::SphereBins(mirrored, width), draw, [&](Vec3f wi) { return eval_surface(lobe, n, wo, wi).pdf; },
      16);
}

INSTANTIATE_TEST_SUITE_P(Surface, Ggx,
                         testing::Values(GgxCase{0.0f, 0}, GgxCase{0.0f, 45}, GgxCase{0.0f, 85},
                                         GgxCase{0.01f, 0}, GgxCase{0.01f, 60}, GgxCase{0.01f, 89},
                                         GgxCase{0.16f, 0}, GgxCase{0.16f, 45}, GgxCase{0.16f, 85},
                                         GgxCase{0.16f, 89.9}, GgxCase{0.5f, 20}, GgxCase{0.5f, 70},
                                         GgxCase{0.5f, 100}, GgxCase{1.0f, 0}, GgxCase{1.0f, 60},
                                         GgxCase{1.0f, 89}));

TEST(Surface, TwoLobeSamplesFit) {
  Rng rng(4, 0, 0, 0);
  for (double degrees : {10.0, 65.0}) {
    const SurfaceLobe lobe{{0.6f, 0.3f, 0.2f}, 0.2f, 0.04f};
    const Vec3f n = test::random_direction(rng);
    const Vec3f wo = tilted(n, degrees);
    const auto draw = [&] {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
      return test::DirectionDraw{s.wi, s.pdf};
    };
    test::expect_directions_fit(
        test::SphereBins(n), draw, [&](Vec3f wi) { return eval_surface(lobe, n, wo, wi).pdf; }, 2);
  }
}

TEST(Surface, ReportedDensityIsTheEvaluatedOne) {
  Rng rng(5, 0, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    const SurfaceLobe lobe = random_lobe(rng);
    const Vec3f n = test::random_direction(rng), wo = test::random_direction(rng);
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
    const SurfaceValue v = eval_surface(lobe, n, wo, s.wi);
    ASSERT_EQ(s.pdf, v.pdf);
    ASSERT_EQ(s.diffuse, v.diffuse);
    ASSERT_EQ(s.specular, v.specular);
    ASSERT_GT(dot(n, wo) * dot(n, s.wi) * (s.pdf > 0 ? 1.0f : 0.0f), s.pdf > 0 ? 0.0f : -1.0f);
  }
}

/// Single-scattering GGX with F = 1, looked at along the normal.
TEST(Surface, GgxKeepsTheKnownEnergy) {
  const Vec3f n(0, 0, 1);
  EXPECT_NEAR(specular_albedo({Vec3f(0.0f), 1.0f, 1.0f}, n, n), 1 - std::numbers::ln2, 2e-5);
  EXPECT_NEAR(specular_albedo({Vec3f(0.0f), 0.5f, 1.0f}, n, n), 0.688, 5e-4);
  EXPECT_NEAR(specular_albedo({Vec3f(0.0f), 0.1f, 1.0f}, n, n), 0.988, 5e-4);
}

TEST(Surface, WeightsAverageToTheDirectionalAlbedo) {
  const SurfaceLobe lobe{{0.9f, 0.9f, 0.9f}, 0.4f, 0.3f};
  const Vec3f n = normalize(Vec3f(1, 2, -3)), wo = tilted(n, 50);
  const test::SphereBins bins(n);
  const auto parts = bins.integrate([&](Vec3f wi) {
    const SurfaceValue v = eval_surface(lobe, n, wo, wi);
    return v.diffuse.x + v.specular.x;
  });
  const double expected = std::accumulate(parts.begin(), parts.end(), 0.0);
  Rng rng(6, 0, 0, 0);
  test::Moments mean;
  for (int i = 0; i < 1 << 18; ++i) {
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
    mean.add(s.pdf > 0 ? double{(s.diffuse.x + s.specular.x) / s.pdf} : 0.0);
  }
  EXPECT_LT(std::abs(mean.z(expected, 1e-5)), 4);
}

/// Random white surfaces never reflect more than they get: a one-sided z-test each, Sidak-corrected to
/// about 4.3.
TEST(Surface, NeverAddsEnergy) {
  Rng rng(7, 0, 0, 0);
  for (int i = 0; i < 500; ++i) {
    SurfaceLobe lobe = random_lobe(rng);
    lobe.albedo = kWhite;
    const Vec3f n = test::random_direction(rng), wo = test::random_direction(rng);
    test::Moments mean;
    for (int k = 0; k < 2000; ++k) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const SurfaceSample s = sample_surface(lobe, n, wo, u_lobe, u0, u1);
      mean.add(s.pdf > 0 ? double{(s.diffuse.x + s.specular.x) / s.pdf} : 0.0);
    }
    EXPECT_LE(mean.mean(), 1.0 + 4.3 * mean.standard_error() + 1e-6)
        << "alpha " << lobe.alpha << " f0 " << lobe.f0 << " cos " << dot(n, wo);
  }
}

TEST(Surface, IsReciprocal) {
  Rng rng(8, 0, 0, 0);
  int compared = 0;
  for (int i = 0; i < 20000; ++i) {
    const SurfaceLobe lobe = random_lobe(rng);
    const Vec3f n = test::random_direction(rng), a = test::random_direction(rng),
                b = test::random_direction(rng);
    const float cos_a = std::abs(dot(n, a)), cos_b = std::abs(dot(n, b));
    const SurfaceValue ab = eval_surface(lobe, n, a, b), ba = eval_surface(lobe, n, b, a);
    ASSERT_EQ(ab.pdf > 0, ba.pdf > 0);
    if (!(ab.pdf > 0)) continue;
    ++compared;
    const double f_ab = double{ab.diffuse.x + ab.specular.x} / double{cos_b};
    const double f_ba = double{ba.diffuse.x + ba.specular.x} / double{cos_a};
    EXPECT_NEAR(f_ab, f_ba, f_ab * 1e-4);
  }
  EXPECT_GT(compared, 5000);
}

TEST(Surface, BothSidesAreAlike) {
  const SurfaceLobe lobe{{0.6f, 0.3f, 0.2f}, 0.2f, 0.04f};
  const Vec3f n = normalize(Vec3f(1, 2, -3)), wo = tilted(n, 50), wi = tilted(n, 20);
  EXPECT_EQ(eval_surface(lobe, n, wo, wi).diffuse, eval_surface(lobe, -n, wo, wi).diffuse);
  EXPECT_EQ(eval_surface(lobe, n, wo, wi).specular, eval_surface(lobe, -n, wo, wi).specular);
  EXPECT_EQ(eval_surface(lobe, n, wo, -wi).pdf, 0.0f);
  EXPECT_EQ(eval_surface(lobe, n, wo, -wi).diffuse, Vec3f(0.0f));
}

TEST(Surface, EdgesAreFinite) {
  const Vec3f n(0, 0, 1);
  const Vec3f outgoing[] = {n,
                            -n,
                            {1, 0, 0},
                            normalize(Vec3f(1, 0, 1e-7f)),
                            normalize(Vec3f(1, 0, 1e-30f)),
                            normalize(Vec3f(-1, 2, -1e-3f))};
  for (float alpha : {0.0f, 1e-3f, 1.0f})
    for (float f0 : {0.0f, 1e-8f, 0.04f, 1.0f})
      for (float albedo : {0.0f, 1.0f})
        for (Vec3f wo : outgoing)
          for (float u_lobe : test::kEdgeNumbers)
            for (float u0 : test::kEdgeNumbers)
              for (float u1 : test::kEdgeNumbers) {
                const SurfaceSample s = sample_surface({Vec3f(albedo), alpha, f0}, n, wo, u_lobe, u0, u1);
                ASSERT_TRUE(is_finite(s.wi) && is_finite(s.diffuse) && is_finite(s.specular));
                ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f);
                ASSERT_NEAR(length(s.wi), 1.0f, 2e-6f);
                const SurfaceValue mirrored =
                    eval_surface({Vec3f(albedo), alpha, f0}, n, wo, {-wo.x, -wo.y, wo.z});
                ASSERT_TRUE(is_finite(mirrored.diffuse + mirrored.specular) && std::isfinite(mirrored.pdf));
              }
}

}  // namespace
}  // namespace voxlume
