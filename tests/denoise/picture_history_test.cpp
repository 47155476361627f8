#include "denoise/picture_history.h"

#include <gtest/gtest.h>

#include <cmath>

#include "denoise/decoupled.h"
#include "denoise/test_frame.h"

namespace voxlume {
namespace {

constexpr int kWidth = 64, kHeight = 48;

/// Lines of light that no guide shows, under a light of some strength.
auto lines(float light) {
  return [light](int x, int) {
    TestPixel p;
    p.radiance = p.albedo * (x % 6 == 0 ? light : 0.4f * light);
    return p;
  };
}

/// What a blur takes from the lines, so that all of their detail is residual.
DenoisedFrame blurred(const DenoiseFrame& frame) {
  DenoisedFrame out;
  out.resize(frame.width, frame.height);
  out.alpha = frame.alpha;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < frame.height; ++y) {
      for (int x = 0; x < frame.width; ++x) {
        double sum = 0;
        int count = 0;
        for (int i = std::max(0, x - 6); i <= std::min(frame.width - 1, x + 6); ++i)
          sum += frame.radiance[c].at(i, y), ++count;
        out.radiance[c].at(x, y) = static_cast<float>(sum / count);
      }
    }
  }
  return out;
}

TEST(PictureHistory, OfAStillViewTendsToTheMeanWhateverTheFilterTook) {
  const Planes3 exact = test_frame(kWidth, kHeight, lines(1)).radiance;
  PictureHistory history;
  double first = 0, last = 0, noisy = 0;
  for (unsigned seed = 1; seed <= 48; ++seed) {
    const DenoiseFrame frame = test_frame(kWidth, kHeight, lines(1), 0.7, seed, 16);
    DenoisedFrame picture = blurred(frame);
    history.blend(frame, picture);
    last = difference(picture.radiance, exact);
    noisy = difference(frame.radiance, exact);
    if (seed == 1) first = last;
  }
  EXPECT_LE(first, 1.05 * noisy) << "one frame is no worse than its plain mean";
  EXPECT_LT(last, 0.4 * noisy) << "as the mean of six frames";
}

TEST(PictureHistory, ForgettingStartsAnew) {
  const DenoiseFrame frame = test_frame(kWidth, kHeight, lines(1), 0.7, 9, 16);
  PictureHistory fresh, used;
  DenoisedFrame expected = blurred(frame), picture = expected;
  fresh.blend(frame, expected);
  for (unsigned seed = 1; seed < 4; ++seed) {
    const DenoiseFrame before = test_frame(kWidth, kHeight, lines(3), 0.7, seed, 16);
    DenoisedFrame other = blurred(before);
    used.blend(before, other);
  }
  used.forget();
  used.blend(frame, picture);
  EXPECT_EQ(difference(picture.radiance, expected.radiance), 0);
}

TEST(PictureHistory, ALightThatGrowsSteadilyIsNotShownLate) {
  PictureHistory history;
  double mean = 0, target = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const float light = 0.3f * std::pow(1.03f, static_cast<float>(seed));
    const DenoiseFrame frame = test_frame(kWidth, kHeight, lines(light), 0.7, seed, 16);
    DenoisedFrame picture = blurred(frame);
    history.blend(frame, picture);
    const Planes3 exact = test_frame(kWidth, kHeight, lines(light)).radiance;
    mean = target = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) mean += picture.radiance[1].at(x, y), target += exact[1].at(x, y);
    }
  }
  // A mean over as many frames as a still view gets (a gain of 0.15) would be 6 frames late: 16 %.
  EXPECT_NEAR(mean / target, 1, 0.02);
}

TEST(PictureHistory, MatterThatMovesKeepsItsDetail) {
  // Columns of a board at 480 to 520 mm, seen by a camera that turns: what each pixel sees is where its ray
  // meets the plane y = 0 of the test camera's scene.
  PictureHistory history;
  double error = 0, noisy = 0;
  for (unsigned seed = 1; seed <= 24; ++seed) {
    const double azimuth = 0.4 * seed;
    const CameraView camera = test_camera(kWidth, kHeight, azimuth);
    const auto seen = [&](int x, int y) {
      const float u = 2 * (static_cast<float>(x) + 0.5f) / kWidth - 1;
      const float v = 1 - 2 * (static_cast<float>(y) + 0.5f) / kHeight;
      const Vec3f ray =
          camera.forward + camera.right * (u * camera.half_width) + camera.up * (v * camera.half_height);
      TestPixel p;
      const float t = -camera.eye_mm.y / ray.y;
      const Vec3f hit = camera.eye_mm + ray * t;
      p.depth_mm = t * length(ray);
      p.radiance = p.albedo * (0.6f + 0.4f * std::sin(hit.x / 12) * std::sin(hit.z / 12));
      return p;
    };
    const DenoiseFrame frame = test_frame(kWidth, kHeight, seen, 0.7, seed, 16, azimuth);
    const Planes3 exact = test_frame(kWidth, kHeight, seen, 0, 1, 1, azimuth).radiance;
    DenoisedFrame picture = blurred(frame);
    history.blend(frame, picture);
    error = difference(picture.radiance, exact);
    noisy = difference(frame.radiance, exact);
  }
  EXPECT_LT(error, 0.6 * noisy);
}

}  // namespace
}  // namespace voxlume
