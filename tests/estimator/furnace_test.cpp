// A volume of albedo 1 in an environment of radiance 1 is invisible: it renders to 1 everywhere.
#include <gtest/gtest.h>

#include "test_scene.h"

namespace voxlume::test {
namespace {

struct FurnaceCase {
  double mu_t_per_mm;
  double g;
  Shading shading;
  double gradient_factor;
  double specular;
  const char* light_sampling;
  double roughness = 0.4;
};

std::string case_name(const testing::TestParamInfo<FurnaceCase>& info) {
  return "case" + std::to_string(info.index);
}

/// A soft ball 40 mm wide: gradients everywhere, an edge of the volume that it reaches.
Volume soft_ball() {
  return make_volume({20, 20, 20}, 2.0, [](Vec3d p) { return std::max(0.0, 1.2 - length(p) / 18.0); });
}

Estimate render_furnace(const FurnaceCase& c, int spp) {
  SceneDescription scene = dark_scene(8, 8);
  scene.environment->intensity = 1;
  scene.background->kind = BackgroundKind::kEnvironment;
  scene.transfer.points = {point(0, 0, grey(1)), point(1, c.mu_t_per_mm, grey(1))};
  scene.material.shading = c.shading;
  scene.material.gradient_factor = c.gradient_factor;
  scene.material.anisotropy = c.g;
  scene.material.specular = c.specular;
  scene.material.roughness = c.roughness;
  scene.render.max_scatter = 0;
  scene.render.light_sampling = c.light_sampling;
  return estimate(scene, soft_ball(), spp);
}

class Furnace : public testing::TestWithParam<FurnaceCase> {};

TEST_P(Furnace, RendersToOneEverywhere) {
  const Estimate image = render_furnace(GetParam(), 600);
  EXPECT_EQ(image.counters.majorant_violations, 0u);
  double z2 = 0;
  for (const Moments& pixel : image.pixels) {
    const double error = pixel.standard_error();
    // A pixel without variance (missed the ball, or every weight was exactly 1) must be 1 up to rounding.
    const double z = std::abs(pixel.mean() - 1) < 1e-4 ? 0 : (pixel.mean() - 1) / error;
    EXPECT_LT(std::abs(z), 4.5) << "mean " << pixel.mean() << " +- " << error;
    z2 += z * z;
  }
  const Moments all = image.total();
  EXPECT_LT(std::abs(all.mean() - 1), 4 * all.standard_error() + 1e-4);
  // The sum of squares of 64 standard normals is below 64 + 5 sqrt(128) but for one case in a million.
  EXPECT_LT(z2, 64 + 5 * std::sqrt(128.0));
}

INSTANTIATE_TEST_SUITE_P(LambertAndPhase, Furnace,
                         testing::Values(FurnaceCase{0.02, 0, Shading::kPhase, 0, 0, "mis"},
                                         FurnaceCase{0.5, 0, Shading::kPhase, 0, 0, "mis"},
                                         FurnaceCase{0.5, 0.8, Shading::kPhase, 0, 0, "mis"},
                                         FurnaceCase{0.5, -0.6, Shading::kPhase, 0, 0, "light"},
                                         FurnaceCase{5.0, 0.3, Shading::kPhase, 0, 0, "direction"},
                                         FurnaceCase{0.2, 0, Shading::kCoexistence, 0.5, 0, "mis"},
                                         FurnaceCase{1.0, 0.5, Shading::kCoexistence, 1.0, 0, "mis"},
                                         FurnaceCase{1.0, 0.5, Shading::kCoexistence, 0.8, 0, "light"},
                                         FurnaceCase{4.0, 0, Shading::kCoexistence, 1.0, 0, "direction"},
                                         FurnaceCase{1.0, 0.5, Shading::kExposureRender, 0.8, 0, "mis"},
                                         FurnaceCase{1.0, 0, Shading::kBrdf, 1.0, 0, "mis"}),
                         case_name);

TEST(Furnace, SpecularLobeNeverGainsEnergy) {
  for (const double mu_t : {0.2, 2.0}) {
    for (const Shading shading : {Shading::kBrdf, Shading::kCoexistence, Shading::kExposureRender}) {
      for (const double roughness : {0.05, 0.4, 1.0}) {
        const Estimate image = render_furnace({mu_t, 0, shading, 1, 1, "mis", roughness}, 300);
        for (const Moments& pixel : image.pixels)
          EXPECT_LT(pixel.mean(), 1 + 4.5 * pixel.standard_error() + 1e-4);
        EXPECT_GT(image.total().mean(), 0.5);
      }
    }
  }
}

TEST(Furnace, LimitedScatteringOnlyLosesLightAndMoreScatteringLosesLess) {
  SceneDescription scene = dark_scene(8, 8);
  scene.environment->intensity = 1;
  scene.background->kind = BackgroundKind::kEnvironment;
  scene.transfer.points = {point(0, 0, grey(1)), point(1, 1.0, grey(1))};
  double previous = 0;
  for (const int limit : {1, 2, 4, 16}) {
    scene.render.max_scatter = limit;
    const Moments all = estimate(scene, soft_ball(), 400).total();
    EXPECT_LT(all.mean(), 1 + 4 * all.standard_error());
    EXPECT_GT(all.mean(), previous);
    previous = all.mean();
  }
}

}  // namespace
}  // namespace voxlume::test
