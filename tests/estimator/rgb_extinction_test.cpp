// Extinctions by channel. A channel of such a picture is a picture of one extinction, that channel's; what
// density_scale multiplies leaves opacities, and so surfaces, as they are.
#include <gtest/gtest.h>

#include <numbers>

#include "blob_scene.h"
#include "same_mean.h"
#include "voxlume/error.h"

namespace voxlume::test {
namespace {

using Channels = std::array<Estimate, 3>;

/// Every channel's samples.
Channels estimate_channels(const SceneDescription& description, const Volume& volume, int spp) {
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const CompiledScene scene(resolve(as_tested(description), volume, statistics), volume, statistics);
  const int width = description.image.width, height = description.image.height;
  Channels out;
  for (Estimate& channel : out) {
    channel.width = width;
    channel.height = height;
    channel.pixels.resize(static_cast<std::size_t>(width) * height);
  }
  std::vector<TraceCounters> counters(height);
  parallel_for(height, 1, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    std::vector<PixelSample> samples(static_cast<std::size_t>(width) * spp);
    trace_tile(scene.view(), {0, y, width, y + 1}, 0, spp, samples, {}, counters[row]);
    for (std::size_t i = 0; i < samples.size(); ++i)
      for (int c = 0; c < 3; ++c) out[c].pixels[row * width + i / spp].add(samples[i].radiance[c]);
  });
  for (const TraceCounters& c : counters) out[0].counters += c;
  EXPECT_EQ(out[0].counters.majorant_violations, 0u);
  for (const Estimate& channel : out) EXPECT_TRUE(std::isfinite(channel.total().sum2));
  return out;
}

void give_extinction_color(SceneDescription& scene, Color color) {
  scene.render.extinction = Extinction::kRgb;
  for (TransferPoint& point : scene.transfer.points) point.extinction_color = color;
}

/// Compares the channels of `rgb` with those of pictures of single extinctions.
void expect_channels_of_single(const SceneDescription& rgb, Color color, const Volume& volume, int spp) {
  const Channels found = estimate_channels(rgb, volume, spp);
  for (int c = 0; c < 3; ++c) {
    SCOPED_TRACE("channel " + std::to_string(c));
    SceneDescription single = rgb;
    single.render.extinction = Extinction::kSingle;
    single.transfer.density_scale *= color.linear[c];
    single.render.seed = rgb.render.seed + 100 + c;
    expect_same_mean(found[c], estimate_channels(single, volume, spp)[c]);
  }
}

constexpr Color kReddish{{0.3f, 0.7f, 1}};

struct LitCase {
  const char* name;
  void (*set)(SceneDescription&);
};

class RgbAgainstSingle : public testing::TestWithParam<std::tuple<LitCase, int>> {};

TEST_P(RgbAgainstSingle, EveryChannelIsThePictureOfItsExtinction) {
  const auto& [light, limit] = GetParam();
  SceneDescription scene = blob_scene();
  light.set(scene);
  scene.render.max_scatter = limit;
  give_extinction_color(scene, kReddish);
  expect_channels_of_single(scene, kReddish, two_blobs(), 100);
}

INSTANTIATE_TEST_SUITE_P(
    EveryLightAtEveryLimit, RgbAgainstSingle,
    testing::Combine(testing::Values(LitCase{"environment",
                                             [](SceneDescription& s) {
                                               s.environment->intensity = 1;
                                               s.background->kind = BackgroundKind::kEnvironment;
                                             }},
                                     LitCase{"rect",
                                             [](SceneDescription& s) {
                                               s.lights = {area_light()};
                                               s.background->color = {{0.3f, 0.2f, 0.1f}};
                                             }},
                                     LitCase{"directional",
                                             [](SceneDescription& s) {
                                               s.lights = {directional({-1, -1, 1}, 3)};
                                             }},
                                     LitCase{"all_glossy",
                                             [](SceneDescription& s) {
                                               s.environment->intensity = 0.5;
                                               s.lights = {area_light(), directional({-1, -1, 1}, 3)};
                                               s.render.light_samples = 2;
                                               s.material.specular = 1;
                                               s.material.gradient_factor = 1;
                                               s.material.anisotropy = 0.7;
                                             }},
                                     LitCase{"emission",
                                             [](SceneDescription& s) {
                                               s.transfer.points[1].emission = {{0.5f, 1, 2}};
                                               s.environment->intensity = 0.1;
                                             }},
                                     LitCase{"visibility",
                                             [](SceneDescription& s) {
                                               s.lights = {area_light(), directional({0, 0, 1}, 1)};
                                               s.environment->intensity = 0.4;
                                               s.visibility.emplace();
                                               ImportanceDescription dense;
                                               dense.range = {85, 1000};
                                               dense.importance = 0.9;
                                               s.visibility->important = {dense};
                                               s.visibility->lights = VisibilityLights::kAll;
                                             }},
                                     LitCase{"particles",
                                             [](SceneDescription& s) {
                                               s.lights = {area_light()};
                                               s.environment->intensity = 0.3;
                                               s.material.lobes = LobeModel::kParticles;
                                             }}),
                     testing::Values(1, 2, 0)),
    [](const auto& named) {
      return std::string(std::get<0>(named.param).name) + "_limit" + std::to_string(std::get<1>(named.param));
    });

TEST(RgbExtinction, OfEqualChannelsIsTheSinglePicture) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.4;
  scene.lights = {area_light()};
  for (const int limit : {1, 2, 0}) {
    scene.render.max_scatter = limit;
    scene.render.extinction = Extinction::kSingle;
    scene.render.seed = 1;
    const Estimate single = estimate(scene, two_blobs(), 150);
    scene.render.extinction = Extinction::kRgb;
    scene.render.seed = 2;
    expect_same_mean(single, estimate(scene, two_blobs(), 150));
  }
}

/// A view along y of matter of uniform extinction, 12 mm thick, whose sides are out of reach.
SceneDescription slab_view(double mu_t, Color extinction, double albedo) {
  SceneDescription scene = dark_scene(4, 4);
  scene.camera.height_mm = 1;
  scene.transfer.points = {point(1, mu_t, grey(static_cast<float>(albedo)))};
  scene.material.shading = Shading::kPhase;
  give_extinction_color(scene, extinction);
  return scene;
}
Volume slab() {
  Volume volume = make_volume({3, 3, 3}, 4.0, [](Vec3d) { return 1.0; });
  volume.spacing_mm = {4000, 4, 4000};
  volume.origin_mm = {-4000, -4, -4000};
  return volume;
}

void expect_mean(const Moments& moments, double expected) {
  EXPECT_LE(std::abs(moments.mean() - expected), 4 * moments.standard_error() + 1e-5 * expected)
      << "mean " << moments.mean() << " +- " << moments.standard_error() << ", expected " << expected;
}

TEST(RgbExtinction, BackgroundThroughAnAbsorbingSlab) {
  for (const Color extinction : {Color{{0.2f, 0.6f, 1}}, Color{{0, 0.5f, 1}}, Color{{1, 0, 0}}}) {
    for (const double mu_t : {0.02, 0.2, 1.0}) {
      SceneDescription scene = slab_view(mu_t, extinction, 0);
      scene.background->color = {{1, 2, 3}};
      const Channels channels = estimate_channels(scene, slab(), 20000);
      for (int c = 0; c < 3; ++c) {
        SCOPED_TRACE("channel " + std::to_string(c));
        const double transmittance = std::exp(-mu_t * double{extinction.linear[c]} * 12);
        const Moments total = channels[c].total();
        expect_mean(total, (c + 1) * transmittance);
        // No sample carries more than three channels' worth.
        EXPECT_LE(total.sum2, total.sum * 3.001 * (c + 1));
      }
    }
  }
}

TEST(RgbExtinction, SingleScatteringSlabLitFromTheFront) {
  const double irradiance = 3, albedo = 0.6;
  for (const Color extinction : {Color{{0.1f, 0.5f, 1}}, Color{{0, 0.3f, 1}}}) {
    for (const double mu0 : {1.0, 0.5}) {
      const double tau = 2;
      SceneDescription scene = slab_view(tau / 12, extinction, albedo);
      scene.lights = {directional({std::sqrt(1 - mu0 * mu0), -mu0, 0}, irradiance)};
      scene.render.max_scatter = 1;
      const Channels channels = estimate_channels(scene, slab(), 20000);
      for (int c = 0; c < 3; ++c) {
        SCOPED_TRACE("channel " + std::to_string(c));
        const double own = tau * double{extinction.linear[c]};
        expect_mean(channels[c].total(), albedo * irradiance / (4 * std::numbers::pi) *
                                             (1 - std::exp(-own * (1 + 1 / mu0))) / (1 + 1 / mu0));
      }
    }
  }
}

TEST(RgbExtinction, ChannelsWithoutExtinctionLeaveTheOthersAsTheyAre) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.5;
  scene.lights = {area_light()};
  scene.background->color = {{0.25f, 0.5f, 1}};
  const Color extinction{{0, 1, 0.4f}};
  give_extinction_color(scene, extinction);
  for (const int limit : {1, 0}) {
    scene.render.max_scatter = limit;
    const Channels found = estimate_channels(scene, two_blobs(), 150);
    const Moments red = found[0].total();
    EXPECT_LT(std::abs(red.mean() - 0.25), 4 * red.standard_error());
    for (const int c : {1, 2}) {
      SceneDescription single = scene;
      single.render.extinction = Extinction::kSingle;
      single.transfer.density_scale = extinction.linear[c];
      single.render.seed = 50 + c;
      expect_same_mean(found[c], estimate_channels(single, two_blobs(), 150)[c]);
    }
  }
}

TEST(RgbExtinction, WhiteMatterInAUniformEnvironmentIsInvisible) {
  const Volume ball =
      make_volume({20, 20, 20}, 2.0, [](Vec3d p) { return std::max(0.0, 1.2 - length(p) / 18.0); });
  for (const double mu_t : {0.05, 0.5, 4.0}) {
    for (const Color extinction : {Color{{0.2f, 0.6f, 1}}, Color{{0, 0.01f, 1}}}) {
      for (const Shading shading : {Shading::kPhase, Shading::kCoexistence}) {
        SceneDescription scene = dark_scene(8, 8);
        scene.environment->intensity = 1;
        scene.background->kind = BackgroundKind::kEnvironment;
        scene.transfer.points = {point(0, 0, grey(1)), point(1, mu_t, grey(1))};
        scene.material.shading = shading;
        scene.material.specular = 0;
        scene.material.anisotropy = 0.3;
        scene.render.max_scatter = 0;
        give_extinction_color(scene, extinction);
        const Channels channels = estimate_channels(scene, ball, 600);
        for (const Estimate& channel : channels) {
          // By quadrants: a pixel at the ball's edge has few collisions, which its own error would not know
          // of.
          Moments quadrants[4];
          for (std::size_t i = 0; i < channel.pixels.size(); ++i)
            quadrants[(i / 8 / 4) * 2 + i % 8 / 4] += channel.pixels[i];
          for (const Moments& quadrant : quadrants)
            EXPECT_LT(std::abs(quadrant.mean() - 1), 4.5 * quadrant.standard_error() + 1e-4)
                << quadrant.mean() << " +- " << quadrant.standard_error();
          const Moments all = channel.total();
          EXPECT_LT(std::abs(all.mean() - 1), 4 * all.standard_error() + 1e-4);
        }
      }
    }
  }
}

TEST(RgbExtinction, ColorsAreInterpolatedBetweenPoints) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.6;
  scene.lights = {area_light()};
  scene.material.shading = Shading::kPhase;
  scene.render.max_scatter = 2;
  scene.render.extinction = Extinction::kRgb;
  const Color lower{{1, 0.5f, 0.25f}}, upper{{0.1f, 0.75f, 1}};
  scene.transfer.points[0].extinction_color = lower;
  scene.transfer.points[2].extinction_color = upper;
  const Channels found = estimate_channels(scene, two_blobs(), 150);
  for (int c = 0; c < 3; ++c) {
    SCOPED_TRACE("channel " + std::to_string(c));
    SceneDescription single = scene;
    single.render.extinction = Extinction::kSingle;
    single.render.seed = 70 + c;
    single.transfer.points.clear();
    for (double value = 15; value <= 70; value += 0.25) {
      const auto between = [value](double v0, double y0, double v1, double y1) {
        return y0 + (y1 - y0) * (value - v0) / (v1 - v0);
      };
      const double mu_t = value < 40 ? between(15, 0, 40, 0.15) : between(40, 0.15, 70, 1.5);
      const double share = between(15, double{lower.linear[c]}, 70, double{upper.linear[c]});
      single.transfer.points.push_back(point(value, mu_t * share, {{0, 0, 0}}));
      single.transfer.points.back().color.reset();
    }
    for (const TransferPoint& own : scene.transfer.points)
      for (TransferPoint& p : single.transfer.points)
        if (p.value == own.value) p.color = own.color;
    expect_same_mean(found[c], estimate_channels(single, two_blobs(), 150)[c]);
  }
}

TEST(RgbExtinction, RulesMergeColors) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.6;
  scene.lights = {area_light()};
  scene.render.max_scatter = 2;
  scene.render.extinction = Extinction::kRgb;
  const Color own{{0.5f, 0.8f, 1}}, ruled{{1, 0.25f, 0.6f}};
  for (TransferPoint& p : scene.transfer.points) p.extinction_color = own;
  RuleDescription rule;
  rule.points.resize(1);
  rule.points[0].value = 0;
  rule.points[0].extinction_color = ruled;
  scene.transfer.rules = {rule};
  scene.transfer.merge = Merge::kPriority;
  expect_channels_of_single(scene, ruled, two_blobs(), 100);
  scene.transfer.merge = Merge::kProduct;
  expect_channels_of_single(scene, {{0.5f, 0.2f, 0.6f}}, two_blobs(), 100);
}

TEST(RgbExtinction, NamedMaterialsGiveColors) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.6;
  scene.render.max_scatter = 2;
  scene.render.extinction = Extinction::kRgb;
  scene.materials.resize(1);
  scene.materials[0].name = "tinted";
  scene.materials[0].color = Color{{0.9f, 0.6f, 0.4f}};
  scene.materials[0].mu_t_per_mm = 0.5;
  scene.materials[0].extinction_color = kReddish;
  RuleDescription rule;
  rule.kind = RuleKind::kMaterialSteps;
  rule.points.resize(1);
  rule.points[0].value = 30;
  rule.points[0].material = "tinted";
  scene.transfer.rules = {rule};
  scene.transfer.points.clear();
  expect_channels_of_single(scene, kReddish, two_blobs(), 100);
}

TEST(RgbExtinction, WorksWithEveryAcceleratorSelfOcclusionAndClippedLight) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.4;
  scene.lights = {area_light()};
  scene.render.max_scatter = 2;
  give_extinction_color(scene, kReddish);
  for (const char* accelerator : {"none", "macrocell", "octree", "residency"}) {
    SCOPED_TRACE(accelerator);
    scene.render.accelerator = accelerator;
    expect_channels_of_single(scene, kReddish, two_blobs(), 60);
  }
  scene.render.accelerator = "auto";
  scene.material.self_occlusion = 0.4;
  expect_channels_of_single(scene, kReddish, two_blobs(), 100);
  scene.material.self_occlusion = 1;
  scene.clip.emplace();
  scene.clip->z_mm = {-1e30, 2};
  scene.clip->blocks_light = true;
  scene.render.shadow_roulette = 1;
  expect_channels_of_single(scene, kReddish, two_blobs(), 100);
}

TEST(RgbExtinction, PartsAddUpToTheRadiance) {
  SceneDescription description = blob_scene();
  description.environment->intensity = 0.4;
  description.lights = {area_light()};
  give_extinction_color(description, kReddish);
  for (const int limit : {1, 2, 0}) {
    description.render.max_scatter = limit;
    const Volume volume = two_blobs();
    const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
    const CompiledScene scene(resolve(as_tested(description), volume, statistics), volume, statistics);
    SceneView view = scene.view();
    view.keeps_parts = true;
    TraceCounters counters;
    int scattered = 0;
    for (int y = 0; y < view.height; ++y) {
      for (int x = 0; x < view.width; ++x) {
        RadianceParts parts;
        const PixelSample sample = trace_camera_sample(view, x, y, 0, counters, &parts);
        if (!(sample.alpha > 0)) continue;
        ++scattered;
        const Vec3f sum = parts.direct_diffuse + parts.direct_specular + parts.later;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(sum[c], sample.radiance[c], 1e-5f * (1 + sample.radiance[c])) << x << ", " << y;
        if (limit == 1) {
          ASSERT_LT(max_component(parts.later), 1e-4f * (1 + max_component(sample.radiance)));
        }
      }
    }
    EXPECT_GT(scattered, 100);
  }
}

TEST(RgbExtinction, SingleIgnoresColors) {
  SceneDescription scene = blob_scene();
  scene.environment->intensity = 0.4;
  const Estimate plain = estimate(scene, two_blobs(), 4);
  give_extinction_color(scene, kReddish);
  scene.render.extinction = Extinction::kSingle;
  const Estimate colored = estimate(scene, two_blobs(), 4);
  for (std::size_t i = 0; i < plain.pixels.size(); ++i)
    ASSERT_EQ(plain.pixels[i].sum, colored.pixels[i].sum) << i;
}

TEST(RgbExtinction, OtherTrackersAreRefused) {
  SceneDescription scene = blob_scene();
  scene.render.extinction = Extinction::kRgb;
  scene.render.transmittance = TransmittanceEstimator::kResidual;
  EXPECT_THROW(estimate(scene, two_blobs(), 1), Error);
}

}  // namespace
}  // namespace voxlume::test
