#include "denoise/wrls.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "denoise/test_frame.h"
#include "support/every_target.h"

namespace voxlume {
namespace {

using Vec4d = std::array<double, 4>;
using Mat4d = std::array<Vec4d, 4>;

/// Solves a x = b by Gauss elimination with pivots on the diagonal; a is symmetric and positive definite.
Vec4d solve(Mat4d a, Vec4d b) {
  for (int k = 0; k < 4; ++k) {
    for (int i = k + 1; i < 4; ++i) {
      const double f = a[i][k] / a[k][k];
      for (int j = k; j < 4; ++j) a[i][j] -= f * a[k][j];
      b[i] -= f * b[k];
    }
  }
  for (int k = 3; k >= 0; --k) {
    for (int j = k + 1; j < 4; ++j) b[k] -= a[k][j] * b[j];
    b[k] /= a[k][k];
  }
  return b;
}

/// The least pivot of P as [1, z / scale] has it, whose elements have no unit. Positive: positive definite.
double least_pivot(const WrlsModels& models, int x, int y, double scale) {
  Mat4d a;
  for (int i = 0, n = 0; i < 4; ++i) {
    for (int j = i; j < 4; ++j, ++n)
      a[i][j] = a[j][i] = models.p[n].at(x, y) * (i > 0 ? scale : 1) * (j > 0 ? scale : 1);
  }
  double least = a[0][0];
  for (int k = 0; k < 4; ++k) {
    least = std::min(least, a[k][k]);
    for (int i = k + 1; i < 4; ++i) {
      const double f = a[i][k] / a[k][k];
      for (int j = k; j < 4; ++j) a[i][j] -= f * a[k][j];
    }
  }
  return least;
}

Vec3d at(const Planes3& planes, int x, int y) {
  return {planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y)};
}

double norm(Vec3d v) { return std::sqrt(dot(v, v)); }

/// A frame with every value drawn by `draw()`, in all channels; alpha 1.
template <class Draw>
DenoiseFrame random_frame(int width, int height, Draw draw) {
  DenoiseFrame frame = test_frame(width, height, [](int, int) { return TestPixel{}; });
  for (Plane& plane : frame.radiance) {
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) plane.at(x, y) = static_cast<float>(draw());
    }
  }
  return frame;
}

class WithWeightsAndWithout : public testing::TestWithParam<bool> {};

TEST_P(WithWeightsAndWithout, CoefficientsSolveTheBatchProblem) {
  constexpr int kWidth = 21, kHeight = 3;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.2, 2.0);
  Wrls wrls({.weighted = GetParam()});
  DenoisedFrame out;
  std::vector<Mat4d> a(kWidth * kHeight);
  std::vector<std::array<Vec4d, 3>> b(kWidth * kHeight);
  for (int t = 0; t < 80; ++t) {
    const DenoiseFrame frame = random_frame(kWidth, kHeight, [&] { return uniform(random); });
    wrls.denoise(frame, out);
    for (int i = 0; i < kWidth * kHeight; ++i) {
      const int x = i % kWidth, y = i / kWidth;
      if (t == 0) {
        // What is known before the first frame: coefficients of 1 for the channel's own feature.
        const double of_feature = wrls.scale() * wrls.scale() / kWrlsFirstP;
        a[i] = {};
        for (int k = 0; k < 4; ++k) a[i][k][k] = k == 0 ? 1 / kWrlsFirstP : of_feature;
        for (int c = 0; c < 3; ++c) b[i][c] = {}, b[i][c][c + 1] = of_feature;
      }
      const Vec3d z = at(wrls.models().z, x, y), colour = at(frame.radiance, x, y);
      const double d = norm(colour - z) / (std::min(norm(colour), norm(z)) + kWrlsEpsilon * wrls.scale());
      const double w = GetParam() ? std::exp(-d * d / (kWrlsBandwidth * kWrlsBandwidth)) : 1;
      const Vec4d p{1, z.x, z.y, z.z};
      for (int j = 0; j < 4; ++j) {
        for (int k = 0; k < 4; ++k) a[i][j][k] = kWrlsForgetting * a[i][j][k] + w * p[j] * p[k];
        for (int c = 0; c < 3; ++c) b[i][c][j] = kWrlsForgetting * b[i][c][j] + w * p[j] * colour[c];
      }
      if (t != 0 && t != 9 && t != 79) continue;
      for (int c = 0; c < 3; ++c) {
        const Vec4d expected = solve(a[i], b[i][c]);
        for (int k = 0; k < 4; ++k)
          ASSERT_NEAR(wrls.models().beta[3 * k + c].at(x, y), expected[k], 2e-5) << t << ' ' << x << ' ' << y;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Rls, WithWeightsAndWithout, testing::Bool());

TEST(Wrls, PStaysPositiveDefiniteAndBounded) {
  constexpr int kWidth = 16, kHeight = 6;
  std::mt19937 random(5);
  std::lognormal_distribution<double> spiky(-2, 3);
  std::gamma_distribution<double> mild(4, 0.25);
  Wrls wrls({});
  DenoisedFrame out;
  const ThreadLimit one(1);
  DenoiseFrame frame = random_frame(kWidth, kHeight, [] { return 0.5; });
  for (int t = 0; t < 10000; ++t) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        // Rows of: no noise, darkness, noise, spikes, noise that now and then is off, a slow wave.
        const double v[] = {0.5,
                            0,
                            mild(random),
                            spiky(random),
                            t / 100 % 2 ? mild(random) : 1e-4,
                            1 + std::sin(t * 0.01 + x)};
        for (int c = 0; c < 3; ++c) frame.radiance[c].at(x, y) = static_cast<float>(v[y] * (1 + 0.1 * c));
      }
    }
    wrls.denoise(frame, out);
    if (t % 97 != 0 && t != 9999) continue;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        ASSERT_GT(least_pivot(wrls.models(), x, y, wrls.scale()), 0) << t << ' ' << x << ' ' << y;
        // The light of the frame, in which the limit is given, changes from frame to frame.
        const double limit = kWrlsFirstP * kWrlsLargestGrowth * 1.5;
        ASSERT_LT(wrls.models().p[0].at(x, y), limit);
        for (const int k : {4, 7, 9})
          ASSERT_LT(wrls.models().p[k].at(x, y) * wrls.scale() * wrls.scale(), limit) << t << ' ' << y;
      }
    }
  }
  for (int x = 0; x < kWidth; ++x) EXPECT_NEAR(out.radiance[0].at(x, 0), 0.5, 2e-4) << "no noise";
}

TEST(Wrls, FeatureIsTheHistoryClampedInYCoCgAndAQuarterOfTheFrame) {
  constexpr int kWidth = 37, kHeight = 5;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::array<DenoiseFrame, 2> frames;
  for (DenoiseFrame& frame : frames) {
    frame = random_frame(kWidth, kHeight, [&] { return uniform(random); });
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) frame.alpha.at(x, y) = static_cast<float>(0.5 + 0.5 * uniform(random));
    }
  }
  const auto ycocg = [](Vec3d c) {
    return Vec3d((c.x + 2 * c.y + c.z) / 4, (c.x - c.z) / 2, (2 * c.y - c.x - c.z) / 4);
  };
  test::for_every_target([&] {
    Wrls wrls({});
    DenoisedFrame out;
    wrls.denoise(frames[0], out);
    const Planes3 before = wrls.models().z;
    const Plane alpha_before = wrls.models().z_alpha;
    wrls.denoise(frames[1], out);
    const DenoiseFrame& now = frames[1];
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        Vec3d low(1e9), high(-1e9);
        double alpha_low = 1e9, alpha_high = -1e9;
        for (int row = std::max(y - 1, 0); row <= std::min(y + 1, kHeight - 1); ++row) {
          for (int column = std::max(x - 1, 0); column <= std::min(x + 1, kWidth - 1); ++column) {
            const Vec3d t = ycocg(at(now.radiance, column, row));
            for (int c = 0; c < 3; ++c) low[c] = std::min(low[c], t[c]), high[c] = std::max(high[c], t[c]);
            alpha_low = std::min<double>(alpha_low, now.alpha.at(column, row));
            alpha_high = std::max<double>(alpha_high, now.alpha.at(column, row));
          }
        }
        Vec3d t = ycocg(at(before, x, y));
        for (int c = 0; c < 3; ++c) t[c] = std::clamp(t[c], low[c], high[c]);
        const Vec3d z =
            Vec3d(t.x + t.y - t.z, t.x + t.z, t.x - t.y - t.z) * 0.75 + at(now.radiance, x, y) * 0.25;
        for (int c = 0; c < 3; ++c)
          ASSERT_NEAR(wrls.models().z[c].at(x, y), std::max(z[c], 0.0), 1e-6) << x << ' ' << y;
        const double alpha = 0.75 * std::clamp<double>(alpha_before.at(x, y), alpha_low, alpha_high) +
                             0.25 * now.alpha.at(x, y);
        ASSERT_NEAR(wrls.models().z_alpha.at(x, y), alpha, 1e-6);
      }
    }
  });
}

/// The spatial stage as docs/denoising.md has it, a pixel at a time.
void predict(const WrlsModels& models, double scale, int x, int y, Vec3d& radiance, double& alpha) {
  const auto guide = [&](int i, int j) {
    const Vec3d z = at(models.z, i, j);
    const double brightness = (z.x + 2 * z.y + z.z) / 4 + 0.05 * scale;
    return Vec4d{std::log(brightness), (z.x - z.z) / 2 / brightness, (2 * z.y - z.x - z.z) / 4 / brightness,
                 2 * models.z_alpha.at(i, j)};
  };
  const int d = models.p.size() == 1 ? 1 : 4;
  const double sigma2 = std::clamp<double>(models.spread.at(x, y), 0.03 * 0.03, 0.35 * 0.35);
  const Vec4d own = guide(x, y);
  double weights = 0;
  alpha = 0;
  std::array<double, 12> beta{};
  Vec3d z(0);
  for (int j = std::max(y - 2, 0); j <= std::min(y + 2, models.z_alpha.height() - 1); ++j) {
    for (int i = std::max(x - 2, 0); i <= std::min(x + 2, models.z_alpha.width() - 1); ++i) {
      const Vec4d other = guide(i, j);
      double distance = 0;
      for (int k = 0; k < 4; ++k) distance += (other[k] - own[k]) * (other[k] - own[k]);
      const double pixels = (i - x) * (i - x) + (j - y) * (j - y);
      const double w = std::exp(-pixels / (2 * 1.5 * 1.5) - distance / (2 * sigma2));
      weights += w;
      alpha += w * models.z_alpha.at(i, j);
      z += at(models.z, i, j) * w;
      for (int k = 0; k < 3 * d; ++k) beta[k] += w * models.beta[k].at(i, j);
    }
  }
  alpha /= weights;
  for (int c = 0; c < 3; ++c) {
    radiance[c] = beta[c] / weights;
    for (int k = 1; k < d; ++k) radiance[c] += beta[3 * k + c] / weights * z[k - 1] / weights;
    radiance[c] = std::max(radiance[c], 0.0);
  }
}

TEST(Wrls, SpatialStageBlendsModelsByHowAlikeTheirFeaturesAre) {
  constexpr int kWidth = 41, kHeight = 9;
  const auto islands = [](int x, int y) {
    TestPixel p;
    p.radiance = (x / 6 + y / 4) % 2 ? Vec3f(0.5f, 0.4f, 0.2f) : Vec3f(0.1f, 0.3f, 0.2f);
    if (x > 30) p.alpha = 0.5f, p.radiance *= 0.5f;
    if (y > 7) p.alpha = 0, p.radiance = Vec3f(0);
    return p;
  };
  for (const bool feature : {true, false}) {
    test::for_every_target([&] {
      Wrls wrls({.feature = feature});
      DenoisedFrame out;
      for (unsigned t = 1; t <= 4; ++t) wrls.denoise(test_frame(kWidth, kHeight, islands, 0.5, t), out);
      for (int y = 0; y < kHeight; ++y) {
        for (int x = 0; x < kWidth; ++x) {
          Vec3d radiance(0);
          double alpha = 0;
          predict(wrls.models(), wrls.scale(), x, y, radiance, alpha);
          for (int c = 0; c < 3; ++c)
            ASSERT_NEAR(out.radiance[c].at(x, y), radiance[c], 5e-5) << x << ' ' << y;
          ASSERT_NEAR(out.alpha.at(x, y), alpha, 1e-4);
        }
      }
    });
  }
}

TEST(Wrls, EnormousSamplesBreakNothingAndAreForgotten) {
  constexpr int kWidth = 40, kHeight = 12;
  const auto grey = [](int, int) { return TestPixel{}; };
  const Planes3 exact = test_frame(kWidth, kHeight, grey).radiance;
  for (const bool weighted : {true, false}) {
    Wrls wrls({.weighted = weighted});
    DenoisedFrame out;
    for (int t = 0; t < 400; ++t) {
      DenoiseFrame frame = test_frame(kWidth, kHeight, grey);
      if (t == 5) {
        frame.radiance[0].at(20, 6) = 3e38f;
        frame.radiance[1].at(7, 0) = frame.radiance[1].at(8, 0) = 1e20f;
      }
      wrls.denoise(frame, out);
      for (const Plane& plane : wrls.models().beta) ASSERT_TRUE(std::isfinite(plane.at(20, 6))) << t;
      ASSERT_GT(least_pivot(wrls.models(), 20, 6, wrls.scale()), 0) << t;
    }
    // Without weights, one sample of a million times the light outweighs all frames after it.
    if (weighted) {
      EXPECT_LT(difference(out.radiance, exact), 1e-3);
    }
  }
}

}  // namespace
}  // namespace voxlume
