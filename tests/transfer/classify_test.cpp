#include <gtest/gtest.h>

#include "support/transfers.h"
#include "transfer/transfer_function.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::mu_t_function;
using test::opacity_function;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

Color linear(float r, float g, float b) { return {{r, g, b}}; }

/// mu_t of an opacity by the convention of the scene file.
double extinction(double opacity, double reference_mm) {
  return -std::log1p(-std::min(opacity, 0.9999)) / reference_mm;
}

/// Compares a compiled opacity curve with the convention at random values over its domain.
void expect_converts(const CurvePoints& points, double reference_mm) {
  const TransferFunction function(opacity_function(points, reference_mm));
  Rng rng(1, 0, 0, 0);
  const double lower = points.front().first, width = points.back().first - lower;
  for (int n = 0; n < 20000; ++n) {
    const auto value =
        static_cast<float>(lower - 0.1 * width + 1.2 * width * static_cast<double>(rng.next()));
    const double expected = extinction(test::curve_at(points, value), reference_mm);
    ASSERT_NEAR(classify_mu_t(function.view(), value), expected, 2e-4 * expected) << "at " << value;
  }
}

TEST(OpacityToExtinction, FollowsTheLogarithm) {
  expect_converts({{0, 0}, {100, 1}}, 1.0);
  expect_converts({{-1024, 0}, {-500, 0.02}, {100, 0.3}, {400, 0.95}, {3071, 0.99}}, 1.0);
  expect_converts({{0, 0.9}, {1, 0.1}, {2, 0.9999}}, 0.37);
  expect_converts({{0, 1}, {65535, 0}}, 250.0);
  expect_converts({{0, 0.99985}, {1, 1}}, 1.0);
}

TEST(OpacityToExtinction, HoldsUpToSaturation) {
  // mu_t has a kink where the opacity passes 0.9999.
  Rng rng(2, 0, 0, 0);
  for (int n = 0; n < 40; ++n) {
    const double saturated = 0.9999 + 0.0001 * static_cast<double>(rng.next());
    const double start = n % 2 ? rng.next() : 1 - 0.002 * rng.next();
    expect_converts({{0, start}, {0.1 + rng.next(), saturated}, {3, 0.5}}, 1.0);
  }
}

TEST(OpacityToExtinction, HoldsWhereFloatsAreSparse) {
  // 256 floats between the points: data such as CT numbers with an offset, or microscopy counts.
  expect_converts({{30000, 0.1}, {30000.5, 0.9}}, 1.0);
  expect_converts({{16000000, 0.05}, {16000100, 0.98}}, 1.0);
}

TEST(OpacityToExtinction, IsTheConvention) {
  EXPECT_EQ(mu_t_from_opacity(0, 1), 0.0);
  EXPECT_NEAR(mu_t_from_opacity(0.5, 2), 0.34657359027997264, 1e-15);
  EXPECT_NEAR(mu_t_from_opacity(1, 1), 9.210340371976182, 1e-10);
  EXPECT_EQ(mu_t_from_opacity(0.9999, 1), mu_t_from_opacity(1, 1));
}

TEST(OpacityToExtinction, DensityScaleMultiplies) {
  TransferDescription d = opacity_function({{0, 0.1}, {10, 0.8}}, 2.0);
  const TransferFunction plain(d);
  d.density_scale = 3;
  const TransferFunction scaled(d);
  d.density_scale = 0;
  const TransferFunction none(d);
  for (float v = -1; v < 11; v += 0.125f) {
    EXPECT_FLOAT_EQ(classify_mu_t(scaled.view(), v), 3 * classify_mu_t(plain.view(), v));
    EXPECT_EQ(classify_mu_t(none.view(), v), 0.0f);
    // The opacity that modulates the surface share is the curve's, whatever the density.
    EXPECT_NEAR(opacity_of(scaled.view(), classify(scaled.view(), v).mu_t),
                test::curve_at({{0, 0.1}, {10, 0.8}}, v), 2e-4);
  }
}

TEST(Classify, OpacityFollowsFromExtinction) {
  const TransferFunction function(mu_t_function({{0, 0}, {10, 4}}));
  for (float v = 0.5f; v < 12; v += 0.5f)
    EXPECT_NEAR(opacity_of(function.view(), classify(function.view(), v).mu_t),
                1 - std::exp(-0.4 * std::min(v, 10.0f)), 1e-6);
}

TEST(Classify, StepsTakeTheUpperLimit) {
  const TransferFunction function(mu_t_function({{0, 1}, {10, 3}, {10, 8}, {20, 6}}));
  const TransferView view = function.view();
  EXPECT_FLOAT_EQ(classify_mu_t(view, std::nextafter(10.0f, 0.0f)), 3.0f);
  EXPECT_EQ(classify_mu_t(view, 10.0f), 8.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(view, std::nextafter(10.0f, 20.0f)), 8.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(view, 5.0f), 2.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(view, 15.0f), 7.0f);
}

TEST(Classify, StepsAtTheEnds) {
  const TransferFunction function(mu_t_function({{0, 1}, {0, 2}, {10, 3}, {10, 4}}));
  EXPECT_EQ(classify_mu_t(function.view(), -1e-30f), 1.0f);
  EXPECT_EQ(classify_mu_t(function.view(), 0.0f), 2.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(function.view(), 9.999999f), 3.0f);
  EXPECT_EQ(classify_mu_t(function.view(), 10.0f), 4.0f);
}

TEST(Classify, ManyPointsAtOneValueKeepTheOuterTwo) {
  const TransferFunction function(mu_t_function({{0, 1}, {5, 1}, {5, 70}, {5, 80}, {5, 2}, {9, 2}}));
  EXPECT_FLOAT_EQ(classify_mu_t(function.view(), 4.9999995f), 1.0f);
  EXPECT_EQ(classify_mu_t(function.view(), 5.0f), 2.0f);
}

TEST(Classify, ValuesThatAreOneFloatAreAStep) {
  const TransferFunction function(mu_t_function({{0, 0}, {1000, 0}, {1000.00001, 1}, {2000, 1}}));
  EXPECT_EQ(classify_mu_t(function.view(), 999.0f), 0.0f);
  EXPECT_EQ(classify_mu_t(function.view(), 1001.0f), 1.0f);
  EXPECT_EQ(classify_mu_t(function.view(), 1500.0f), 1.0f);
  const TransferFunction opacity(opacity_function({{0, 0}, {1000, 0}, {1000.00001, 0.5}, {2000, 0.5}}, 1.0));
  EXPECT_NEAR(classify_mu_t(opacity.view(), 1001.0f), std::log(2.0), 1e-5);
}

TEST(Classify, IsConstantOutsideThePoints) {
  const TransferFunction function(mu_t_function({{-5, 0.5}, {5, 2}}));
  for (const float v : {-5.0f, -6.0f, -1e30f, -std::numeric_limits<float>::max()})
    EXPECT_EQ(classify_mu_t(function.view(), v), 0.5f);
  for (const float v : {5.0f, 6.0f, 1e30f, std::numeric_limits<float>::max()})
    EXPECT_EQ(classify_mu_t(function.view(), v), 2.0f);
}

TEST(Classify, NaNIsTransparent) {
  const TransferFunction function(mu_t_function({{-5, 0.5}, {5, 2}}));
  EXPECT_EQ(classify_mu_t(function.view(), kNaN), 0.0f);
  EXPECT_EQ(classify(function.view(), kNaN).mu_t, 0.0f);
  for (const float v : {kInfinity, -kInfinity}) {
    const float mu_t = classify_mu_t(function.view(), v);
    EXPECT_TRUE(mu_t >= 0 && mu_t <= 2);
  }
}

TEST(Classify, OnePoint) {
  const TransferFunction function(mu_t_function({{7, 1.5}}));
  for (const float v : {-1e30f, 6.9f, 7.0f, 7.1f, 1e30f}) EXPECT_EQ(classify_mu_t(function.view(), v), 1.5f);
  EXPECT_EQ(function.max_mu_t(), 1.5f);
}

TEST(Classify, NoPointsIsTransparentAndGrey) {
  const TransferFunction function(mu_t_function({}));
  for (const float v : {-1e30f, 0.0f, 7.0f, kNaN}) EXPECT_EQ(classify_mu_t(function.view(), v), 0.0f);
  EXPECT_EQ(function.max_mu_t(), 0.0f);
  const TransferFunction opaque(mu_t_function({{0, 1}}));
  EXPECT_EQ(classify(opaque.view(), 3).albedo, Vec3f(0.8f));
  EXPECT_EQ(classify(opaque.view(), 3).emission, Vec3f(0));
}

TEST(Classify, ColoursAreInterpolatedLinearlyBetweenTheirOwnPoints) {
  TransferDescription d = mu_t_function({{0, 1}, {4, 1}, {6, 1}, {10, 1}});
  d.points[0].color = linear(0.1f, 0.5f, 1.0f);
  d.points[3].color = linear(0.9f, 0.5f, 0.0f);
  d.points[1].emission = linear(0, 2, 8);
  d.points[2].emission = linear(4, 2, 0);
  const TransferFunction function(d);
  for (float v = -2; v < 12; v += 0.0625f) {
    const Coefficients c = classify(function.view(), v);
    const float t = std::clamp(v / 10, 0.0f, 1.0f), e = std::clamp((v - 4) / 2, 0.0f, 1.0f);
    const Vec3f albedo(0.1f + 0.8f * t, 0.5f, 1 - t), emission(4 * e, 2, 8 - 8 * e);
    for (int a = 0; a < 3; ++a) {
      ASSERT_NEAR(c.albedo[a], albedo[a], 1e-6) << v;
      ASSERT_NEAR(c.emission[a], emission[a], 1e-5) << v;
    }
  }
}

TEST(Classify, ColourSteps) {
  TransferDescription d = mu_t_function({{0, 1}, {5, 1}, {5, 1}, {9, 1}});
  for (int i = 0; i < 4; ++i)
    d.points[static_cast<std::size_t>(i)].color = i < 2 ? linear(1, 0, 0) : linear(0, 0, 1);
  const TransferFunction function(d);
  EXPECT_EQ(classify(function.view(), 4.9f).albedo, Vec3f(1, 0, 0));
  EXPECT_EQ(classify(function.view(), 5.0f).albedo, Vec3f(0, 0, 1));
}

TEST(Classify, AlbedoAndEmissionStayInRange) {
  TransferDescription d = mu_t_function({{0, 1}, {1e-3, 1}, {3e4, 1}, {3e4 + 0.01, 1}});
  Rng rng(4, 0, 0, 0);
  for (std::size_t i = 0; i < 4; ++i) {
    d.points[i].color = linear(i % 2 ? 1.0f : 0.0f, 1, 0);
    d.points[i].emission = linear(i % 2 ? 100.0f : 0.0f, 0, 0);
  }
  const TransferFunction function(d);
  for (int n = 0; n < 20000; ++n) {
    const Coefficients c = classify(function.view(), n % 2 ? 3e4f + rng.next() * 0.02f : rng.next() * 2e-3f);
    for (int a = 0; a < 3; ++a) ASSERT_TRUE(c.albedo[a] >= 0 && c.albedo[a] <= 1 && c.emission[a] >= 0);
    const float opacity = opacity_of(function.view(), c.mu_t);
    ASSERT_TRUE(opacity >= 0 && opacity < 1);
  }
}

TEST(FindPiece, IsTheLastThatStartsAtOrBelowTheValue) {
  Rng rng(5, 0, 0, 0);
  for (int n = 0; n < 60; ++n) {
    const double scale = std::pow(10.0, n % 12 - 4);
    const TransferFunction function(
        mu_t_function(test::random_curve(-scale, 2 * scale, 1.0, 1 + n * 3, rng)));
    const TransferView view = function.view();
    std::vector<float> values{kInfinity, -kInfinity, 3e38f, -3e38f, 0.0f, 1e-45f};
    for (int i = 1; i < view.piece_count; ++i) {
      const float start = view.pieces[i].start;
      values.insert(values.end(),
                    {start, std::nextafter(start, kInfinity), std::nextafter(start, -kInfinity)});
    }
    for (int i = 0; i < 500; ++i) values.push_back(static_cast<float>((rng.next() * 5 - 2) * scale));
    for (const float v : values) {
      int expected = 0;
      for (int i = 0; i < view.piece_count; ++i)
        if (view.pieces[i].start <= v) expected = i;
      ASSERT_EQ(&find_piece(view, v) - view.pieces, expected) << v << " at scale " << scale;
    }
    const std::ptrdiff_t of_nan = &find_piece(view, kNaN) - view.pieces;
    ASSERT_TRUE(of_nan >= 0 && of_nan < view.piece_count);
  }
}

TEST(FindPiece, ExtremePoints) {
  const TransferFunction wide(mu_t_function({{-3e38, 1}, {0, 2}, {3e38, 5}}));
  EXPECT_FLOAT_EQ(classify_mu_t(wide.view(), -3e38f), 1.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(wide.view(), 0.0f), 2.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(wide.view(), 1.5e38f), 3.5f);
  const TransferFunction narrow(mu_t_function({{0, 1}, {1e-44, 5}}));
  EXPECT_FLOAT_EQ(classify_mu_t(narrow.view(), -1.0f), 1.0f);
  EXPECT_FLOAT_EQ(classify_mu_t(narrow.view(), 1.0f), 5.0f);
}

}  // namespace
}  // namespace voxlume
