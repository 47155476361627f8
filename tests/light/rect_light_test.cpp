#include "light/rect_light.h"

#include <gtest/gtest.h>

#include "light/light_scenes.h"
#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

using test::compile;
using test::rect;

/// A light at the origin that faces `target`, seen from p.
struct View {
  const char* name;
  Vec3f p;
  double width, height;
};
const View kViews[] = {
    {"in front", {0, -100, 0}, 100, 60},     {"near", {10, -2, -5}, 100, 60},
    {"very near", {10, -0.2f, -5}, 100, 60}, {"far", {200, -3000, 100}, 100, 60},
    {"very far", {0, -20000, 0}, 100, 60},   {"oblique", {150, -20, 30}, 100, 60},
    {"grazing", {80, -1, 0}, 100, 60},       {"along an edge", {50, -40, 30}, 100, 60},
    {"strip", {0, -50, 20}, 400, 1},         {"above a corner", {50, -100, 30}, 100, 60},
};
constexpr int kViewCount = static_cast<int>(std::size(kViews));

/// Front toward -y; width along +-x, height along z.
Lights light_of(const View& v, bool two_sided = false) {
  LightDescription d = rect({0, 0, 0}, {0, -1, 0}, v.width, v.height);
  d.two_sided = two_sided;
  return compile({d});
}

LightHit only_hit(const LightsView& view, Vec3f origin, Vec3f direction, float t_max = 1e30f) {
  LightHit out{Vec3f(0.0f), 0.0f};
  visit_rect_hits(view, origin, direction, t_max, [&](const LightHit& hit) { out = hit; });
  return out;
}

double brute_force_solid_angle(const RectFromPoint& r) {
  constexpr int kSide = 2000;
  const double z = r.height, dx = (double{r.x1} - r.x0) / kSide, dy = (double{r.y1} - r.y0) / kSide;
  double sum = 0;
  for (int i = 0; i < kSide; ++i)
    for (int j = 0; j < kSide; ++j) {
      const double x = r.x0 + (i + 0.5) * dx, y = r.y0 + (j + 0.5) * dy;
      const double d2 = x * x + y * y + z * z;
      sum += 1 / (d2 * std::sqrt(d2));
    }
  return sum * std::abs(z) * dx * dy;
}

TEST(RectLight, SolidAngleMatchesQuadrature) {
  for (const View& v : kViews) {
    const Lights lights = light_of(v);
    const RectFromPoint r = rect_from_point(lights.view().lights[0], v.p);
    if (std::abs(r.height) < 1) continue;  // the quadrature is too coarse there
    const double expected = brute_force_solid_angle(r);
    EXPECT_NEAR(double{rect_solid_angle(r)}, expected, 3e-6 * expected + 1e-9) << v.name;
  }
}

TEST(RectLight, SolidAngleLimits) {
  EXPECT_NEAR(rect_solid_angle({-1e4f, 1e4f, -1e4f, 1e4f, 1e-2f}), 2 * std::numbers::pi_v<float>, 1e-5f);
  EXPECT_NEAR(rect_solid_angle({-1, 1, -1, 1, 1}), 2 * std::numbers::pi_v<float> / 3,
              1e-6f);  // a face of a cube
  EXPECT_EQ(rect_solid_angle({2, 3, 2, 3, 0}), 0.0f);
}

TEST(RectLight, SamplesFit) {
  for (const View& v : kViews) {
    SCOPED_TRACE(v.name);
    const Lights lights = light_of(v);
    const LightsView view = lights.view();
    Rng rng(1, 0, 0, 0);
    const auto draw = [&] {
      const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
      const LightSample s = sample_light(view, v.p, u_pick, u0, u1);
      return test::DirectionDraw{s.wi, s.pdf};
    };
    // Bins about the place of the light that is nearest to the point.
    const Vec3f nearest(std::clamp(v.p.x, -float(v.width) / 2, float(v.width) / 2), 0,
                        std::clamp(v.p.z, -float(v.height) / 2, float(v.height) / 2));
    const double extent = std::sqrt(double{rect_solid_angle(rect_from_point(view.lights[0], v.p))});
    test::expect_directions_fit(
        test::SphereBins(normalize(nearest - v.p), extent), draw,
        [&](Vec3f d) { return only_hit(view, v.p, d).pdf; }, kViewCount);
  }
}

/// Uniform in solid angle: the shares of x and y in the light follow the solid angle of its parts.
TEST(RectLight, PartsGetTheirSolidAngle) {
  constexpr int kSide = 20;
  for (const View& v : kViews) {
    const Lights lights = light_of(v);
    const RectFromPoint r = rect_from_point(lights.view().lights[0], v.p);
    const float total = rect_solid_angle(r);
    if (rect_technique(r).sampling == RectSampling::kHemisphere || total < 1e-4f) continue;
    std::vector<double> observed(kSide * kSide), expected(observed.size());
    const double dx = (double{r.x1} - r.x0) / kSide, dy = (double{r.y1} - r.y0) / kSide;
    double sum = 0;
    for (int i = 0; i < kSide; ++i)
      for (int j = 0; j < kSide; ++j) {
        const RectFromPoint part{static_cast<float>(r.x0 + i * dx), static_cast<float>(r.x0 + (i + 1) * dx),
                                 static_cast<float>(r.y0 + j * dy), static_cast<float>(r.y0 + (j + 1) * dy),
                                 r.height};
        sum += expected[static_cast<std::size_t>(i * kSide + j)] = rect_solid_angle(part);
      }
    for (double& e : expected) e *= (1 << 20) / sum;
    Rng rng(2, 0, 0, 0);
    for (int k = 0; k < 1 << 20; ++k) {
      const float u0 = rng.next(), u1 = rng.next();
      const RectPoint q = sample_rect_solid_angle(r, total, u0, u1);
      const int i = std::clamp(static_cast<int>((double{q.x} - r.x0) / dx), 0, kSide - 1);
      const int j = std::clamp(static_cast<int>((double{q.y} - r.y0) / dy), 0, kSide - 1);
      observed[static_cast<std::size_t>(i * kSide + j)] += 1;
    }
    const auto result = test::chi_square(observed, expected);
    EXPECT_GT(result.p, test::significance(kViewCount))
        << v.name << " " << result.statistic << " " << result.degrees;
  }
}

TEST(RectLight, IrradianceMatchesLambertsFormula) {
  for (const View& v : kViews) {
    const Lights lights = light_of(v);
    const LightsView view = lights.view();
    const Vec3f n(0, 1, 0);  // the light is wholly above
    const double expected = test::rect_irradiance(view.lights[0], Vec3d(v.p), Vec3d(n));
    Rng rng(3, 0, 0, 0);
    test::Moments mean;
    for (int i = 0; i < 1 << 18; ++i) {
      const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
      const LightSample s = sample_light(view, v.p, u_pick, u0, u1);
      mean.add(s.pdf > 0 ? double{s.radiance.x * dot(s.wi, n) / s.pdf} : 0.0);
    }
    EXPECT_LT(std::abs(mean.z(expected, 1e-4 * expected)), 4)
        << v.name << " " << expected << " " << mean.mean();
  }
}

TEST(RectLight, SampleAgreesWithHit) {
  Rng rng(4, 0, 0, 0);
  for (const View& v : kViews) {
    const Lights lights = light_of(v);
    const LightsView view = lights.view();
    int missed = 0;
    for (int i = 0; i < 2000; ++i) {
      const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
      const LightSample s = sample_light(view, v.p, u_pick, u0, u1);
      ASSERT_NEAR(length(s.wi), 1.0f, 1e-6f);
      if (s.pdf == 0) continue;  // the hemisphere beside the light
      const LightHit hit = only_hit(view, v.p, s.wi);
      if (!(hit.pdf > 0)) {
        ++missed;  // on the border
        continue;
      }
      EXPECT_NEAR(hit.pdf, s.pdf, 1e-4f * s.pdf) << v.name;
      EXPECT_EQ(hit.radiance, s.radiance);
      // Met just before its distance and not just beyond.
      EXPECT_GT(only_hit(view, v.p, s.wi, s.distance_mm * 1.001f).pdf, 0.0f);
      EXPECT_EQ(only_hit(view, v.p, s.wi, s.distance_mm * 0.999f).pdf, 0.0f);
    }
    EXPECT_LE(missed, 20) << v.name;
  }
}

TEST(RectLight, ShinesFromItsFrontUnlessTwoSided) {
  const View v = kViews[0];
  const Vec3f behind(0, 100, 0), forward(0, 1, 0);
  for (bool two_sided : {false, true}) {
    const Lights lights = light_of(v, two_sided);
    EXPECT_EQ(sample_light(lights.view(), behind, 0.5f, 0.5f, 0.5f).pdf > 0, two_sided);
    EXPECT_EQ(only_hit(lights.view(), behind, -forward).pdf > 0, two_sided);
    EXPECT_GT(sample_light(lights.view(), v.p, 0.5f, 0.5f, 0.5f).pdf, 0.0f);
    EXPECT_GT(only_hit(lights.view(), v.p, forward).pdf, 0.0f);
    EXPECT_EQ(only_hit(lights.view(), v.p, -forward).pdf, 0.0f);
  }
}

TEST(RectLight, EveryLightAlongTheRayIsVisited) {
  const Lights lights =
      compile({rect({0, 0, 0}, {0, -1, 0}, 10, 10, 1), rect({0, 5, 0}, {0, -1, 0}, 10, 10, 2),
               rect({50, 5, 0}, {50, -1, 0}, 10, 10, 4)});
  float sum = 0;
  visit_rect_hits(lights.view(), Vec3f(0, -10, 0), Vec3f(0, 1, 0), 100.0f,
                  [&](const LightHit& h) { sum += h.radiance.x; });
  EXPECT_EQ(sum, 3.0f);
  sum = 0;
  visit_rect_hits(lights.view(), Vec3f(0, -10, 0), Vec3f(0, 1, 0), 12.0f,
                  [&](const LightHit& h) { sum += h.radiance.x; });
  EXPECT_EQ(sum, 1.0f);
}

TEST(RectLight, EdgesAreFinite) {
  const Lights lights = light_of(kViews[0], true);
  const Vec3f places[] = {{0, 0, 0},        {50, 0, 30},      {100, 0, 0},    {0, -1e-6f, 0},
                          {50, -1e-4f, 30}, {60, -1e-4f, 0},  {0, -1, 0},     {0, -1e6f, 0},
                          {1e6f, -1, 0},    {50, -1e-3f, 30}, {0, -1e-3f, 0}, {0, 1, 0}};
  for (Vec3f p : places)
    for (float u0 : test::kEdgeNumbers)
      for (float u1 : test::kEdgeNumbers) {
        const LightSample s = sample_light(lights.view(), p, 0.5f, u0, u1);
        ASSERT_TRUE(is_finite(s.wi) && is_finite(s.radiance)) << p.x << " " << p.y << " " << p.z;
        ASSERT_TRUE(std::isfinite(s.pdf) && s.pdf >= 0.0f) << p.x << " " << p.y << " " << p.z;
        const LightHit hit = only_hit(lights.view(), p, Vec3f(0, 1, 0));
        ASSERT_TRUE(std::isfinite(hit.pdf) && hit.pdf >= 0.0f);
      }
}

}  // namespace
}  // namespace voxlume
