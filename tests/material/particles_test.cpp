#include "material/particles.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "material/particle_kinds.h"
#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

using namespace test;  // the kinds

Vec3f total(const ScatterParts& s) { return s.diffuse + s.specular + s.phase; }

test::Moments mean_weight(Rng& rng, const ParticlePoint& p, Vec3f wo, int samples, int channel = 1) {
  test::Moments mean;
  const ParticleChoice choice = particle_choice(p, wo);
  for (int i = 0; i < samples; ++i) {
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const ScatterSample s = sample_particles(p, choice, wo, u_lobe, u0, u1);
    mean.add(s.pdf > 0 ? double{s.value[channel] / s.pdf} : 0.0);
  }
  return mean;
}

/// Errors of the tables: of glass, and of all else.
double table_error(const ParticlePoint& p) { return p.transmission > 0 ? 3e-3 : 5e-4; }

/// The furnace: white matter returns all, from any side and at any angle. Beyond the tables' errors 4.5
/// sigma each: all of them pass with probability 0.998.
TEST(Particles, WhiteReturnsAll) {
  Rng rng(1, 0, 0, 0);
  std::vector<ParticlePoint> all = kinds(kWhite);
  for (float alpha : {0.0f, 0.01f, 0.1f, 1.0f}) {
    all.push_back(metal(kWhite, alpha));
    all.push_back(coated(kWhite, alpha, 0.5f));
    all.push_back(glass(kWhite, alpha, 1.5f));
    all.push_back(glass(kWhite, alpha, 3.0f));
    all.push_back(glass(kWhite, alpha, 1.05f));
    all.push_back(glass(kWhite, alpha, 1.001f));
    all.push_back(glass(kWhite, alpha, 1.0f));
  }
  for (std::size_t i = 0; i < all.size(); ++i)
    for (double degrees : {0.0, 40.0, 80.0, 89.5, 110.0, 150.0}) {
      const test::Moments mean = mean_weight(rng, all[i], tilted(degrees), 1 << 14);
      EXPECT_LT(std::abs(mean.z(1.0, table_error(all[i]) + 1e-5)), 4.5)
          << i << " " << degrees << " " << mean.mean();
    }
}

/// White matter of one kind changes no path's weight, so that a furnace stays white after any number of
/// scatterings. (Diffuse by r > 0 is drawn nearly so, and kinds are mixed with floors.)
TEST(Particles, WhiteOfOneKindWeighsOne) {
  Rng rng(21, 0, 0, 0);
  for (const ParticlePoint& p : {metal(kWhite, 0.16f), metal(kWhite, 1.0f), glass(kWhite, 0.16f, 1.5f),
                                 glass(kWhite, 1.0f, 1.5f), glass(kWhite, 0.5f, 3.0f)})
    for (const double degrees : {0.0, 60.0, 85.0, 120.0, 170.0}) {
      const Vec3f wo = tilted(degrees);
      const ParticleChoice choice = particle_choice(p, wo);
      for (int i = 0; i < 2000; ++i) {
        const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
        const ScatterSample s = sample_particles(p, choice, wo, u_lobe, u0, u1);
        ASSERT_GT(s.pdf, 0);
        ASSERT_NEAR(s.value.y / s.pdf, 1, 1e-5) << p.alpha << " " << p.ior << " " << degrees;
      }
    }
}

TEST(Particles, WhiteIntegratesToOne) {
  const auto all = kinds(kWhite);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (double degrees : {30.0, 120.0}) {
      const Vec3f wo = tilted(degrees);
      const ParticleChoice choice = particle_choice(all[i], wo);
      const auto parts = test::SphereBins(kNormal).integrate(
          [&](Vec3f wi) { return total(eval_particles(all[i], choice, wo, wi)).x; }, 1e-6);
      EXPECT_NEAR(std::accumulate(parts.begin(), parts.end(), 0.0), 1.0, table_error(all[i]))
          << i << " " << degrees;
    }
}

/// The samples' mean is particle_albedo, which never exceeds 1.
TEST(Particles, AlbedoIsTheIntegral) {
  Rng rng(2, 0, 0, 0);
  for (int i = 0; i < 150; ++i) {
    const float r = rng.next(), g = rng.next(), b = rng.next(), alpha = std::max(0.2f, rng.next());
    ParticlePoint p = mixture({r, g, b}, rng.next(), rng.next(), rng.next(), alpha);
    p.f0 = 0.3f * rng.next();
    p.diffuse_roughness = rng.next();
    const Vec3f wo = test::random_direction(rng);
    const Vec3f albedo = particle_albedo(p, wo);
    ASSERT_LE(max_component(albedo), 1.0f);
    const test::Moments mean = mean_weight(rng, p, wo, 1 << 13, i % 3);
    EXPECT_LT(std::abs(mean.z(double{albedo[i % 3]}, 1e-2)), 4.0) << i;
  }
}

TEST(Particles, AlbedoNeverExceedsOne) {
  Rng rng(3, 0, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    const float r = rng.next(), g = rng.next(), b = rng.next();
    ParticlePoint p = mixture({r, g, b}, rng.next(), rng.next(), rng.next(), rng.next());
    p.f0 = rng.next();
    p.diffuse_roughness = rng.next();
    const Vec3f albedo = particle_albedo(p, test::random_direction(rng));
    ASSERT_LE(max_component(albedo), 1.0f);
    ASSERT_GE(min_component(albedo), 0.0f);
  }
}

void expect_fit(Rng& rng, const ParticlePoint& p, Vec3f wo, const test::SphereBins& bins, int tests) {
  const ParticleChoice choice = particle_choice(p, wo);
  const auto draw = [&] {
    const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
    const ScatterSample s = sample_particles(p, choice, wo, u_lobe, u0, u1);
    return test::DirectionDraw{s.wi, s.pdf};
  };
  test::expect_directions_fit(
      bins, draw, [&](Vec3f wi) { return eval_particles(p, choice, wo, wi).pdf; }, tests);
}

TEST(Particles, SamplesFitTheDensity) {
  Rng rng(4, 0, 0, 0);
  const auto all = kinds({0.9f, 0.6f, 0.3f});
  for (std::size_t i = 0; i < all.size(); ++i) {
    SCOPED_TRACE(i);
    expect_fit(rng, all[i], tilted(i % 2 == 0 ? 35 : 130), test::SphereBins(kNormal),
               static_cast<int>(all.size()));
  }
}

/// Narrow lobes, with bins about the reflected or refracted direction.
TEST(Particles, NarrowSamplesFitTheDensity) {
  Rng rng(5, 0, 0, 0);
  for (float alpha : {0.001f, 0.03f}) {
    SCOPED_TRACE(alpha);
    const Vec3f wo = tilted(50);
    const Vec3f mirrored = normalize(kNormal * (2 * dot(kNormal, wo)) - wo);
    const double width = 2 * double{alpha};
    expect_fit(rng, metal({0.9f, 0.6f, 0.3f}, alpha), wo, test::SphereBins(mirrored, width), 8);
    // At (ior - 1) alpha = 1e-6 directions are too coarse for the lobe.
    for (float ior : {1.5f, alpha > 0.01f ? 1.001f : 1.05f})
      expect_fit(rng, glass(kWhite, alpha, ior), wo,
                 test::SphereBins(refract(wo, kNormal, ior), width * double{ior - 1.0f}), 8);
  }
  const Vec3f wo = tilted(70);
  expect_fit(rng, glass(kWhite, 0.1f, 1.0f), wo, test::SphereBins(-wo, 3e-3), 8);
  expect_fit(rng, glass(kWhite, 0.1f, 1.0f), -wo, test::SphereBins(wo, 3e-3), 8);
}

TEST(Particles, ReportedDensityIsTheEvaluatedOne) {
  Rng rng(6, 0, 0, 0);
  for (const ParticlePoint& p : kinds({0.9f, 0.6f, 0.3f}))
    for (int i = 0; i < 2000; ++i) {
      const Vec3f wo = test::random_direction(rng);
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample sample = sample_particles(p, wo, u_lobe, u0, u1);
      if (!(sample.pdf > 0)) continue;
      const ScatterParts parts = eval_particles(p, wo, sample.wi);
      ASSERT_EQ(sample.pdf, parts.pdf);
      ASSERT_EQ(sample.value, total(parts));
    }
}

TEST(Particles, SpecularShareIsWhatIsDrawn) {
  const Vec3f wo = tilted(60);
  EXPECT_EQ(specular_share(metal({0.5f, 0.5f, 0.5f}, 0.2f), wo), 1.0f);
  EXPECT_EQ(specular_share(glass({0.5f, 0.5f, 0.5f}, 0.2f, 1.5f), wo), 1.0f);
  EXPECT_EQ(specular_share(lambert({0.5f, 0.5f, 0.5f}), wo), 0.0f);
  EXPECT_EQ(specular_share(medium({0.5f, 0.5f, 0.5f}, 0.2f, 0.0f, 0.0f), wo), 0.0f);
  EXPECT_EQ(specular_share(coated(Vec3f(0.0f), 0.2f, 0.04f), wo), 1.0f);
  EXPECT_NEAR(specular_share(coated(kWhite, 0.2f, 0.3f), wo), fresnel_schlick(0.3f, dot(wo, kNormal)), 1e-5f);
  // Black: nothing at all.
  EXPECT_EQ(particle_choice(lambert(Vec3f(0.0f)), wo).any, 0.0f);
  EXPECT_EQ(sample_particles(lambert(Vec3f(0.0f)), wo, 0.5f, 0.5f, 0.5f).pdf, 0.0f);
}

/// Kinds that add nothing to the value are not drawn, whatever the random number.
TEST(Particles, ChoiceReachesToOne) {
  Rng rng(7, 0, 0, 0);
  for (int i = 0; i < 20000; ++i) {
    ParticlePoint p = mixture(kWhite, rng.next(), rng.next(), rng.next(), 0.2f);
    if (i % 2 == 0) p.p_surface = 1.0f;
    if (i % 3 == 0) p.metallic = 1.0f;
    const ParticleChoice c = particle_choice(p, test::random_direction(rng));
    ASSERT_EQ(c.any, 1.0f);
    ASSERT_TRUE(0 <= c.metal && c.metal <= c.glass && c.glass <= c.coat && c.coat <= c.diffuse &&
                c.diffuse <= 1);
    ASSERT_TRUE(p.p_surface < 1.0f || c.diffuse == 1.0f);
    ASSERT_TRUE(p.p_surface < 1.0f || p.metallic < 1.0f || c.metal == 1.0f);
  }
}

/// Smooth glass: samples leave by Snell's law, are mirrored as often as Fresnel says, and all of them beyond
/// the critical angle.
TEST(Particles, SmoothGlassRefracts) {
  Rng rng(8, 0, 0, 0);
  for (double degrees : {0.0, 30.0, 70.0, 100.0, 145.0, 175.0}) {
    const Vec3f wo = tilted(degrees);
    const bool outside = dot(wo, kNormal) > 0;
    const Vec3f n = outside ? kNormal : -kNormal;
    const float eta = outside ? 1.5f : 1 / 1.5f;
    const ParticlePoint p = glass(kWhite, 0.0f, 1.5f);
    const float fresnel = fresnel_dielectric(dot(wo, n), eta);
    const bool total_reflection = !outside && length(cross(wo, n)) * 1.5f > 1;
    EXPECT_EQ(fresnel == 1.0f, total_reflection);
    const Vec3f mirrored = n * (2 * dot(n, wo)) - wo, through = refract(wo, n, eta);
    double reflections = 0;
    constexpr int kSamples = 20000;
    std::vector<float> off;
    for (int i = 0; i < kSamples; ++i) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample s = sample_particles(p, wo, u_lobe, u0, u1);
      if (!(s.pdf > 0)) continue;
      const bool reflects = dot(s.wi, n) > 0;
      reflections += reflects;
      off.push_back(length(s.wi - (reflects ? mirrored : through)));
    }
    ASSERT_GT(off.size(), 0.999 * kSamples);
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
    EXPECT_LT(off[off.size() / 2], 6 * kMinAlpha) << degrees;
    const double expected = kSamples * double{fresnel};
    EXPECT_NEAR(reflections, expected, 4 * std::sqrt(expected * (1 - double{fresnel})) + 1e-3 * kSamples)
        << degrees;
  }
}

TEST(Particles, RefractionAloneHasTheColor) {
  const ParticlePoint p = glass({0.0f, 0.5f, 1.0f}, 0.3f, 1.5f);
  const Vec3f wo = tilted(40);
  const Vec3f reflected = eval_particles(p, wo, tilted(-40)).specular;
  EXPECT_GT(reflected.x, 0);
  EXPECT_EQ(reflected, Vec3f(reflected.x));
  const Vec3f refracted = eval_particles(p, wo, refract(wo, kNormal, 1.5f)).specular;
  EXPECT_EQ(refracted.x, 0);
  EXPECT_GT(refracted.y, 0);
  EXPECT_EQ(refracted.y, 0.5f * refracted.z);
}

/// Without a bend everything passes, within a few milliradians, with the color.
TEST(Particles, GlassOfNoIndexPassesStraight) {
  Rng rng(9, 0, 0, 0);
  for (float ior : {1.0f, 1.0005f})
    for (double degrees : {0.0, 60.0, 89.99, 120.0}) {
      const ParticlePoint p = glass({0.2f, 0.5f, 0.9f}, 0.5f, ior);
      const Vec3f wo = tilted(degrees);
      for (int i = 0; i < 2000; ++i) {
        const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
        const ScatterSample s = sample_particles(p, wo, u_lobe, u0, u1);
        ASSERT_GT(s.pdf, 0);
        ASSERT_LT(length(s.wi + wo), 6e-3f);
        ASSERT_NEAR(s.value.x / s.pdf, 0.2f, 1e-6f);
        ASSERT_NEAR(s.value.z / s.pdf, 0.9f, 1e-6f);
      }
    }
}

TEST(Particles, TwoLobesMeanCosine) {
  Rng rng(10, 0, 0, 0);
  struct Lobes {
    float g, g_back, share;
  };
  for (const auto [g, g_back, share] : {Lobes{0.9f, -0.4f, 0.3f},
                                        {0.2f, 0.7f, 0.9f},
                                        {-0.5f, 0.0f, 0.5f},
                                        {0.8f, -0.8f, 1.0f},
                                        {0.8f, 0.1f, 0.0f}}) {
    const ParticlePoint p = medium({0.5f, 0.7f, 0.9f}, g, g_back, share);
    const Vec3f wo = test::random_direction(rng);
    test::Moments mean;
    for (int i = 0; i < 1 << 17; ++i) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample s = sample_particles(p, wo, u_lobe, u0, u1);
      mean.add(double{dot(s.wi, -wo)});
      ASSERT_NEAR(s.value.y / s.pdf, 0.7f, 1e-6f);
    }
    EXPECT_LT(std::abs(mean.z(double{(1 - share) * g + share * g_back})), 4) << g << " " << g_back;
  }
}

/// All but glass have two sides, and scatter nothing beyond.
TEST(Particles, SurfacesHaveTwoSides) {
  for (ParticlePoint p : {rough({0.5f, 0.6f, 0.7f}, 0.6f), coated({0.5f, 0.6f, 0.7f}, 0.3f, 0.2f),
                          metal({0.5f, 0.6f, 0.7f}, 0.3f)}) {
    const Vec3f wo = tilted(40), wi = tilted(-20);
    const ScatterParts front = eval_particles(p, wo, wi);
    EXPECT_EQ(total(eval_particles(p, wo, -wi)), Vec3f(0.0f));
    EXPECT_EQ(eval_particles(p, wo, -wi).pdf, 0.0f);
    p.normal = -p.normal;
    EXPECT_EQ(total(eval_particles(p, wo, wi)), total(front));
    EXPECT_EQ(eval_particles(p, wo, wi).pdf, front.pdf);
  }
}

/// Weights stay within the reciprocal of the least albedo, so that rough diffuse light has no fireflies.
TEST(Particles, RoughDiffuseWeightsAreBounded) {
  Rng rng(11, 0, 0, 0);
  for (double degrees : {30.0, 85.0, 89.99})
    for (int i = 0; i < 100000; ++i) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample s = sample_particles(rough(kWhite, 1.0f), tilted(degrees), u_lobe, u0, u1);
      ASSERT_LE(s.value.x, 5.0f * s.pdf);
    }
}

TEST(Particles, EdgesAreFinite) {
  const Vec3f n(0, 0, 1);
  const Vec3f outgoing[] = {n,
                            -n,
                            Vec3f(1, 0, 0),
                            normalize(Vec3f(1, 0, 1e-7f)),
                            normalize(Vec3f(0, 1, -1e-20f)),
                            normalize(Vec3f(-1, 2, -1e-3f))};
  int weighted = 0;
  for (float p_surface : {0.0f, 0.5f, 1.0f})
    for (float metallic : {0.0f, 0.5f, 1.0f})
      for (float transmission : {0.0f, 0.5f, 1.0f})
        for (float ior : {1.0f, 1.0005f, 1.001f, 3.0f})
          for (float alpha : {0.0f, 1.0f})
            for (float g : {-0.999f, 0.999f})
              for (float color : {0.0f, 1e-20f, 1.0f})
                for (Vec3f wo : outgoing)
                  for (float u_lobe : test::kEdgeNumbers)
                    for (float u0 : {0.0f, 0.5f, 1.0f - 0x1p-24f})
                      for (float u1 : {0.0f, 1.0f - 0x1p-24f}) {
                        const ParticlePoint p{p_surface > 0 ? n : Vec3f(0.0f),
                                              p_surface,
                                              Vec3f(color),
                                              alpha,
                                              alpha * 0.5f,
                                              metallic,
                                              transmission,
                                              ior,
                                              alpha,
                                              g,
                                              -g,
                                              0.5f,
                                              glass_of(ior)};
                        const ScatterSample s = sample_particles(p, wo, u_lobe, u0, u1);
                        ASSERT_TRUE(is_finite(s.wi) && is_finite(s.value) && std::isfinite(s.pdf));
                        ASSERT_GE(s.pdf, 0.0f);
                        ASSERT_GE(min_component(s.value), 0.0f);
                        ASSERT_NEAR(length(s.wi), 1.0f, 3e-6f);
                        if (!(s.pdf > 0)) continue;
                        ++weighted;
                        ASSERT_TRUE(is_finite(s.value / s.pdf));
                      }
  EXPECT_GT(weighted, 100000);
  // Directions that no sampler would draw.
  for (const ParticlePoint& p : kinds(kWhite))
    for (Vec3f wo : outgoing)
      for (Vec3f wi : outgoing)
        for (Vec3f at : {wi, -wi, wo, -wo}) {
          const ScatterParts parts = eval_particles(p, wo, at);
          ASSERT_TRUE(is_finite(total(parts)) && std::isfinite(parts.pdf) && parts.pdf >= 0.0f);
        }
}

}  // namespace
}  // namespace voxlume
