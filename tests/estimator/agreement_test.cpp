// Estimators that must have the same mean: Exposure Render's event choice and coexistence; next-event
// estimation, direction sampling and both.
#include <gtest/gtest.h>

#include <algorithm>

#include "blob_scene.h"
#include "same_mean.h"

namespace voxlume::test {
namespace {

TEST(Agreement, ExposureRenderAndCoexistence) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.4;
  scene.lights = {area_light()};
  scene.material.gradient_factor = 0.7;
  for (const int limit : {1, 2, 0}) {
    scene.render.max_scatter = limit;
    scene.material.shading = Shading::kCoexistence;
    scene.render.seed = 11;
    const Estimate coexistence = estimate(scene, two_blobs(), 200);
    scene.material.shading = Shading::kExposureRender;
    scene.render.seed = 12;
    expect_same_mean(coexistence, estimate(scene, two_blobs(), 200));
  }
}

/// Var(M_ER) = Var(M_h) + E[P_b P_p (F_b - F_p)^2], for light sampling alone and one scattering
/// (Rao-Blackwell). The BRDF-only and phase-only renders with the same seed see the same positions and shadow
/// rays, so their samples are F_b and F_p; with M_h between them, P_b P_p (F_b - F_p)^2 = (M_h - F_p)(F_b -
/// M_h).
TEST(Agreement, VarianceGapOfTheEventChoiceIsThePredictedOne) {
  SceneDescription scene = blob_scene();
  scene.image.width = scene.image.height = 8;
  scene.lights = {area_light()};
  scene.material.gradient_factor = 0.7;
  scene.material.specular = 0;
  scene.render.max_scatter = 1;
  scene.render.light_sampling = "light";
  const Volume volume = two_blobs();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const auto compile = [&](Shading shading) {
    SceneDescription d = scene;
    d.material.shading = shading;
    return std::make_unique<CompiledScene>(resolve(d, volume, statistics), volume, statistics);
  };
  const auto mixed = compile(Shading::kCoexistence), brdf = compile(Shading::kBrdf),
             phase = compile(Shading::kPhase), chosen = compile(Shading::kExposureRender);
  const auto sample = [](const CompiledScene& s, int x, int y, int i) {
    TraceCounters counters;
    return static_cast<double>(luminance(trace_camera_sample(s.view(), x, y, i, counters).radiance));
  };
  Moments difference;  // measured minus predicted gap, over pixels and batches
  Moments predicted, mean_difference, mean;
  constexpr int kBatches = 20, kPerBatch = 1000;
  std::vector<Moments> row_difference(8), row_predicted(8), row_mean_difference(8), row_mean(8);
  parallel_for(8, 1, [&](std::int64_t y) {
    for (int x = 0; x < 8; ++x) {
      for (int batch = 0; batch < kBatches; ++batch) {
        Moments m_h, m_er;
        double gap = 0;
        for (int i = batch * kPerBatch; i < (batch + 1) * kPerBatch; ++i) {
          const double h = sample(*mixed, x, y, i), fb = sample(*brdf, x, y, i), fp = sample(*phase, x, y, i);
          m_h.add(h);
          m_er.add(sample(*chosen, x, y, i + kBatches * kPerBatch));
          gap += (h - fp) * (fb - h) / kPerBatch;
        }
        row_mean_difference[y].add(m_er.mean() - m_h.mean());
        row_mean[y].add(m_h.mean());
        row_predicted[y].add(gap);
        row_difference[y].add(m_er.variance() - m_h.variance() - gap);
      }
    }
  });
  for (int y = 0; y < 8; ++y) {
    difference += row_difference[y];
    predicted += row_predicted[y];
    mean_difference += row_mean_difference[y];
    mean += row_mean[y];
  }
  // The means are the same to half a per cent at four standard errors: 1.28 million samples each.
  EXPECT_LT(std::abs(mean_difference.mean()), 4 * mean_difference.standard_error());
  EXPECT_LT(4 * mean_difference.standard_error(), 0.02 * mean.mean());
  EXPECT_LT(std::abs(difference.mean()), 4 * difference.standard_error())
      << "predicted gap " << predicted.mean() << ", measured minus predicted " << difference.mean();
  // The gap is large enough that the test would see a model without it.
  EXPECT_GT(predicted.mean(), 8 * difference.standard_error());
}

struct LightCase {
  const char* name;
  void (*set)(SceneDescription&);
};

class Techniques : public testing::TestWithParam<std::tuple<LightCase, int>> {};

TEST_P(Techniques, AgreeInMean) {
  const auto& [light, limit] = GetParam();
  SceneDescription scene = blob_scene();
  light.set(scene);
  scene.render.max_scatter = limit;
  const auto with = [&](const char* technique, std::uint64_t seed) {
    scene.render.light_sampling = technique;
    scene.render.seed = seed;
    return estimate(scene, two_blobs(), 200);
  };
  const Estimate both = with("mis", 1), light_only = with("light", 2);
  expect_same_mean(both, light_only);
  const bool findable =
      std::string_view(light.name) != "point" && std::string_view(light.name) != "directional";
  if (findable) {
    const Estimate direction_only = with("direction", 3);
    expect_same_mean(both, direction_only);
    expect_same_mean(light_only, direction_only);
  }
}

INSTANTIATE_TEST_SUITE_P(
    EveryLightAtEveryLimit, Techniques,
    testing::Combine(
        testing::Values(LightCase{"constant", [](SceneDescription& s) { s.environment->intensity = 1; }},
                        LightCase{"picture",
                                  [](SceneDescription& s) {
                                    s.environment->intensity = 1;
                                    s.environment->image = sky_file();
                                    s.environment->rotation_deg = 40;
                                  }},
                        LightCase{"rect", [](SceneDescription& s) { s.lights = {area_light()}; }},
                        LightCase{"rect_inside",
                                  [](SceneDescription& s) {
                                    LightDescription l = area_light();
                                    l.position_mm = Double3{-2, -6, 4};
                                    l.size_mm = {12, 12};
                                    l.two_sided = true;
                                    s.lights = {l};
                                  }},
                        LightCase{"rect_and_constant",
                                  [](SceneDescription& s) {
                                    s.lights = {area_light()};
                                    s.environment->intensity = 0.5;
                                  }},
                        LightCase{"blinn_phong",
                                  [](SceneDescription& s) {
                                    s.lights = {area_light()};
                                    s.environment->intensity = 0.5;
                                    s.material.shading = Shading::kBlinnPhong;
                                    s.material.highlight = 1;
                                  }},
                        LightCase{"clip_blocks_light",
                                  [](SceneDescription& s) {
                                    s.lights = {area_light()};
                                    s.environment->intensity = 0.5;
                                    s.clip.emplace();
                                    s.clip->z_mm = {-1e30, 2};
                                    s.clip->blocks_light = true;
                                  }},
                        LightCase{"glossy_forward",
                                  [](SceneDescription& s) {
                                    s.lights = {area_light()};
                                    s.environment->intensity = 0.5;
                                    s.material.roughness = 0.2;
                                    s.material.specular = 1;
                                    s.material.anisotropy = 0.7;
                                    s.material.gradient_factor = 1;
                                  }},
                        LightCase{"point",
                                  [](SceneDescription& s) {
                                    LightDescription l;
                                    l.kind = LightKind::kPoint;
                                    l.position_mm = Double3{-30, -40, 30};
                                    l.intensity = 5000;
                                    s.lights = {l};
                                  }},
                        LightCase{"directional",
                                  [](SceneDescription& s) {
                                    s.lights = {directional({-1, -1, 1}, 3)};
                                  }}),
        testing::Values(1, 2, 0)),
    [](const auto& named) {
      return std::string(std::get<0>(named.param).name) + "_limit" + std::to_string(std::get<1>(named.param));
    });

TEST(Agreement, TrackersAndShadowRoulette) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.4;
  scene.lights = {area_light()};
  scene.render.light_samples = 2;
  for (const int limit : {1, 0}) {
    scene.render.max_scatter = limit;
    std::uint64_t seed = 20;
    const auto with = [&](TransmittanceEstimator transmittance, FreeFlightSampling flight, double roulette) {
      SceneDescription one = scene;
      one.render.transmittance = transmittance;
      one.render.free_flight = flight;
      one.render.shadow_roulette = roulette;
      one.render.seed = ++seed;
      return estimate(one, two_blobs(), 200);
    };
    using enum TransmittanceEstimator;
    using enum FreeFlightSampling;
    const Estimate usual = with(kRatio, kDelta, 0);
    expect_same_mean(usual, with(kResidual, kDelta, 0));
    expect_same_mean(usual, with(kMarching, kDelta, 0));
    expect_same_mean(usual, with(kRatio, kDecomposition, 0));
    const Estimate fewer = with(kRatio, kDelta, 2);
    expect_same_mean(usual, fewer);
    EXPECT_LT(fewer.counters.shadow_rays, 0.8 * usual.counters.shadow_rays);
  }
}

}  // namespace
}  // namespace voxlume::test
