#include "denoise/svgf.h"

#include <gtest/gtest.h>

#include "denoise/gradient.h"
#include "denoise/temporal.h"
#include "denoise/test_frame.h"
#include "support/every_target.h"

namespace voxlume {
namespace {

using test::for_every_target;

constexpr int kWidth = 101, kHeight = 67;

TestPixel grey(int, int) { return {}; }

/// TemporalHistory without any filter in space.
class Accumulation {
 public:
  const Signal& add(const DenoiseFrame& frame, const Plane* change = nullptr) {
    make_guides(frame, guides_);
    colors_.resize(frame.width, frame.height);
    history_.blend(frame, guides_, colors_, change, out_);
    history_.keep(frame, guides_);
    std::swap(colors_, out_);
    return colors_;
  }
  const TemporalHistory& history() const { return history_; }

 private:
  Guides guides_;
  TemporalHistory history_;
  Signal colors_, out_;
};

TEST(TemporalHistory, NoiseFallsAsTheWeightsSay) {
  const Planes3 exact = test_frame(kWidth, kHeight, grey).radiance;
  Accumulation accumulation;
  double expected = 0;
  for (int n = 1; n <= 12; ++n) {
    const DenoiseFrame frame = test_frame(kWidth, kHeight, grey, 0.5, static_cast<unsigned>(n));
    const Signal& blended = accumulation.add(frame);
    const double weight = std::max(0.2, 1.0 / n);
    expected = weight * weight + (1 - weight) * (1 - weight) * expected;
    const double measured =
        std::pow(difference(blended.radiance, exact) / difference(frame.radiance, exact), 2);
    // 6767 pixels: a standard error of some 2 %.
    EXPECT_NEAR(measured, expected, 0.08 * expected) << n;
  }
  EXPECT_NEAR(expected, 1.0 / 9, 0.01) << "w / (2 - w)";
}

TEST(TemporalHistory, CountsUpToThirtyTwoFrames) {
  for_every_target([] {
    const DenoiseFrame frame = test_frame(kWidth, kHeight, grey);
    Accumulation accumulation;
    for (int n = 1; n <= 40; ++n) {
      accumulation.add(frame);
      ASSERT_NEAR(accumulation.history().means().frames.at(50, 30), std::min(n, 32), 1e-3);
    }
  });
}

TEST(TemporalHistory, FindsTheVarianceOfItsMean) {
  for_every_target([] {
    // Of the mean of four samples, each with a deviation of half the luminance.
    const double exact = 0.25 * 0.25 / 4;
    Accumulation accumulation;
    for (unsigned n = 1; n <= 12; ++n) {
      const Signal& blended = accumulation.add(test_frame(kWidth, kHeight, grey, 0.5, n));
      if (n != 1 && n != 12) continue;
      double mean = 0;
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) mean += blended.variance.at(x, y) / (kWidth * kHeight);
      }
      // A first frame has 7 x 7 pixels and a factor of 4. A mean over time is worth nine frames, and its own
      // noise is missing in what frames differ from it by: 8 / 9 of the variance are seen.
      const double expected = n == 1 ? 4 * exact : exact * (8.0 / 9) / 9;
      EXPECT_NEAR(mean, expected, 0.1 * expected) << n;
    }
  });
}

TEST(TemporalHistory, BeginsAnewWhereOtherMatterShows) {
  for_every_target([] {
    const auto wall = [](float moved) {
      return [moved](int x, int) {
        TestPixel p;
        if (x >= 30 && x < 60) p.depth_mm -= moved;
        if (x >= 70) p.normal = moved > 0 ? Vec3f(1, 0, 0) : Vec3f(0, -1, 0);
        return p;
      };
    };
    Accumulation accumulation;
    for (int n = 0; n < 5; ++n) accumulation.add(test_frame(kWidth, kHeight, wall(0)));
    accumulation.add(test_frame(kWidth, kHeight, wall(100)));
    const Plane& frames = accumulation.history().means().frames;
    EXPECT_NEAR(frames.at(15, 30), 6, 1e-3);
    EXPECT_EQ(frames.at(45, 30), 1) << "nearer";
    EXPECT_EQ(frames.at(85, 30), 1) << "turned";
  });
}

/// The plane through the target that faces azimuth 0, with a pattern that stays with it, as a camera turned
/// by `azimuth_deg` sees it.
DenoiseFrame turned_plane(double azimuth_deg, double sigma, unsigned seed) {
  const CameraView view = test_camera(kWidth, kHeight, azimuth_deg);
  const Vec3f normal = test_camera(kWidth, kHeight).forward;
  const auto pixel = [&](int x, int y) {
    const CameraRay ray = camera_ray(view, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 0);
    TestPixel p;
    p.depth_mm = dot(view.target_mm - ray.origin, normal) / dot(ray.direction, normal);
    const Vec3f at = ray.origin + ray.direction * p.depth_mm;
    p.radiance = Vec3f(0.5f + 0.2f * std::sin(at.x / 12) * std::cos(at.z / 15));
    p.normal = normal * -1.0f;
    return p;
  };
  return test_frame(kWidth, kHeight, pixel, sigma, seed, 4, azimuth_deg);
}

TEST(Svgf, FollowsATexturedPlaneAsTheCameraTurns) {
  const std::unique_ptr<Denoiser> svgf = make_svgf();
  DenoisedFrame out;
  for (int i = 0; i < 10; ++i) svgf->denoise(turned_plane(9 - i, 0.5, static_cast<unsigned>(i)), out);
  const Planes3 exact = turned_plane(0, 0, 1).radiance;
  const double with_history = difference(out.radiance, exact);
  svgf->forget();
  svgf->denoise(turned_plane(0, 0.5, 9), out);
  EXPECT_LT(with_history, 0.8 * difference(out.radiance, exact));
}

TEST(Svgf, DoesNotCrossEdgesOfDepth) {
  const auto near_and_far = [](int x, int) {
    return TestPixel{.radiance = Vec3f(x < 50 ? 1.0f : 0.8f), .depth_mm = x < 50 ? 400.0f : 600.0f};
  };
  const DenoiseFrame frame = test_frame(kWidth, kHeight, near_and_far, 0, 1, 1000);
  const std::unique_ptr<Denoiser> svgf = make_svgf();
  DenoisedFrame out;
  for (int i = 0; i < 6; ++i) svgf->denoise(frame, out);
  EXPECT_LT(difference(out.radiance, frame.radiance), 1e-3);
}

/// Half of the pixels, by chance, have no sample that scattered.
TestPixel translucent(int x, int y) {
  TestPixel p;
  if ((x * 7919 + y * 104729) % 17 < 8) p.alpha = 0, p.radiance = Vec3f(0);
  return p;
}

TEST(Svgf, TranslucentMatterKeepsItsColour) {
  const std::unique_ptr<Denoiser> svgf = make_svgf();
  DenoisedFrame out;
  for (int i = 0; i < 3; ++i) svgf->denoise(test_frame(kWidth, kHeight, translucent), out);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x)
      ASSERT_NEAR(out.radiance[0].at(x, y), 0.5f * out.alpha.at(x, y), 1e-4f) << "of any opacity";
  }
}

/// Gives the frame samples of how its light has changed from `before` times what it is now.
void add_gradients(DenoiseFrame& frame, float before) {
  const Plane strata((kWidth + 2) / 3, (kHeight + 2) / 3);
  frame.gradients = {strata, strata, strata};
  for (int y = 0; y < strata.height(); ++y) {
    for (int x = 0; x < strata.width(); ++x) {
      const float now = frame.radiance[0].at(std::min(3 * x, kWidth - 1), std::min(3 * y, kHeight - 1));
      frame.gradients->now.at(x, y) = now;
      frame.gradients->before.at(x, y) = before * now;
      frame.gradients->valid.at(x, y) = (x + y) % 4 != 0;
    }
  }
}

/// Frames until a step of brightness is 90 % done.
int frames_to_follow(Denoiser& denoiser) {
  const auto lit = [](float light) {
    return [light](int, int) { return TestPixel{.radiance = Vec3f(light)}; };
  };
  DenoisedFrame out;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    DenoiseFrame frame = test_frame(kWidth, kHeight, lit(0.8f), 0.3, seed);
    add_gradients(frame, 1);
    denoiser.denoise(frame, out);
  }
  const Planes3 exact = test_frame(kWidth, kHeight, lit(0.2f)).radiance;
  for (unsigned n = 1; n < 40; ++n) {
    DenoiseFrame frame = test_frame(kWidth, kHeight, lit(0.2f), 0.3, 100 + n);
    add_gradients(frame, n == 1 ? 4.0f : 1.0f);
    denoiser.denoise(frame, out);
    if (difference(out.radiance, exact) < 0.1 * (0.8 - 0.2)) return static_cast<int>(n);
  }
  return 40;
}

TEST(ASvgf, FollowsAStepSoonerThanSvgf) {
  const int svgf = frames_to_follow(*make_svgf()), asvgf = frames_to_follow(*make_asvgf());
  EXPECT_GE(svgf, 8) << "0.8^n < 0.1 takes eleven, or fewer with luck";
  EXPECT_LE(asvgf, 5) << "0.25 * 0.8^n < 0.1: three quarters are forgotten at once";
}

TEST(ASvgf, IsSvgfWithoutGradientsAndWhereNothingChanges) {
  const std::unique_ptr<Denoiser> svgf = make_svgf(), asvgf = make_asvgf(), still = make_asvgf();
  DenoisedFrame a, b, c;
  for (unsigned seed = 1; seed < 5; ++seed) {
    DenoiseFrame frame = test_frame(kWidth, kHeight, translucent, 0.5, seed);
    svgf->denoise(frame, a);
    asvgf->denoise(frame, b);
    add_gradients(frame, 1);
    still->denoise(frame, c);
  }
  EXPECT_EQ(difference(a.radiance, b.radiance), 0);
  EXPECT_LT(difference(a.radiance, c.radiance), 1e-6);
}

TEST(TemporalGradient, StaysOnItsSideOfADepthEdge) {
  for_every_target([] {
    const auto near_and_far = [](int x, int) { return TestPixel{.depth_mm = x < 51 ? 300.0f : 700.0f}; };
    DenoiseFrame frame = test_frame(kWidth, kHeight, near_and_far, 0, 1, 1000);
    add_gradients(frame, 1);
    for (int y = 0; y < frame.gradients->before.height(); ++y) {
      for (int x = 17; x < frame.gradients->before.width(); ++x) frame.gradients->before.at(x, y) *= 2;
    }
    Guides guides;
    make_guides(frame, guides);
    TemporalGradient gradient;
    const Plane& change = gradient(frame, guides);
    for (int y = 0; y < change.height(); ++y) {
      for (int x = 0; x < change.width(); ++x) {
        // The largest of 3 x 3 reaches over the edge by one.
        if (x != 16) {
          ASSERT_NEAR(change.at(x, y), x < 16 ? 0 : 0.5f, 0.02f) << x << ' ' << y;
        }
      }
    }
  });
}

}  // namespace
}  // namespace voxlume
