#include "render/denoise_frame.h"

#include <gtest/gtest.h>

#include "estimator/test_scene.h"

namespace voxlume::test {
namespace {

constexpr int kEdge = 20;

struct Rendered {
  Film film{kEdge, kEdge, {.normal = true, .albedo = true, .classes = true}};
  DenoiseFrame frame;
};

/// A ball before a grey background, lit by an environment and an area light.
Rendered render(int spp, Integrator integrator = Integrator::kPath) {
  SceneDescription scene = dark_scene(kEdge, kEdge);
  scene.render.integrator = integrator;
  scene.environment->intensity = 0.7;
  scene.background->color = grey(0.2f);
  LightDescription area;
  area.kind = LightKind::kRect;
  area.position_mm = Double3{20, -60, 30};
  area.target_mm = Double3{0, 0, 0};
  area.size_mm = {20, 30};
  area.intensity = 5;
  scene.lights = {area};
  scene.transfer.points = {point(0.2, 0, grey(0.9f)), point(0.9, 1, {{0.9f, 0.5f, 0.3f}})};
  const Volume volume = make_volume({24, 24, 24}, 1.5, [](Vec3d p) { return 1.4 - length(p) / 14; });
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
  SceneView view = compiled.view();
  view.keeps_parts = true;
  Rendered out;
  TraceCounters counters;
  render_tile(view, {0, 0, kEdge, kEdge}, 0, spp, out.film, counters);
  fill_denoise_frame(out.film, view, 30, out.frame);
  return out;
}

/// One class at one sample, and any number of classes of any: with no filter in between, the parts are the
/// input.
void expect_whole(Integrator integrator, std::initializer_list<int> counts) {
  for (const int spp : counts) {
    const Rendered r = render(spp, integrator);
    int two = 0;
    for (int y = 0; y < kEdge; ++y) {
      for (int x = 0; x < kEdge; ++x) {
        for (int c = 0; c < 3; ++c) {
          double sum = 0;
          for (const SampleClass& k : *r.frame.classes) {
            const double radiance = k.fx_diffuse[c].at(x, y) * k.fl_diffuse[c].at(x, y) +
                                    k.fx_specular[c].at(x, y) * k.fl_specular[c].at(x, y) +
                                    k.later[c].at(x, y);
            sum += k.count.at(x, y) * radiance;
          }
          const double expected = r.frame.radiance[c].at(x, y);
          ASSERT_NEAR(sum / spp, expected, 1e-5 * std::max(expected, 0.1)) << spp << " spp";
        }
        two += (*r.frame.classes)[1].count.at(x, y) > 0;
      }
    }
    if (spp > 1 && integrator == Integrator::kPath) {
      EXPECT_GT(two, 5) << spp << " spp";
    }
  }
}

TEST(DenoiseFrame, ItsClassesMakeUpItsRadiance) {
  expect_whole(Integrator::kPath, {1, 2, 30, 100});
  expect_whole(Integrator::kRayMarch, {1, 4});
}

void expect_picture(Integrator integrator) {
  const Rendered r = render(16, integrator);
  const Image image = compose_picture(r.frame, {r.frame.radiance, r.frame.alpha}, false);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      const Vec3d mean = r.film.mean(x, y);
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(image.pixel(x, y)[c], mean[c], 1e-5) << x << ' ' << y;
      EXPECT_EQ(image.pixel(x, y)[3], 1);
      EXPECT_NEAR(r.frame.background[0].at(x, y), 0.2f, 1e-5) << "matter stays out of it";
      EXPECT_EQ(r.frame.alpha.at(x, y), static_cast<float>(r.film.alpha(x, y)));
    }
  }
}

TEST(DenoiseFrame, MatterOverBackgroundIsThePicture) {
  expect_picture(Integrator::kPath);
  expect_picture(Integrator::kRayMarch);  // whose samples are matter in part
}

TEST(DenoiseFrame, VarianceIsThatOfTheMean) {
  double expected = 0, spread = 0;
  const Rendered exact = render(4096);
  const Rendered r = render(64);
  for (int y = 0; y < kEdge; ++y) {
    for (int x = 0; x < kEdge; ++x) {
      expected += r.frame.variance.at(x, y);
      double d = 0;
      for (int c = 0; c < 3; ++c) {
        const double weight = c == 0 ? 0.2126 : c == 1 ? 0.7152 : 0.0722;
        d += weight * (r.frame.radiance[c].at(x, y) - exact.frame.radiance[c].at(x, y));
      }
      spread += d * d;
    }
  }
  // 400 pixels, nearly half of which vary: their mean square is known to about a tenth.
  EXPECT_NEAR(spread / expected, 1, 0.4);
}

}  // namespace
}  // namespace voxlume::test
