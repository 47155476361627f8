#include "material/blinn_phong.h"

#include <gtest/gtest.h>

#include <numeric>

#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

const Vec3f kNormal = normalize(Vec3f(0.2f, -0.5f, 0.7f));

struct Case {
  ScatterPoint point;
  Highlight highlight;
};

std::vector<Case> cases() {
  const auto matter = [](Vec3f albedo, float g) { return ScatterPoint{kNormal, 0, albedo, g, 0.16f, 0.04f}; };
  return {{matter({0.8f, 0.6f, 0.4f}, 0), {1, 40}},
          {matter(Vec3f(0.9f), 0.6f), {20, 40}},
          {matter(Vec3f(0.9f), -0.4f), {0.01f, 200}},
          {matter(Vec3f(0.5f), 0.3f), {3, 0}},
          {matter(Vec3f(0.5f), 0.3f), {0, 40}}};
}

Vec3f outgoing(Rng& rng) {
  for (;;) {
    const Vec3f wo = test::random_direction(rng);
    if (std::abs(dot(wo, kNormal)) > 0.2f) return wo;
  }
}

TEST(BlinnPhong, ValueIsThePapers) {
  Rng rng(1, 0, 0, 0);
  for (const Case& c : cases())
    for (int i = 0; i < 2000; ++i) {
      const Vec3f wo = outgoing(rng), wi = test::random_direction(rng);
      const Vec3f n = dot(kNormal, wo) < 0 ? -kNormal : kNormal;
      const double cos_i = std::max(double{dot(n, wi)}, 0.0);
      const double cos_half = std::max(double{dot(n, normalize(wo + wi))}, 0.0);
      const double bright = c.highlight.strength * std::pow(cos_half, double{c.highlight.shininess}) * cos_i;
      const double expected = c.point.albedo.x * (phase_hg(-dot(wo, wi), c.point.g) + bright);
      const ScatterParts parts =
          eval_blinn_phong(c.point, c.highlight, blinn_phong_choice(c.point, c.highlight), wo, wi);
      ASSERT_NEAR((parts.specular + parts.phase).x, expected, 1e-3 * expected + 1e-5);
    }
}

TEST(BlinnPhong, SamplesFitTheDensity) {
  Rng rng(2, 0, 0, 0);
  const auto all = cases();
  for (const Case& c : all) {
    const Vec3f wo = outgoing(rng);
    const ScatterChoice choice = blinn_phong_choice(c.point, c.highlight);
    SCOPED_TRACE(c.highlight.strength);
    test::expect_directions_fit(
        test::SphereBins(kNormal),
        [&] {
          const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
          const ScatterSample s = sample_blinn_phong(c.point, c.highlight, choice, wo, u_lobe, u0, u1);
          return test::DirectionDraw{s.wi, s.pdf};
        },
        [&](Vec3f wi) { return eval_blinn_phong(c.point, c.highlight, choice, wo, wi).pdf; },
        static_cast<int>(all.size()));
  }
}

TEST(BlinnPhong, WeightsAverageToTheIntegral) {
  Rng rng(3, 0, 0, 0);
  for (const Case& c : cases()) {
    const Vec3f wo = outgoing(rng);
    const ScatterChoice choice = blinn_phong_choice(c.point, c.highlight);
    const auto rings = test::SphereBins(kNormal).integrate([&](Vec3f wi) {
      const ScatterParts parts = eval_blinn_phong(c.point, c.highlight, choice, wo, wi);
      return (parts.specular + parts.phase).y;
    });
    const double expected = std::accumulate(rings.begin(), rings.end(), 0.0);
    test::Moments mean;
    for (int i = 0; i < 1 << 18; ++i) {
      const float u_lobe = rng.next(), u0 = rng.next(), u1 = rng.next();
      const ScatterSample s = sample_blinn_phong(c.point, c.highlight, choice, wo, u_lobe, u0, u1);
      mean.add(s.pdf > 0 ? double{s.value.y / s.pdf} : 0.0);
    }
    EXPECT_LT(std::abs(mean.z(expected, 1e-4 * expected)), 4) << c.highlight.strength;
  }
}

TEST(BlinnPhong, AlbedoAlongTheNormalIsTheIntegral) {
  for (const float shininess : {0.0f, 5.0f, 40.0f, 400.0f}) {
    const Highlight highlight{1, shininess};
    const ScatterPoint point{kNormal, 0, Vec3f(1.0f), 0, 0.16f, 0.04f};
    const ScatterChoice choice = blinn_phong_choice(point, highlight);
    const auto rings = test::SphereBins(kNormal, 4 / std::sqrt(shininess + 4)).integrate([&](Vec3f wi) {
      return eval_blinn_phong(point, highlight, choice, kNormal, wi).specular.x;
    });
    EXPECT_NEAR(blinn_phong_albedo(shininess) / std::accumulate(rings.begin(), rings.end(), 0.0), 1, 1e-3);
  }
}

}  // namespace
}  // namespace voxlume
