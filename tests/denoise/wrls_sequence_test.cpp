// What becomes of sequences of frames.
#include <gtest/gtest.h>

#include "denoise/test_frame.h"
#include "denoise/wrls.h"

namespace voxlume {
namespace {

TestPixel lit(float value) { return {.radiance = Vec3f(value, 0.8f * value, 0.7f * value)}; }

/// Frames after a step of brightness until the error stays below twice what it was.
int frames_to_settle(WrlsOptions options, double sigma, float before, float after) {
  constexpr int kWidth = 48, kHeight = 32;
  const auto frame_of = [&](float value, unsigned seed) {
    return test_frame(
        kWidth, kHeight, [value](int, int) { return lit(value); }, seed > 0 ? sigma : 0, seed);
  };
  Wrls wrls(options);
  DenoisedFrame out;
  for (unsigned t = 1; t <= 60; ++t) wrls.denoise(frame_of(before, t), out);
  const double settled = 2 * difference(out.radiance, frame_of(before, 0).radiance) / before;
  const Planes3 exact = frame_of(after, 0).radiance;
  int frames = 0;
  for (unsigned t = 1; t <= 120; ++t) {
    wrls.denoise(frame_of(after, 60 + t), out);
    if (difference(out.radiance, exact) / after > settled) frames = static_cast<int>(t);
  }
  return frames;
}

TEST(WrlsSequence, WeightsShortenWhatFollowsAStep) {
  EXPECT_LE(frames_to_settle({}, 1, 0.8f, 0.08f), 5) << "with";
  EXPECT_GE(frames_to_settle({.weighted = false}, 1, 0.8f, 0.08f), 30)
      << "without: what was learned from brighter frames overshoots";
}

TEST(WrlsSequence, WeightsHideSpikes) {
  constexpr int kWidth = 48, kHeight = 32;
  const auto grey = [](int, int) { return lit(0.5f); };
  const Planes3 exact = test_frame(kWidth, kHeight, grey).radiance;
  const auto error = [&](WrlsOptions options) {
    Wrls wrls(options);
    DenoisedFrame out;
    std::mt19937 random(17);
    std::uniform_int_distribution<int> column(0, kWidth - 1), row(0, kHeight - 1);
    double sum = 0;
    for (unsigned t = 1; t <= 40; ++t) {
      DenoiseFrame frame = test_frame(kWidth, kHeight, grey, 0.3, t);
      for (int i = 0; i < 15; ++i) {
        const int x = column(random), y = row(random);
        for (Plane& plane : frame.radiance) plane.at(x, y) = 20;
      }
      wrls.denoise(frame, out);
      if (t > 20) sum += difference(out.radiance, exact);
    }
    return sum / 20;
  };
  EXPECT_LT(error({}), 0.3 * error({.weighted = false}));
}

/// A textured plane through the camera's target, facing azimuth 0.
DenoiseFrame textured_plane(int width, int height, double azimuth_deg, double sigma, unsigned seed) {
  const CameraView view = test_camera(width, height, azimuth_deg), front = test_camera(width, height);
  std::vector<float> depth(static_cast<std::size_t>(width) * height);
  const auto pixel = [&](int x, int y) {
    const CameraRay ray = camera_ray(view, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 0);
    TestPixel p;
    p.depth_mm = dot(view.target_mm - ray.origin, front.forward) / dot(ray.direction, front.forward);
    const Vec3f hit = ray.origin + ray.direction * p.depth_mm - view.target_mm;
    const float wave = std::sin(dot(hit, front.right) * 0.12f) * std::cos(dot(hit, front.up) * 0.1f);
    p.radiance = Vec3f(0.5f, 0.4f, 0.3f) * (1 + 0.6f * wave);
    return p;
  };
  return test_frame(width, height, pixel, sigma, seed, 4, azimuth_deg);
}

TEST(WrlsSequence, FollowsATexturedPlaneWithoutGhosts) {
  constexpr int kWidth = 96, kHeight = 64;
  for (const double sigma : {0.0, 0.7}) {
    Wrls wrls({}), still({});
    DenoisedFrame out;
    double noisy = 0, error = 0, ghosts = 0;
    for (unsigned t = 1; t <= 40; ++t) {
      const double azimuth = -20 + static_cast<double>(t);
      const DenoiseFrame frame = textured_plane(kWidth, kHeight, azimuth, sigma, t);
      const Planes3 exact = textured_plane(kWidth, kHeight, azimuth, 0, t).radiance;
      wrls.denoise(frame, out);
      if (t <= 20) continue;
      noisy += difference(frame.radiance, exact);
      error += difference(out.radiance, exact);
      // The same frames to a denoiser that does not know that the camera moves.
      DenoiseFrame unmoved = frame;
      unmoved.camera = test_camera(kWidth, kHeight);
      still.denoise(unmoved, out);
      ghosts += difference(out.radiance, exact);
    }
    if (sigma > 0) {
      EXPECT_LT(error, 0.35 * noisy);
    } else {
      // The texture's standard deviation is 0.12.
      EXPECT_LT(error / 20, 0.1 * 0.12) << "sharp";
      EXPECT_LT(error, 0.5 * ghosts);
    }
  }
}

TEST(WrlsSequence, OtherMatterIsNoHistory) {
  constexpr int kWidth = 24, kHeight = 8;
  const auto frame_at = [](float depth_mm, unsigned seed) {
    return test_frame(
        kWidth, kHeight, [&](int, int) { return TestPixel{.depth_mm = depth_mm}; }, 0.5, seed);
  };
  const auto z_after = [&](float depth_mm) {
    Wrls wrls({});
    DenoisedFrame out;
    wrls.denoise(frame_at(500, 1), out);
    wrls.denoise(frame_at(depth_mm, 2), out);
    return wrls.models().z;
  };
  Wrls fresh({});
  DenoisedFrame out;
  fresh.denoise(frame_at(500, 2), out);
  const float reach = kWrlsDepthTolerance * frame_at(500, 1).size_mm;
  EXPECT_EQ(difference(z_after(500 + 1.05f * reach), fresh.models().z), 0);
  EXPECT_EQ(difference(z_after(500 + 0.95f * reach), z_after(500)), 0);
  EXPECT_GT(difference(z_after(500), fresh.models().z), 0.01);
}

TEST(WrlsSequence, ThinMatterIsNeitherLostNorThickened) {
  constexpr int kWidth = 64, kHeight = 48;
  std::mt19937 random(23);
  std::binomial_distribution<int> hits(4, 0.15);
  for (const bool weighted : {true, false}) {
    Wrls wrls({.weighted = weighted});
    DenoisedFrame out;
    double alpha = 0, red = 0;
    for (int t = 0; t < 60; ++t) {
      const auto thin = [&](int, int) {
        const float share = static_cast<float>(hits(random)) / 4;
        return TestPixel{.radiance = Vec3f(0.5f) * share, .alpha = share};
      };
      wrls.denoise(test_frame(kWidth, kHeight, thin), out);
      if (t < 20) continue;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) alpha += out.alpha.at(x, y), red += out.radiance[0].at(x, y);
      }
    }
    const double n = 40.0 * kWidth * kHeight;
    EXPECT_NEAR(alpha / n, 0.15, 0.05 * 0.15);
    // A sample that is 0 has weight 0 in eq. 13: the method's own bias.
    EXPECT_NEAR(red / n, 0.075, (weighted ? 0.12 : 0.02) * 0.075);
  }
}

TEST(WrlsSequence, DarkFramesBeforeTheLightTeachNothing) {
  constexpr int kWidth = 24, kHeight = 8;
  const auto grey = [](int, int) { return lit(0.5f); };
  const auto dark = [](int, int) { return lit(0); };
  Wrls wrls({}), fresh({});
  DenoisedFrame out, expected;
  for (int t = 0; t < 5; ++t) wrls.denoise(test_frame(kWidth, kHeight, dark), out);
  EXPECT_EQ(wrls.scale(), 0);
  EXPECT_EQ(difference(out.radiance, make_planes3(kWidth, kHeight)), 0);
  const DenoiseFrame noisy = test_frame(kWidth, kHeight, grey, 0.5, 3);
  wrls.denoise(noisy, out);
  fresh.denoise(noisy, expected);
  EXPECT_EQ(difference(out.radiance, expected.radiance), 0);
}

TEST(WrlsSequence, WithoutFeatureAndWeightsItIsAMeanOverTime) {
  constexpr int kWidth = 20, kHeight = 6;
  Wrls wrls({.weighted = false, .feature = false});
  DenoisedFrame out;
  double sum = 0.8 / kWrlsFirstPWithoutFeature, weight = 1 / kWrlsFirstPWithoutFeature;
  for (int t = 0; t < 50; ++t) {
    const float value = t < 20 ? 0.8f : 0.1f;
    wrls.denoise(test_frame(kWidth, kHeight, [&](int, int) { return TestPixel{.radiance = Vec3f(value)}; }),
                 out);
    sum = kWrlsForgetting * sum + value;
    weight = kWrlsForgetting * weight + 1;
    ASSERT_NEAR(out.radiance[1].at(kWidth / 2, 3), sum / weight, 1e-5) << t;
  }
}

}  // namespace
}  // namespace voxlume
