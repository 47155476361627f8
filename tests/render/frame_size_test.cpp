#include "render/frame_size.h"

#include <gtest/gtest.h>

namespace voxlume {
namespace {

/// What a machine with these costs takes for frames of a choice, until it settles.
FrameSize settled(FrameSizeChoice& choice, double fixed_s, double sample_s, double pixel_s, int frames = 40) {
  FrameSize size;
  for (int i = 0; i < frames; ++i) {
    size = choice.next(1280, 720);
    const double pixels = 1.0 * size.width * size.height;
    choice.learn(size, fixed_s, pixels * size.spp * sample_s, pixels * pixel_s);
  }
  return size;
}

double seconds(const FrameSize& size, double fixed_s, double sample_s, double pixel_s) {
  return fixed_s + 1.0 * size.width * size.height * (size.spp * sample_s + pixel_s);
}

TEST(FrameSize, FitsTheBudgetOnAnyMachine) {
  for (const double sample_s : {2e-8, 1e-7, 4e-7, 1e-6}) {
    FrameSizeChoice choice(1.0 / 30);
    const FrameSize size = settled(choice, 0.002, sample_s, sample_s);
    const double took_s = seconds(size, 0.002, sample_s, sample_s);
    EXPECT_LE(took_s, 1.2 / 30) << sample_s;
    EXPECT_GE(took_s, 0.4 / 30) << sample_s;  // and is not smaller than it must be
  }
}

TEST(FrameSize, IsAnEighthAtLeastAndTheWholeAtMost) {
  FrameSizeChoice slow(1.0 / 30), fast(1.0 / 30);
  EXPECT_EQ(settled(slow, 1, 1e-4, 1e-4), (FrameSize{160, 90, 1}));
  EXPECT_EQ(settled(fast, 0, 1e-12, 1e-12), (FrameSize{1280, 720, 4}));
  EXPECT_EQ(slow.next(1, 1), (FrameSize{1, 1, 1}));
}

/// A still picture needs more samples after larger moving ones, of more samples and of more frames; of sizes
/// only their ratio counts.
TEST(FirstStill, WaitsUntilItIsBetterThanTheMovingPicture) {
  const int coarse = first_still_spp({320, 180, 1}, 30, 1280),
            fine = first_still_spp({640, 360, 1}, 30, 1280);
  EXPECT_GE(coarse, 3);  // as measured
  EXPECT_GE(fine, 6);
  EXPECT_EQ(first_still_spp({640, 360, 1}, 1, 1280), coarse);
  EXPECT_EQ(first_still_spp({1280, 720, 3}, 30, 1280), 3 * fine);
  EXPECT_EQ(first_still_spp({160, 90, 1}, 30, 320), fine);
}

TEST(FrameSize, StaysWhereCostsWaver) {
  FrameSizeChoice choice(1.0 / 30);
  settled(choice, 0.002, 1e-7, 1e-7);
  const FrameSize size = choice.next(1280, 720);
  int changes = 0;
  for (int i = 0; i < 100; ++i) {
    const double cost = (i % 2 ? 1.05 : 0.95) * 1e-7;
    settled(choice, 0.002, cost, cost, 1);
    changes += !(choice.next(1280, 720) == size);
  }
  EXPECT_EQ(changes, 0);
}

}  // namespace
}  // namespace voxlume
