#include "integrator/illustration.h"

#include <gtest/gtest.h>

#include "integrator/path_tracer.h"
#include "test_scene.h"
#include "transfer/transfer_function.h"

namespace voxlume::test {
namespace {

TransferPoint tone(double cosine, Color color) {
  TransferPoint point;
  point.value = cosine;
  point.mu_t_per_mm = 1;
  point.color = color;
  return point;
}

/// Dark blue below -0.5, grey above, red from 0.5 on.
TransferFunction toon() {
  TransferDescription ramp;
  ramp.reference_length_mm = 1;
  ramp.points = {tone(-0.5, {{0, 0, 0.5f}}), tone(-0.5, {{0.5f, 0.5f, 0.5f}}),
                 tone(0.5, {{0.5f, 0.5f, 0.5f}}), tone(0.5, {{1, 0, 0}})};
  return TransferFunction(ramp);
}

MatterPoint surface(Vec3f normal, float share) {
  MatterPoint matter{};
  matter.scatter.normal = normal;
  matter.scatter.p_brdf = share;
  matter.scatter.albedo = Vec3f(1, 0.5f, 1);
  return matter;
}

void expect_near(Vec3f found, Vec3f expected) {
  for (int c = 0; c < 3; ++c) EXPECT_NEAR(found[c], expected[c], 1e-6f) << "channel " << c;
}

TEST(Illustration, TakesTheRampByTheCosineToTheLight) {
  const TransferFunction ramp = toon();
  IllustrationView view{true, ramp.view(), Vec3f(0, 0, 1), 0, 0, Vec3f(0)};
  const Vec3f wo(0, 1, 0);
  expect_near(illustrated(view, surface({0, 0, 1}, 1), wo), {1, 0, 0});
  expect_near(illustrated(view, surface({0, 0, -1}, 1), wo), {0, 0, 0.5f});
  expect_near(illustrated(view, surface({1, 0, 0}, 1), wo), {0.5f, 0.25f, 0.5f});
  // What is no surface has the middle of the ramp.
  expect_near(illustrated(view, surface({0, 0, 1}, 0), wo), {0.5f, 0.25f, 0.5f});
  expect_near(illustrated(view, surface({0, 0, 1}, 0.5f), wo), {0.75f, 0.125f, 0.25f});
}

TEST(Illustration, DrawsContoursWhereSurfacesAreSeenEdgeOn) {
  const TransferFunction ramp = toon();
  const Vec3f ink(0.25f, 0, 0.75f);
  IllustrationView view{true, ramp.view(), Vec3f(0, 0, 1), 1, 0.4f, ink};
  const MatterPoint matter = surface({0, 0, 1}, 1);
  expect_near(illustrated(view, matter, {1, 0, 0}), ink);
  expect_near(illustrated(view, matter, normalize(Vec3f(1, 0, 0.2f))), ink);  // within half the width
  expect_near(illustrated(view, matter, {0, 0, 1}), {1, 0, 0});
  expect_near(illustrated(view, matter, normalize(Vec3f(1, 0, 0.5f))), {1, 0, 0});  // beyond the width
  view.contour = 0;
  expect_near(illustrated(view, matter, {1, 0, 0}), {1, 0, 0});
}

/// Light, environment and shadows do not matter, and no light is looked for.
TEST(Illustration, TakesThePlaceOfLight) {
  const Volume ball =
      make_volume({20, 20, 20}, 2.0, [](Vec3d p) { return std::max(0.0, 1.2 - length(p) / 18.0); });
  SceneDescription scene = dark_scene(16, 16);
  scene.transfer.points = {point(0.1, 0, grey(0.8f)), point(0.2, 50, grey(0.8f))};
  scene.material.shading = Shading::kBrdf;
  scene.illustration = IllustrationDescription{};
  scene.illustration->contour = 0;
  scene.illustration->ramp = {tone(-1, {{1, 0.5f, 0.25f}}), tone(1, {{1, 0.5f, 0.25f}})};
  const Estimate dark = estimate(scene, ball, 16);
  EXPECT_EQ(dark.counters.shadow_rays, 0u);
  EXPECT_NEAR(dark.pixels[8 * 16 + 8].mean(), luminance(Vec3f(0.8f, 0.4f, 0.2f)), 1e-5);
  scene.environment->intensity = 3;
  scene.background->kind = BackgroundKind::kColor;
  const Estimate lit = estimate(scene, ball, 16);
  for (std::size_t i = 0; i < dark.pixels.size(); ++i) EXPECT_EQ(lit.pixels[i].mean(), dark.pixels[i].mean());
}

}  // namespace
}  // namespace voxlume::test
