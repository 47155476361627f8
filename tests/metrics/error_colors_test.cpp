#include "metrics/error_colors.h"

#include <gtest/gtest.h>

#include <cmath>

#include "flip_reference.h"
#include "tonemap/srgb.h"

namespace voxlume::test {
namespace {

TEST(ErrorColors, LightnessIsProportional) {
  for (int i = 0; i <= 200; ++i) {
    const float error = static_cast<float>(i) / 200.0f;
    const auto color = error_color(error);
    Rgb linear;
    for (int c = 0; c < 3; ++c) linear[c] = linear_from_srgb(static_cast<float>(color[c]) / 255.0f);
    EXPECT_NEAR(reference_lab(linear)[0], 97 * error, 1.5) << error;
  }
}

TEST(ErrorColors, Ends) {
  using Color = std::array<std::uint8_t, 3>;
  EXPECT_EQ(error_color(0), (Color{0, 0, 0}));
  EXPECT_EQ(error_color(-1), (Color{0, 0, 0}));
  EXPECT_EQ(error_color(1), (Color{255, 247, 209}));
  EXPECT_EQ(error_color(3), error_color(1));
}

TEST(ErrorColors, OfAMap) {
  const Image8 picture = error_colors(FlipError{2, 1, {0, 1}, 0.5});
  EXPECT_EQ(picture.width, 2);
  EXPECT_EQ(picture.height, 1);
  EXPECT_EQ(picture.channels, 3);
  EXPECT_EQ(picture.values, (std::vector<std::uint8_t>{0, 0, 0, 255, 247, 209}));
}

}  // namespace
}  // namespace voxlume::test
