// What every denoiser promises.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "base/parallel.h"
#include "denoise/denoiser.h"
#include "denoise/test_frame.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr int kWidth = 75, kHeight = 53;

class EveryDenoiser : public testing::TestWithParam<DenoiserKind> {
 protected:
  void SetUp() override {
    try {
      denoiser_ = GetParam().make();
    } catch (const Error& e) {
      if (e.code() != ErrorCode::kUnsupported) throw;
      GTEST_SKIP() << e.what();
    }
  }
  std::unique_ptr<Denoiser> denoiser_;
  DenoisedFrame out_;
};

/// Two surfaces, one before the other, and nothing around them.
TestPixel two_surfaces(int x, int y) {
  TestPixel p;
  const bool left = x < kWidth / 2;
  p.radiance = left ? Vec3f(0.6f, 0.4f, 0.3f) : Vec3f(0.15f, 0.2f, 0.3f);
  p.albedo = left ? Vec3f(0.9f, 0.6f, 0.5f) : Vec3f(0.3f, 0.4f, 0.6f);
  p.depth_mm = left ? 480 : 560;
  p.normal = left ? Vec3f(0, -1, 0) : Vec3f(0.6f, -0.8f, 0);
  if (y < 4 || y >= kHeight - 4) p.alpha = 0, p.radiance = Vec3f(0);
  return p;
}

TEST_P(EveryDenoiser, LeavesAConstantPictureAsItIs) {
  if (GetParam().name == "oidn") GTEST_SKIP() << "a network's means are near those of its input, not equal";
  const auto constant = [](int, int) { return TestPixel{}; };
  for (int frame = 0; frame < 3; ++frame) {
    denoiser_->denoise(test_frame(kWidth, kHeight, constant), out_);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(out_.radiance[c].at(x, y), 0.5f, 1e-4f) << x << ' ' << y;
        ASSERT_NEAR(out_.alpha.at(x, y), 1, 1e-5f);
      }
    }
  }
}

TEST_P(EveryDenoiser, TakesNoiseAwayFromOneFrameAndMoreFromSeveral) {
  const Planes3 exact = test_frame(kWidth, kHeight, two_surfaces).radiance;
  const DenoiseFrame last = test_frame(kWidth, kHeight, two_surfaces, 0.7, 1);
  const double noisy = difference(last.radiance, exact);
  denoiser_->denoise(last, out_);
  const double one = difference(out_.radiance, exact);
  EXPECT_LT(one, noisy / 2) << "from one frame";
  denoiser_->forget();
  for (unsigned seed = 2; seed < 20; ++seed)
    denoiser_->denoise(test_frame(kWidth, kHeight, two_surfaces, 0.7, seed), out_);
  denoiser_->denoise(last, out_);
  EXPECT_LT(difference(out_.radiance, exact), one * 1.02) << "from twenty, the same one last";
}

TEST_P(EveryDenoiser, DoesNotDependOnTheNumberOfThreads) {
  DenoisedFrame other;
  const std::unique_ptr<Denoiser> twin = GetParam().make();
  for (unsigned seed = 1; seed < 4; ++seed) {
    const DenoiseFrame frame = test_frame(kWidth, kHeight, two_surfaces, 0.7, seed, 4, seed);
    {
      const ThreadLimit one(1);
      denoiser_->denoise(frame, out_);
    }
    const ThreadLimit three(3);
    twin->denoise(frame, other);
    ASSERT_EQ(difference(out_.radiance, other.radiance), 0);
  }
}

TEST_P(EveryDenoiser, ForgetsWhenToldAndWhenTheSizeChanges) {
  const DenoiseFrame frame = test_frame(kWidth, kHeight, two_surfaces, 0.7, 5);
  DenoisedFrame fresh;
  GetParam().make()->denoise(frame, fresh);

  const auto dark = [](int, int) { return TestPixel{.radiance = Vec3f(0.01f)}; };
  denoiser_->denoise(test_frame(kWidth, kHeight, dark), out_);
  denoiser_->forget();
  denoiser_->denoise(frame, out_);
  EXPECT_EQ(difference(out_.radiance, fresh.radiance), 0) << "told";

  denoiser_->denoise(test_frame(kWidth - 7, kHeight + 9, dark), out_);
  EXPECT_EQ(out_.alpha.width(), kWidth - 7);
  denoiser_->denoise(frame, out_);
  EXPECT_EQ(difference(out_.radiance, fresh.radiance), 0) << "another size";
}

TEST_P(EveryDenoiser, KeepsBrightMatterOutOfEmptyPixels) {
  denoiser_->denoise(test_frame(kWidth, kHeight, two_surfaces, 0.7, 1), out_);
  for (int x = 0; x < kWidth; ++x) {
    for (const int y : {0, kHeight - 1}) {
      EXPECT_NEAR(out_.alpha.at(x, y), 0, 1e-4f) << x << ' ' << y;
      for (int c = 0; c < 3; ++c) EXPECT_NEAR(out_.radiance[c].at(x, y), 0, 1e-3f);
    }
  }
}

TEST_P(EveryDenoiser, FollowsAStepOfBrightness) {
  // Means over 500 frames are there to show what is missed without a feature (iglesias2020 Fig. 8).
  if (GetParam().name.ends_with("-no-feature")) GTEST_SKIP() << "follows in 500 frames";
  const auto bright = [](int, int) { return TestPixel{.radiance = Vec3f(0.8f)}; };
  const auto dark = [](int, int) { return TestPixel{.radiance = Vec3f(0.08f)}; };
  for (unsigned seed = 1; seed < 12; ++seed)
    denoiser_->denoise(test_frame(kWidth, kHeight, bright, 0.5, seed), out_);
  for (unsigned seed = 12; seed < 42; ++seed)
    denoiser_->denoise(test_frame(kWidth, kHeight, dark, 0.5, seed), out_);
  const Planes3 exact = test_frame(kWidth, kHeight, dark).radiance;
  EXPECT_LT(difference(out_.radiance, exact), 0.1 * (0.8 - 0.08)) << "90 % of the way after 30 frames";
}

TEST_P(EveryDenoiser, ScalesWithTheLight) {
  const auto lit = [](float factor) {
    return [factor](int x, int y) {
      TestPixel p = two_surfaces(x, y);
      p.radiance *= factor;
      return p;
    };
  };
  const Planes3 exact = test_frame(kWidth, kHeight, two_surfaces).radiance;
  for (const float factor : {0x1p10f, 0x1p27f, 0x1p-27f}) {
    DenoisedFrame other;
    const std::unique_ptr<Denoiser> one = GetParam().make(), twin = GetParam().make();
    for (unsigned seed = 1; seed < 5; ++seed) {
      one->denoise(test_frame(kWidth, kHeight, lit(1), 0.7, seed), out_);
      twin->denoise(test_frame(kWidth, kHeight, lit(factor), 0.7, seed), other);
    }
    for (Plane& plane : other.radiance) {
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) plane.at(x, y) /= factor;
      }
    }
    EXPECT_LT(difference(out_.radiance, other.radiance),
              0.02 * difference(exact, make_planes3(kWidth, kHeight)))
        << factor;
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, EveryDenoiser, testing::ValuesIn(denoiser_kinds()), [](const auto& kind) {
  std::string name(kind.param.name);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});
GTEST_ALLOW_UNINSTANTIATED_PARAMETERIZED_TEST(EveryDenoiser);

TEST(Denoisers, UnknownNamesAreRefusedWithTheKnownOnes) {
  try {
    find_denoiser("blur");
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::kBadParameter);
    for (const DenoiserKind& kind : denoiser_kinds())
      EXPECT_THAT(e.what(), testing::HasSubstr(std::string(kind.name)));
  }
}

}  // namespace
}  // namespace voxlume
