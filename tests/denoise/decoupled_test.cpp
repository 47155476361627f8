#include "denoise/decoupled.h"

#include <gtest/gtest.h>

#include "denoise/test_frame.h"
#include "support/every_target.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr int kWidth = 61, kHeight = 43;

/// A board of two albedos under a light with a soft shadow; empty at the left.
TestPixel board(int x, int y) {
  TestPixel p;
  const bool bright = ((x / 5) + (y / 5)) % 2 == 0;
  p.albedo = bright ? Vec3f(0.9f, 0.8f, 0.7f) : Vec3f(0.3f, 0.25f, 0.2f);
  const float light = x < 30 ? 1.0f : x > 40 ? 0.2f : 1.0f - 0.08f * static_cast<float>(x - 30);
  p.radiance = p.albedo * light;
  p.depth_mm = 480 + 2 * static_cast<float>(y);
  if (x < 6) p.alpha = 0, p.radiance = Vec3f(0);
  return p;
}

/// The frame with half of each pixel's samples in a second class, which scatters a quarter as much.
DenoiseFrame in_two_classes(DenoiseFrame frame) {
  auto& [one, two] = *frame.classes;
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const float count = one.count.at(x, y);
      if (count < 2) continue;
      const float second = std::floor(count / 2), first = count - second;
      one.count.at(x, y) = first;
      two.count.at(x, y) = second;
      for (int c = 0; c < 3; ++c) {
        // (first fx + second fx / 4) fl is the radiance as before.
        const float fx = one.fx_diffuse[c].at(x, y), fl = one.fl_diffuse[c].at(x, y);
        two.fx_diffuse[c].at(x, y) = fx / 4;
        one.fl_diffuse[c].at(x, y) = two.fl_diffuse[c].at(x, y) = fl * count / (first + second / 4);
      }
    }
  }
  return frame;
}

TEST(Decoupled, NeedsClasses) {
  DenoiseFrame frame = test_frame(kWidth, kHeight, board);
  frame.classes.reset();
  DenoisedFrame out;
  EXPECT_THROW(DecoupledDenoiser().denoise(frame, out), Error);
}

TEST(Decoupled, KeepsAlbedosApartUnderSmoothLight) {
  // Exact classes: what is left of the error is what filters take from a picture without noise.
  const DenoiseFrame exact = test_frame(kWidth, kHeight, board);
  for (const DenoiseFrame& frame : {exact, in_two_classes(exact)}) {
    DenoisedFrame out;
    DecoupledDenoiser().denoise(frame, out);
    EXPECT_LT(difference(out.radiance, exact.radiance), 0.02) << "of albedos 0.9 and 0.3";
  }
}

TEST(Decoupled, OfTwoClassesTakesAsMuchNoiseAway) {
  const Planes3 exact = test_frame(kWidth, kHeight, board).radiance;
  const DenoiseFrame noisy = test_frame(kWidth, kHeight, board, 0.7, 3);
  DenoisedFrame one, two;
  DecoupledDenoiser().denoise(noisy, one);
  DecoupledDenoiser().denoise(in_two_classes(noisy), two);
  const double before = difference(noisy.radiance, exact);
  EXPECT_LT(difference(one.radiance, exact), before / 2);
  EXPECT_LT(difference(two.radiance, exact), before / 2);
}

TEST(Decoupled, IsTheSameOnEveryInstructionSet) {
  std::vector<DenoisedFrame> results;
  test::for_every_target([&] {
    DecoupledDenoiser denoiser;
    DenoisedFrame out;
    for (unsigned seed = 1; seed < 4; ++seed)
      denoiser.denoise(in_two_classes(test_frame(kWidth, kHeight, board, 0.7, seed, 6, 0.5 * seed)), out);
    results.push_back(std::move(out));
  });
  ASSERT_GE(results.size(), 2u);
  for (const DenoisedFrame& result : results)
    EXPECT_LT(difference(result.radiance, results.front().radiance), 2e-3)
        << "approximate roots differ by 1e-3";
}

TEST(Decoupled, DoesNotDependOnTheUnitOfLength) {
  DenoiseFrame frame = test_frame(kWidth, kHeight, board, 0.7, 3);
  DenoisedFrame mm, um;
  DecoupledDenoiser().denoise(frame, mm);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) frame.depth_mm.at(x, y) *= 1024;
  }
  frame.size_mm *= 1024;
  DecoupledDenoiser().denoise(frame, um);
  EXPECT_LT(difference(mm.radiance, um.radiance), 1e-5);
}

TEST(Decoupled, FollowsALightThatIsSwitchedWithinFiveFrames) {
  const auto lit = [](float light) {
    return [light](int, int) {
      TestPixel p;
      p.radiance = p.albedo * light;
      return p;
    };
  };
  DecoupledDenoiser denoiser;
  DenoisedFrame out;
  unsigned seed = 1;
  for (; seed < 20; ++seed) denoiser.denoise(test_frame(kWidth, kHeight, lit(1), 0.5, seed), out);
  const Planes3 target = test_frame(kWidth, kHeight, lit(0.25f)).radiance;
  const double step = difference(out.radiance, target);
  int frames = 0;
  while (difference(out.radiance, target) > 0.1 * step && frames < 30) {
    denoiser.denoise(test_frame(kWidth, kHeight, lit(0.25f), 0.5, ++seed), out);
    ++frames;
  }
  EXPECT_LE(frames, 5);
}

TEST(Decoupled, GoesOverToTheMeanAsItsErrorFalls) {
  // Detail that no guide shows: thin lines of light.
  const auto lines = [](int x, int) {
    TestPixel p;
    p.radiance = p.albedo * (x % 6 == 0 ? 1.0f : 0.4f);
    return p;
  };
  const Planes3 exact = test_frame(kWidth, kHeight, lines).radiance;
  double last = 1e9;
  for (const int spp : {16, 256, 4096}) {
    const DenoiseFrame frame = test_frame(kWidth, kHeight, lines, 1, 5, spp);
    DenoisedFrame out;
    DecoupledDenoiser().denoise(frame, out);
    const double error = difference(out.radiance, exact);
    EXPECT_LE(error, 1.05 * difference(frame.radiance, exact)) << spp;
    EXPECT_LT(error, last / 2) << spp;
    last = error;
  }
}

TEST(Decoupled, TakesNoiseFromSingleSamples) {
  const Planes3 exact = test_frame(kWidth, kHeight, board).radiance;
  DecoupledDenoiser denoiser;
  DenoisedFrame out;
  for (unsigned seed = 1; seed < 20; ++seed) {
    const DenoiseFrame frame = test_frame(kWidth, kHeight, board, 0.7, seed, 1);
    denoiser.denoise(frame, out);
    if (seed == 1) {
      EXPECT_LT(difference(out.radiance, exact), difference(frame.radiance, exact) / 2);
    }
  }
  EXPECT_LT(difference(out.radiance, exact), 0.1);
}

}  // namespace
}  // namespace voxlume
