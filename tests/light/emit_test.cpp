// The flux that light particles bring to a small ball, against what the ball gets by the lights' definitions.
#include "light/emit.h"

#include <gtest/gtest.h>

#include "base/box.h"
#include "light_scenes.h"
#include "support/moments.h"

namespace voxlume {
namespace {

constexpr SceneSphere kScene{{5, 0, 0}, 40};
const Vec3d kBall(10, -5, 8);
constexpr double kBallRadius = 15;

test::Moments flux_through_ball(const Lights& lights, std::uint64_t seed) {
  const LightsView view = lights.view();
  test::Moments flux;
  for (std::uint32_t i = 0; i < 400000; ++i) {
    Rng rng(seed, 0, 0, i);
    const float u_pick = rng.next();
    const UnitPair start{rng.next(), rng.next()}, way{rng.next(), rng.next()};
    const Emission e = sample_emission(view, kScene, u_pick, start, way);
    EXPECT_NEAR(length(e.direction_world), 1, 1e-5);
    const Vec3d to_ball = kBall - Vec3d(e.origin_world);
    const double along = dot(to_ball, Vec3d(e.direction_world));
    const double off2 = dot(to_ball, to_ball) - along * along;
    const bool meets = off2 < kBallRadius * kBallRadius && (along > 0 || length(to_ball) < kBallRadius);
    flux.add(meets ? double{e.flux.x} : 0.0);
  }
  return flux;
}

/// Solid angle of the ball from a point outside.
double ball_solid_angle(Vec3d p) {
  const Vec3d way = kBall - p;
  return 2 * std::numbers::pi * (1 - std::sqrt(1 - kBallRadius * kBallRadius / dot(way, way)));
}

/// Flux from a rect light that has the ball wholly in front of it: an element's light falls on the ball as
/// the projected solid angle that the ball shows it.
double rect_flux(const Light& light) {
  constexpr int kCells = 200;
  const double width = 2.0 * light.half_width_mm, height = 2.0 * light.half_height_mm;
  double sum = 0;
  for (int j = 0; j < kCells; ++j)
    for (int i = 0; i < kCells; ++i) {
      const Vec3d p = Vec3d(light.position_mm) + Vec3d(light.axis_x) * (((i + 0.5) / kCells - 0.5) * width) +
                      Vec3d(light.axis_y) * (((j + 0.5) / kCells - 0.5) * height);
      const Vec3d way = kBall - p;
      const double d2 = dot(way, way);
      sum += std::numbers::pi * kBallRadius * kBallRadius / d2 *
             std::abs(dot(normalize(way), Vec3d(light.direction)));
    }
  return sum * light.emission.x * width * height / (kCells * kCells);
}

void expect_flux(const Lights& lights, double expected, std::uint64_t seed) {
  const test::Moments flux = flux_through_ball(lights, seed);
  EXPECT_LT(std::abs(flux.z(expected, 1e-5 * expected)), 4) << flux.mean() << " against " << expected;
  EXPECT_LT(4 * flux.standard_error(), 0.05 * expected);
}

constexpr double kShadow = std::numbers::pi * kBallRadius * kBallRadius;  ///< of the ball, mm^2

TEST(Emission, OfADirectionalLight) {
  expect_flux(test::compile({test::directional({1, 2, -1}, 3)}), 3 * kShadow, 1);
}

TEST(Emission, OfAPointLightOutsideAndInside) {
  expect_flux(test::compile({test::point({90, 30, 0}, 500)}), 500 * ball_solid_angle({90, 30, 0}), 2);
  expect_flux(test::compile({test::point({-12, 0, 0}, 500)}), 500 * ball_solid_angle({-12, 0, 0}), 3);
}

TEST(Emission, OfARectLight) {
  const Lights lights = test::compile({test::rect({80, 60, 20}, {0, 0, 0}, 70, 40, 2)});
  expect_flux(lights, rect_flux(lights.view().lights[0]), 4);
  LightDescription other = test::rect({80, 60, 20}, {160, 120, 40}, 70, 40, 2);
  const Lights dark = test::compile({other});
  EXPECT_EQ(flux_through_ball(dark, 5).mean(), 0);
  other.two_sided = true;
  const Lights back = test::compile({other});
  expect_flux(back, rect_flux(back.view().lights[0]), 6);
}

TEST(Emission, OfTheEnvironment) {
  EnvironmentDescription constant;
  constant.intensity = 0.7;
  expect_flux(test::compile({}, constant), 0.7 * 4 * std::numbers::pi * kShadow, 7);
  const EnvironmentImage image = test::sky();
  const Lights lights = test::compile({}, EnvironmentDescription{}, &image);
  expect_flux(lights, lights.view().environment_mean.x * 4 * std::numbers::pi * kShadow, 8);
}

TEST(Emission, OfSeveralLightsIsTheirSum) {
  EnvironmentDescription constant;
  constant.intensity = 0.2;
  const Lights lights =
      test::compile({test::directional({1, 2, -1}, 3), test::point({90, 30, 0}, 500)}, constant);
  expect_flux(lights, (3 + 0.2 * 4 * std::numbers::pi) * kShadow + 500 * ball_solid_angle({90, 30, 0}), 9);
}

TEST(Emission, OfNothingIsNothing) {
  const Lights dark = test::compile({});
  const Emission e = sample_emission(dark.view(), kScene, 0.5f, {0, 0}, {0, 0});
  EXPECT_EQ(e.flux, Vec3f(0));
}

}  // namespace
}  // namespace voxlume
