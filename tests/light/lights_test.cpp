#include "light/compile_lights.h"

#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "light/light_scenes.h"
#include "sampling/rng.h"
#include "support/moments.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using test::compile;
using test::directional;
using test::point;
using test::rect;

void expect_vec_near(Vec3f a, Vec3f b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

TEST(Lights, PointFollowsTheInverseSquare) {
  const Lights lights = compile({point({0, 0, 200}, 400)});
  const LightSample s = sample_light(lights.view(), Vec3f(0, 0, 180), 0.5f, 0.5f, 0.5f);
  EXPECT_EQ(s.wi, Vec3f(0, 0, 1));
  EXPECT_FLOAT_EQ(s.distance_mm, 20.0f);
  EXPECT_FLOAT_EQ(s.radiance.x, 1.0f);
  EXPECT_EQ(s.pdf, 1.0f);
  EXPECT_TRUE(s.delta);
  EXPECT_EQ(sample_light(lights.view(), Vec3f(0, 0, 200), 0.5f, 0.5f, 0.5f).pdf, 0.0f);
}

TEST(Lights, DirectionalIsEverywhereAlike) {
  const Lights lights = compile({directional({3, 0, 4}, 2)});
  for (Vec3f p : {Vec3f(0, 0, 0), Vec3f(100, -5, 7)}) {
    const LightSample s = sample_light(lights.view(), p, 0.5f, 0.5f, 0.5f);
    expect_vec_near(s.wi, {0.6f, 0, 0.8f}, 1e-6f);
    EXPECT_TRUE(std::isinf(s.distance_mm) && s.delta);
    EXPECT_EQ(s.radiance, Vec3f(2.0f));
    EXPECT_EQ(s.pdf, 1.0f);
  }
}

TEST(Lights, ColorTimesIntensity) {
  LightDescription d = directional({0, 0, 1}, 2);
  d.color.linear = {1, 0.5f, 0};
  EXPECT_EQ(sample_light(compile({d}).view(), Vec3f(0.0f), 0.5f, 0.5f, 0.5f).radiance, Vec3f(2, 1, 0));
}

/// All kinds together: the estimate of the irradiance is the sum of the analytic ones.
TEST(Lights, IrradiancesAddUp) {
  EnvironmentDescription environment;
  environment.intensity = 0.3;
  const Lights lights = compile({point({0, 0, 300}, 5e4), rect({0, -400, 400}, {0, 0, 0}, 300, 200, 3),
                                 directional({1, 0, 1}, 0.7), rect({0, 300, 300}, {0, 0, 0}, 50, 50, 20)},
                                environment);
  const LightsView view = lights.view();
  ASSERT_EQ(view.rect_count, 2);
  const Vec3f n(0, 0, 1);
  const double expected = 5e4 / (300.0 * 300.0) + 0.7 * std::sqrt(0.5) + 0.3 * std::numbers::pi +
                          3 * test::rect_irradiance(view.lights[0], Vec3d(0.0), Vec3d(n)) +
                          20 * test::rect_irradiance(view.lights[1], Vec3d(0.0), Vec3d(n));
  Rng rng(1, 0, 0, 0);
  test::Moments mean;
  for (int i = 0; i < 1 << 20; ++i) {
    const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
    const LightSample s = sample_light(view, Vec3f(0.0f), u_pick, u0, u1);
    mean.add(s.pdf > 0 ? double{s.radiance.x * std::max(0.0f, dot(s.wi, n)) / s.pdf} : 0.0);
  }
  EXPECT_LT(std::abs(mean.z(expected, 1e-5 * expected)), 4) << expected << " " << mean.mean();
}

TEST(Lights, EveryEmitterKeepsAFloor) {
  std::vector<LightDescription> all;
  for (int i = 0; i < 199; ++i) all.push_back(point({0, 0, 1000.0 + i}, 1e-9));
  all.push_back(directional({0, 0, 1}, 1e6));
  all.push_back(directional({0, 1, 1}, 0));  // black: left out
  const Lights lights = compile(all);
  const LightsView view = lights.view();
  ASSERT_EQ(view.light_count, 200);
  double total = 0;
  for (int i = 0; i < 200; ++i) {
    EXPECT_GE(bin_probability(view.pick, i), 0.1f / 200 * 0.999f);
    total += bin_probability(view.pick, i);
  }
  EXPECT_EQ(total, 1.0);
  EXPECT_EQ(bin_probability(view.pick, 200), 0.0f);  // no environment
  EXPECT_NEAR(bin_probability(view.pick, 199), 0.9f + 0.1f / 200, 1e-5f);
}

TEST(Lights, NoneIsNoLight) {
  const Lights lights = compile({});
  EXPECT_EQ(sample_light(lights.view(), Vec3f(0.0f), 0.5f, 0.5f, 0.5f).pdf, 0.0f);
  visit_rect_hits(lights.view(), Vec3f(0.0f), Vec3f(0, 0, 1), 1e9f, [](const LightHit&) { FAIL(); });
}

TEST(Lights, ViewSurvivesAMove) {
  Lights first = compile({rect({0, 0, 100}, {0, 0, 0}, 10, 10)}, {});
  const Lights second = std::move(first);
  EXPECT_GT(sample_light(second.view(), Vec3f(0.0f), 0.1f, 0.5f, 0.5f).pdf, 0.0f);
}

TEST(Lights, CameraAttachment) {
  // A camera on the patient's left that looks along -x.
  const ViewFrame camera{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {10, 20, 30}};
  LightDescription d = point({1, 2, 3}, 1);
  d.attached_to = Attachment::kCamera;
  LightDescription r = rect({0, 0, 500}, {0, 0, 0}, 40, 20);
  r.attached_to = Attachment::kCamera;
  LightDescription r_default = r;
  r_default.target_mm.reset();
  LightDescription sun = directional({0, 1, 0}, 1);
  sun.attached_to = Attachment::kCamera;
  const Lights lights({d, r, r_default, sun}, test::no_environment(), nullptr, camera,
                      SceneSphere{{10, 20, 30}, 50});
  const LightsView view = lights.view();
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(view.lights[i].position_mm, Vec3f(510, 20, 30));
    expect_vec_near(view.lights[i].direction, {-1, 0, 0}, 1e-6f);  // its front faces the target
    expect_vec_near(view.lights[i].axis_y, {0, 0, 1}, 1e-6f);      // its height is the camera's up
    EXPECT_EQ(view.lights[i].half_width_mm, 20.0f);
    EXPECT_EQ(view.lights[i].half_height_mm, 10.0f);
  }
  EXPECT_EQ(view.lights[2].position_mm, Vec3f(13, 21, 32));
  EXPECT_EQ(view.lights[3].direction, Vec3f(0, 0, 1));
}

TEST(Lights, WorldRectDefaults) {
  LightDescription d = rect({0, 0, 100}, {0, 0, 0}, 10, 10);
  d.target_mm.reset();  // the camera's target; straight down, where world up is of no use
  const Lights lights({d}, test::no_environment(), nullptr, ViewFrame{}, SceneSphere{});
  const Light& light = lights.view().lights[0];
  expect_vec_near(light.direction, {0, 0, -1}, 1e-6f);
  EXPECT_NEAR(dot(light.axis_x, light.direction), 0.0f, 1e-6f);
  EXPECT_NEAR(length(light.axis_x), 1.0f, 1e-6f);
  expect_vec_near(cross(light.axis_x, light.axis_y), light.direction, 1e-6f);
}

void expect_refused(const std::string& where,
                    const std::function<void(LightDescription&, EnvironmentDescription&)>& spoil) {
  std::vector<LightDescription> lights = {directional({0, 0, 1}, 1), rect({0, 0, 100}, {0, 0, 0}, 10, 10)};
  EnvironmentDescription environment;
  spoil(lights[1], environment);
  try {
    compile(lights, environment);
    FAIL() << "accepted: " << where;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
    EXPECT_EQ(error.where(), where);
    EXPECT_EQ(error.message().find('\n'), std::string::npos);
  }
}

TEST(Lights, RefusesWhatCannotBe) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  using D = LightDescription;
  using E = EnvironmentDescription;
  expect_refused("/lights/1/size_mm", [](D& d, E&) { d.size_mm = {10, 0}; });
  expect_refused("/lights/1/size_mm", [](D& d, E&) { d.size_mm = {kNan, 1}; });
  expect_refused("/lights/1/intensity", [](D& d, E&) { d.intensity = -1; });
  expect_refused("/lights/1/intensity", [](D& d, E&) { d.intensity = kNan; });
  expect_refused("/lights/1/intensity", [](D& d, E&) { d.intensity = 1e300; });
  expect_refused("/lights/1/color", [](D& d, E&) { d.color.linear = {1, -0.1f, 0}; });
  expect_refused("/lights/1/position_mm", [](D& d, E&) { d.position_mm.reset(); });
  expect_refused("/lights/1/position_mm", [](D& d, E&) { (*d.position_mm)[1] = kNan; });
  expect_refused("/lights/1/target_mm", [](D& d, E&) { d.target_mm = d.position_mm; });
  expect_refused("/lights/1/up", [](D& d, E&) { d.up = Double3{0, 0, 3}; });
  expect_refused("/lights/1/up", [](D& d, E&) { d.up = Double3{0, 0, 0}; });
  expect_refused("/lights/1/position_mm",
                 [](D& d, E&) { d = LightDescription{}, d.kind = LightKind::kPoint; });
  expect_refused("/lights/1/direction", [](D& d, E&) { d = LightDescription{}; });
  expect_refused("/lights/1/direction", [](D& d, E&) { d = directional({0, 0, 0}, 1); });
  expect_refused("/environment/intensity", [](D&, E& e) { e.intensity = -1; });
  expect_refused("/environment/color", [](D&, E& e) { e.color.linear[2] = -1; });
  expect_refused("/environment/rotation_deg", [](D&, E& e) { e.rotation_deg = kNan; });
}

TEST(Lights, RefusesBadPictures) {
  const EnvironmentImage square{4, 4, std::vector<float>(48, 1.0f)};
  const EnvironmentImage empty{0, 0, {}};
  EnvironmentImage poisoned{4, 2, std::vector<float>(24, 1.0f)};
  poisoned.rgb[13] = std::numeric_limits<float>::infinity();
  for (const EnvironmentImage* image : {&square, &empty, &std::as_const(poisoned)}) {
    try {
      compile({}, {}, image);
      FAIL() << "accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.where(), "/environment/image");
    }
  }
}

}  // namespace
}  // namespace voxlume
