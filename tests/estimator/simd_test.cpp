// Every instruction set gives the picture of the scalar code, to the last bit, in every mode of the renderer.
#include <gtest/gtest.h>

#include "integrator/primary_ray.h"
#include "simd_modes.h"

namespace voxlume::test {
namespace {

struct Traced {
  std::vector<PixelSample> samples;
  std::vector<RadianceParts> parts;
  TraceCounters counters;
};

bool same(const RadianceParts& a, const RadianceParts& b) {
  return a.fx_diffuse == b.fx_diffuse && a.fx_specular == b.fx_specular &&
         a.direct_diffuse == b.direct_diffuse && a.direct_specular == b.direct_specular &&
         a.later == b.later && a.dense == b.dense;
}

Traced trace(const CompiledScene& scene, int spp) {
  SceneView view = scene.view();
  view.keeps_parts = true;
  const TileRect tile{0, 0, view.width, view.height};
  Traced out;
  out.samples.resize(static_cast<std::size_t>(tile.pixel_count()) * spp);
  out.parts.resize(out.samples.size());
  trace_tile(view, tile, 3, 3 + spp, out.samples, out.parts, out.counters);
  return out;
}

TEST(Simd, EveryModeIsTheScalarPicture) {
  const Volume volume = bumps();
  int compared = 0;
  for (const Mode& mode : kModes) {
    SceneDescription scene = base_scene();
    mode.set(scene);
    const Traced expected = trace(*compile(scene, volume, SimdTarget::kScalar), 6);
    double sum = 0;
    for (const PixelSample& s : expected.samples) sum += luminance(s.radiance);
    EXPECT_GT(sum, 1) << mode.name;
    for (const SimdTarget target : kTargets) {
      if (!has_simd_target(target)) continue;
      const auto compiled = compile(scene, volume, target);
      ASSERT_EQ(compiled->view().simd, target);
      const Traced traced = trace(*compiled, 6);
      EXPECT_EQ(traced.counters, expected.counters) << mode.name << ", " << simd_name(target);
      EXPECT_EQ(traced.counters.majorant_violations, 0u);
      std::size_t differing = 0;
      for (std::size_t i = 0; i < traced.samples.size(); ++i) {
        const PixelSample &a = traced.samples[i], &b = expected.samples[i];
        differing +=
            !(a.radiance == b.radiance && a.alpha == b.alpha && a.albedo == b.albedo &&
              a.normal == b.normal && a.depth_mm == b.depth_mm && same(traced.parts[i], expected.parts[i]));
      }
      EXPECT_EQ(differing, 0u) << mode.name << ", " << simd_name(target);
      ++compared;
    }
  }
  if (compared == 0) GTEST_SKIP() << "this machine has no vector target";
}

TEST(Simd, PrimaryRaysAreTheScalarOnes) {
  const Volume volume = bumps();
  for (const Mode& mode : kModes) {
    SceneDescription description = base_scene();
    mode.set(description);
    const auto scene = compile(description, volume, SimdTarget::kScalar);
    for (const SimdTarget target : kTargets) {
      const FillPrimaryRays fill =
          has_simd_target(target) ? vector_primary_rays(target, scene->view().camera) : nullptr;
      if (!fill) continue;
      PrimaryRayBatch batch;
      int entering = 0;
      for (int n = 0; n < 40; ++n) {
        for (int i = 0; i < PrimaryRayBatch::kCount; ++i) {
          batch.x[i] = (n * 7 + i * 3) % 23;
          batch.y[i] = (n * 5 + i) % 19;
          batch.sample[i] = n * 1000 + i;
        }
        fill(scene->view(), batch);
        for (int i = 0; i < PrimaryRayBatch::kCount; ++i) {
          const PrimaryRay a = batch.at(i), b = make_primary_ray(scene->view(), batch.x[i], batch.y[i],
                                                                 static_cast<std::uint32_t>(batch.sample[i]));
          ASSERT_EQ(a.rng.state(), b.rng.state()) << mode.name;
          ASSERT_TRUE(a.first == b.first) << mode.name;
          ASSERT_EQ(a.px, b.px);
          ASSERT_EQ(a.py, b.py);
          ASSERT_EQ(a.origin_world, b.origin_world);
          ASSERT_EQ(a.direction_world, b.direction_world);
          ASSERT_EQ(a.enters, b.enters) << mode.name;
          ASSERT_EQ(a.track.u_collision, b.track.u_collision);
          ASSERT_EQ(a.track.u_depth, b.track.u_depth);
          if (!a.enters) continue;
          ++entering;
          ASSERT_EQ(a.track.t_near, b.track.t_near);
          ASSERT_EQ(a.track.t_far, b.track.t_far);
          ASSERT_EQ(a.track.ray.origin_index, b.track.ray.origin_index);
          ASSERT_EQ(a.track.ray.direction_index, b.track.ray.direction_index);
        }
      }
      EXPECT_GT(entering, 100) << mode.name;
    }
  }
}

TEST(Sampling, SobolHasTheMeanOfRandomAndLessVariance) {
  const Volume volume = bumps();
  SceneDescription scene = base_scene();
  // Means of 16 samples of a pixel, over pixels and seeds.
  const auto means = [&](Sampler sampler) {
    Moments total, spread;
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      scene.render.sampler = sampler;
      scene.render.seed = seed + (sampler == Sampler::kSobol ? 100 : 0);
      const Estimate e = estimate(scene, volume, 16);
      double mean = 0;
      for (const Moments& pixel : e.pixels) mean += pixel.mean() / static_cast<double>(e.pixels.size());
      total.add(mean);
      scene.render.seed += 1000;
      const Estimate f = estimate(scene, volume, 16);
      for (std::size_t i = 0; i < e.pixels.size(); ++i)
        spread.add(0.5 * (e.pixels[i].mean() - f.pixels[i].mean()) *
                   (e.pixels[i].mean() - f.pixels[i].mean()));
    }
    return std::pair{total, spread.mean()};
  };
  const auto [sobol, sobol_variance] = means(Sampler::kSobol);
  const auto [random, random_variance] = means(Sampler::kRandom);
  EXPECT_LT(std::abs(welch_z(sobol, random)), 4);
  // The first distance is a tentative one: coarse majorants leave it little to say.
  if (!std::getenv("VOXLUME_TEST_ACCELERATOR")) {
    EXPECT_LT(sobol_variance, 0.9 * random_variance);
  }
}

}  // namespace
}  // namespace voxlume::test
