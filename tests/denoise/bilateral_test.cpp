#include "denoise/bilateral.h"

#include <gtest/gtest.h>

#include "denoise/brute_force.h"
#include "support/every_target.h"

namespace voxlume {
namespace {

using test::for_every_target;

constexpr int kWidth = 43, kHeight = 31;

TEST(Bilateral, IsTheSumOverSevenBySevenPixels) {
  const DenoiseFrame frame = random_frame(kWidth, kHeight, 4);
  for_every_target([&] {
    DenoisedFrame out;
    make_bilateral()->denoise(frame, out);
    Guides guides;
    make_guides(frame, guides);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        double color = 0, alpha = 0;
        for (int dy = -3; dy <= 3; ++dy) {
          for (int dx = -3; dx <= 3; ++dx) {
            const double weight =
                std::exp(-(dx * dx + dy * dy) / 8.0) * guide_weight(guides, x, y, x + dx, y + dy);
            color += weight * frame.radiance[0].at(x + dx, y + dy);
            alpha += weight * frame.alpha.at(x + dx, y + dy);
          }
        }
        const double expected = alpha > 0 ? out.alpha.at(x, y) * color / alpha : 0;
        ASSERT_NEAR(out.radiance[0].at(x, y), expected, 1e-3 * expected + 1e-6) << x << ' ' << y;
      }
    }
  });
}

TEST(Bilateral, DoesNotCrossEdgesOfDepth) {
  const auto near_and_far = [](int x, int) {
    return TestPixel{.radiance = Vec3f(x < 20 ? 1.0f : 0.1f), .depth_mm = x < 20 ? 400.0f : 440.0f};
  };
  const DenoiseFrame frame = test_frame(kWidth, kHeight, near_and_far, 0, 1, 1000);
  DenoisedFrame out;
  make_bilateral()->denoise(frame, out);
  EXPECT_LT(difference(out.radiance, frame.radiance), 1e-4);
}

}  // namespace
}  // namespace voxlume
