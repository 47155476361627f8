#include <gtest/gtest.h>

#include <numbers>
#include <numeric>

#include "material/albedo_table.h"
#include "material/rough_diffuse.h"
#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

struct GgxIntegrals {
  double mirror = 0, schlick = 0, reflected = 0, refracted = 0;
};

/// What the tables hold, straight from the definitions: midpoints over n^2 / 4 pairs of numbers, each a
/// visible normal in double.
GgxIntegrals integrate(double cosine, double alpha, double eta, int n) {
  const Vec3d wo(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
  const Vec3d stretched = normalize(Vec3d(alpha * wo.x, 0, cosine));
  const auto lambda = [&](double c) { return 0.5 * (std::hypot(1.0, alpha * std::sqrt(1 - c * c) / c) - 1); };
  const auto kept = [&](double c) {
    c = std::min(c, 1.0);
    return c > 0 ? (1 + lambda(cosine)) / (1 + lambda(cosine) + lambda(c)) : 0.0;
  };
  GgxIntegrals out;
  for (int i = 0; i < n / 4; ++i)
    for (int k = 0; k < n; ++k) {
      const double phi = std::numbers::pi * (i + 0.5) / (n / 4), z = 1 - (k + 0.5) / n * (1 + stretched.z);
      const double s = std::sqrt(1 - z * z);
      const Vec3d h = normalize(
          Vec3d(alpha * (s * std::cos(phi) + stretched.x), alpha * s * std::sin(phi), z + stretched.z));
      const double cos_d = std::min(1.0, dot(wo, h)), weight = 4.0 / n / n;
      const double mirror = weight * kept(2 * cos_d * h.z - cosine);
      const double fresnel = fresnel_dielectric(cos_d, eta);
      out.mirror += mirror;
      out.schlick += mirror * std::pow(1 - cos_d, 5);
      out.reflected += fresnel * mirror;
      if (fresnel < 1) out.refracted += (1 - fresnel) * weight * kept(-refract(wo, h, eta).z);
    }
  return out;
}

/// A cosine in (0,1]: even, of the order of alpha, or even in its logarithm; and a width, even or even in its
/// logarithm.
struct Place {
  float cosine, alpha;
};
Place random_place(Rng& rng, int i) {
  const float a = rng.next(), b = rng.next();
  const float alpha = i % 3 == 0 ? std::max(a, kMinAlpha) : std::pow(10.0f, -3.0f * a);
  const float cosine = i % 4 == 0   ? std::pow(10.0f, -5.0f * b)
                       : i % 4 == 1 ? std::min(1.0f, alpha * std::pow(10.0f, 3.0f * b - 2.0f))
                                    : 1.0f - b;
  return {cosine, alpha};
}

TEST(Tables, MirrorFitsTheIntegral) {
  Rng rng(1, 0, 0, 0);
  double worst = 0, worst_mean = 0;
  for (int i = 0; i < 160; ++i) {
    const auto [cosine, alpha] = random_place(rng, i);
    const GgxIntegrals exact = integrate(double{cosine}, double{alpha}, 1.5, 800);
    const AlbedoEntry entry = ggx_albedo().at(cosine, alpha);
    const double error = std::abs(double{entry.albedo} / exact.mirror - 1);
    EXPECT_LT(error, 5e-4) << "cosine " << cosine << " alpha " << alpha;
    worst = std::max(worst, error);
    worst_mean = std::max(worst_mean, std::abs(double{entry.mean} - exact.schlick / exact.mirror));
  }
  EXPECT_LT(worst_mean, 8e-3);
  RecordProperty("worst", std::to_string(worst));
  RecordProperty("worst_mean", std::to_string(worst_mean));
}

/// Single-scattering GGX, looked at along the normal: 1 - ln 2 for alpha = 1.
TEST(Tables, MirrorKeepsTheKnownEnergy) {
  EXPECT_NEAR(ggx_albedo().at(1.0f, 1.0f).albedo, 1 - std::numbers::ln2, 5e-5);
  EXPECT_NEAR(ggx_albedo().at(1.0f, 0.0f).albedo, 1.0f, 1e-5);
  for (float alpha : {0.0f, 0.01f, 0.3f, 1.0f}) EXPECT_NEAR(ggx_albedo().at(0.0f, alpha).albedo, 1.0f, 1e-5);
}

TEST(Tables, GlassFitsTheIntegral) {
  Rng rng(2, 0, 0, 0);
  for (float ior : {1.1f, 1.5f, 3.0f}) {
    const GlassAlbedo table(ior);
    EXPECT_EQ(table.ior(), ior);
    double worst[2] = {}, squares[2] = {};
    constexpr int kPlaces = 48;
    for (int i = 0; i < kPlaces; ++i) {
      const auto [cosine, alpha] = random_place(rng, i);
      for (bool outside : {false, true}) {
        const GgxIntegrals exact =
            integrate(double{cosine}, double{alpha}, outside ? double{ior} : 1 / double{ior}, 600);
        const double error = std::abs(
            double{table.at(outside, cosine, alpha).albedo} / (exact.reflected + exact.refracted) - 1);
        EXPECT_LT(error, ior < 1.3f ? 4e-3 : 2e-3) << ior << " cosine " << cosine << " alpha " << alpha;
        worst[outside] = std::max(worst[outside], error);
        squares[outside] += error * error;
      }
    }
    for (bool outside : {false, true}) {
      EXPECT_LT(std::sqrt(squares[outside] / kPlaces), 7e-4) << ior << " " << outside;
      RecordProperty(
          (outside ? "worst_outside_" : "worst_inside_") + std::to_string(static_cast<int>(100 * ior)),
          std::to_string(worst[outside]));
    }
  }
}

/// A polished pane: everything arrives, and the reflected part is Fresnel's, away from the critical angle.
TEST(Tables, SmoothGlassIsFresnels) {
  const GlassAlbedo table(1.5f);
  for (float cosine : {1.0f, 0.9f, 0.6f}) {
    EXPECT_NEAR(table.at(true, cosine, 0.0f).albedo, 1.0f, 1e-5);
    EXPECT_NEAR(table.at(true, cosine, 0.0f).mean, fresnel_dielectric(cosine, 1.5f), 2e-3);
  }
  EXPECT_NEAR(table.at(false, 1.0f, 0.0f).mean, 0.04f, 1e-4);
  EXPECT_NEAR(table.at(false, 0.5f, 0.0f).mean, 1.0f, 1e-4);  // total
}

TEST(Tables, FresnelHasItsKnownValues) {
  EXPECT_NEAR(fresnel_dielectric(1.0, 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel_dielectric(1.0, 1 / 1.5), 0.04, 1e-15);
  EXPECT_NEAR(fresnel_dielectric(0.0, 1.5), 1.0, 1e-15);
  EXPECT_EQ(fresnel_dielectric(0.7, 1 / 1.5), 1.0);  // sin > 1 / 1.5
  EXPECT_LT(fresnel_dielectric(0.75, 1 / 1.5), 1.0);
  // Both ways the same, at the angles that Snell's law connects.
  for (double cosine : {0.1, 0.4, 0.9})
    EXPECT_NEAR(fresnel_dielectric(cosine, 1.5), fresnel_dielectric(refracted_cosine(cosine, 1.5), 1 / 1.5),
                1e-12);
  // Brewster's angle: half of what is left, the perpendicular part, is ((n^2 - 1) / (n^2 + 1))^2.
  const double brewster = 1 / std::hypot(1.0, 1.5);
  EXPECT_NEAR(fresnel_dielectric(brewster, 1.5), 0.5 * std::pow(1.25 / 3.25, 2), 1e-12);
}

TEST(Tables, RefractionObeysSnell) {
  Rng rng(3, 0, 0, 0);
  for (int i = 0; i < 1000; ++i) {
    const Vec3d h(test::random_direction(rng));
    Vec3d wo(test::random_direction(rng));
    if (dot(wo, h) < 0) wo = -wo;
    const double eta = 0.4 + 2 * rng.next();
    if (refracted_cosine(dot(wo, h), eta) == 0.0) continue;
    const Vec3d wi = refract(wo, normalize(h), eta);
    EXPECT_NEAR(length(cross(wo, h)), eta * length(cross(wi, h)), 2e-6);
    EXPECT_NEAR(length(wi), 1.0, 2e-6);
    EXPECT_LT(dot(wi, h), 0);
  }
}

TEST(Tables, RoughDiffuseAlbedoIsTheIntegral) {
  const Vec3f n(0, 0, 1);
  for (float roughness : {0.0f, 0.3f, 1.0f})
    for (float cosine : {1.0f, 0.8f, 0.3f, 0.05f, 1e-3f}) {
      const Vec3f wo(std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine);
      // s = sin sin cos(phi); by Gauss's rule of 2 points in many small steps of cos_i, split where t bends.
      double sum = 0;
      const auto add = [&](double from, double to) {
        constexpr int kSteps = 100, kAzimuths = 1024;
        for (int i = 0; i < 2 * kSteps; ++i) {
          const double offset = 0.5 + (i % 2 == 0 ? -0.5 : 0.5) / std::sqrt(3.0);
          const double v = (i / 2 + offset) / kSteps;
          const double angle = from + (to - from) * v;
          for (int k = 0; k < kAzimuths; ++k) {
            // Steps end where cos(phi) changes sign.
            const double phi = 2 * std::numbers::pi * (k + 0.5) / kAzimuths;
            const Vec3f wi(
                Vec3d(std::sin(angle) * std::cos(phi), std::sin(angle) * std::sin(phi), std::cos(angle)));
            sum += double{eval_rough_diffuse(cosine, wi.z, dot(wo, wi), roughness)} * std::sin(angle) *
                   (to - from) / (2 * kSteps) * 2 * std::numbers::pi / kAzimuths;
          }
        }
      };
      const double bend = std::acos(double{cosine});
      add(0, bend);
      add(bend, std::numbers::pi / 2);
      EXPECT_NEAR(double{rough_diffuse_albedo(cosine, roughness)}, sum, 1e-5) << roughness << " " << cosine;
    }
}

}  // namespace
}  // namespace voxlume
