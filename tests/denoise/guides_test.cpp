#include "denoise/guides.h"

#include <gtest/gtest.h>

#include "denoise/test_frame.h"
#include "support/every_target.h"

namespace voxlume {
namespace {

using test::for_every_target;

constexpr int kWidth = 37, kHeight = 23;

TEST(Guides, PixelsWithoutMatterTakeTheMeanOfThoseAround) {
  for_every_target([] {
    const auto one_in_three = [](int x, int y) {
      TestPixel p;
      p.alpha = x % 3 == 0 && y < 10 ? (x % 2 ? 0.25f : 0.75f) : 0;
      p.depth_mm = x % 2 ? 400 : 600;
      p.albedo = Vec3f(x % 2 ? 0.2f : 0.6f);
      return p;
    };
    Guides guides;
    make_guides(test_frame(kWidth, kHeight, one_in_three), guides);
    EXPECT_EQ(guides.depth_mm.at(9, 4), 400) << "its own";
    EXPECT_NEAR(guides.depth_mm.at(10, 4), 0.25f * 400 + 0.75f * 600, 1e-3f) << "of both";
    EXPECT_NEAR(guides.albedo[1].at(10, 4), 0.5f, 1e-6f);
    EXPECT_NEAR(guides.normal[1].at(10, 4), -1, 1e-6f);
    EXPECT_NEAR(guides.depth_mm.at(10, 11), 550, 1e-3f) << "two rows away";
    EXPECT_EQ(guides.depth_mm.at(10, 12), 0) << "out of reach";
  });
}

TEST(Guides, DepthIsToleratedByTheSmootherSide) {
  for_every_target([] {
    const auto slope_and_step = [](int x, int y) {
      TestPixel p;
      p.depth_mm = 300.0f + 2.0f * static_cast<float>(x) + static_cast<float>(y) + (x >= 20 ? 100.0f : 0.0f);
      return p;
    };
    const DenoiseFrame frame = test_frame(kWidth, kHeight, slope_and_step);
    Guides guides;
    make_guides(frame, guides);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x)
        ASSERT_NEAR(1 / guides.depth_rate.at(x, y), 2 + 0.002f * frame.size_mm, 1e-3f) << x << ' ' << y;
    }
  });
}

TEST(Guides, NormalsThatDisagreeWeighLess) {
  for_every_target([] {
    const auto shorter_to_the_right = [](int x, int) {
      TestPixel p;
      p.normal = Vec3f(0, x < 20 ? -1 : -0.5f, 0);
      return p;
    };
    Guides many, few;
    make_guides(test_frame(kWidth, kHeight, shorter_to_the_right, 0, 1, 10000), many);
    make_guides(test_frame(kWidth, kHeight, shorter_to_the_right, 0, 1, 4), few);
    EXPECT_NEAR(many.feature_rate.at(5, 5), 64, 0.2f) << "exact normals";
    EXPECT_LT(few.feature_rate.at(5, 5), many.feature_rate.at(5, 5));
    EXPECT_LT(few.feature_rate.at(30, 5), few.feature_rate.at(5, 5) / 3);
    // 2 v = 2 (1 - 0.25) / 4 at least.
    EXPECT_LT(few.feature_rate.at(30, 5), 1 / 0.375f);
  });
}

}  // namespace
}  // namespace voxlume
