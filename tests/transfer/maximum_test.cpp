#include <gtest/gtest.h>

#include "support/transfers.h"
#include "transfer/transfer_function.h"

namespace voxlume {
namespace {

using test::CurvePoints;
using test::mu_t_function;

/// Looks mu_t up in [lower, upper]: on a grid, at the knots and at their neighbours.
template <class Visit>
void visit_look_ups(const TransferView& view, const CurvePoints& points, float lower, float upper,
                    Visit&& visit) {
  const auto look = [&](float v) {
    if (v >= lower && v <= upper) visit(classify_mu_t(view, v));
  };
  look(lower);
  look(upper);
  for (int i = 1; i < 64; ++i) look(lower + (upper - lower) * static_cast<float>(i) / 64);
  for (const auto& point : points) {
    const auto v = static_cast<float>(point.first);
    look(v);
    look(std::nextafter(v, 1e38f));
    look(std::nextafter(v, -1e38f));
  }
}

float greatest_look_up(const TransferView& view, const CurvePoints& points, float lower, float upper) {
  float greatest = 0;
  visit_look_ups(view, points, lower, upper, [&](float mu_t) { greatest = std::max(greatest, mu_t); });
  return greatest;
}

float least_look_up(const TransferView& view, const CurvePoints& points, float lower, float upper) {
  float least = std::numeric_limits<float>::infinity();
  visit_look_ups(view, points, lower, upper, [&](float mu_t) { least = std::min(least, mu_t); });
  return least;
}

TEST(MaxMuT, IsTheAnalyticSupremum) {
  Rng rng(11, 0, 0, 0);
  for (int f = 0; f < 200; ++f) {
    const double scale = std::pow(10.0, f % 7 - 2);
    const CurvePoints points = test::random_curve(-scale, scale, 20.0, 1 + f % 60, rng);
    const TransferFunction function(mu_t_function(points));
    for (int n = 0; n < 60; ++n) {
      auto lower = static_cast<float>((2.4 * static_cast<double>(rng.next()) - 1.2) * scale);
      auto upper = static_cast<float>((2.4 * static_cast<double>(rng.next()) - 1.2) * scale);
      if (n % 5 == 1) upper = lower;
      if (n % 5 == 2) lower = static_cast<float>(points[static_cast<std::size_t>(n) % points.size()].first);
      if (n % 5 == 3) upper = static_cast<float>(points[static_cast<std::size_t>(n) % points.size()].first);
      if (lower > upper) std::swap(lower, upper);
      const float maximum = function.max_mu_t(lower, upper);
      ASSERT_GE(maximum, greatest_look_up(function.view(), points, lower, upper)) << lower << " " << upper;
      // Coefficients are floats: the value of a piece rounds relative to its greatest end.
      ASSERT_NEAR(maximum, test::curve_maximum(points, lower, upper), 80 * 4 * 1.2e-7)
          << lower << " " << upper;
    }
  }
}

TEST(MinMuT, IsTheAnalyticInfimumAndHoldsEveryLookUp) {
  Rng rng(13, 0, 0, 0);
  for (int f = 0; f < 200; ++f) {
    const double scale = std::pow(10.0, f % 7 - 2);
    const CurvePoints points = test::random_curve(-scale, scale, 20.0, 1 + f % 60, rng);
    const TransferFunction function(mu_t_function(points));
    for (int n = 0; n < 60; ++n) {
      auto lower = static_cast<float>((2.4 * static_cast<double>(rng.next()) - 1.2) * scale);
      auto upper = n % 5 == 1
                       ? lower
                       : lower + static_cast<float>(scale * std::pow(static_cast<double>(rng.next()), 4));
      if (n % 5 == 3) upper = static_cast<float>(points[static_cast<std::size_t>(n) % points.size()].first);
      if (lower > upper) std::swap(lower, upper);
      const float minimum = function.min_mu_t(lower, upper);
      ASSERT_LE(minimum, least_look_up(function.view(), points, lower, upper)) << lower << " " << upper;
      ASSERT_NEAR(minimum, test::curve_minimum(points, lower, upper), 80 * 4 * 1.2e-7)
          << lower << " " << upper;
    }
  }
}

TEST(MinMuT, OddRanges) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const TransferFunction function(mu_t_function({{0, 1}, {10, 3}, {20, 2}}));
  EXPECT_EQ(function.min_mu_t(5, 4), 0.0f);
  EXPECT_EQ(function.min_mu_t(nan, 4), 0.0f);
  EXPECT_EQ(function.min_mu_t(-inf, 4), 0.0f);
  EXPECT_EQ(function.min_mu_t(-1e37f, 1e37f), 1.0f);
  EXPECT_EQ(function.min_mu_t(12, 30), 2.0f);
}

TEST(MaxMuT, OfOpacityCurvesHoldsEveryLookUp) {
  Rng rng(12, 0, 0, 0);
  for (int f = 0; f < 60; ++f) {
    CurvePoints points = test::random_curve(-1000, 3000, 0.2, 2 + f, rng);
    for (auto& point : points) point.second = std::min(point.second, 1.0);
    const double reference_mm = 0.5;
    const TransferFunction function(test::opacity_function(points, reference_mm));
    for (int n = 0; n < 200; ++n) {
      auto lower = -1100 + 4200 * rng.next(), upper = lower + 500 * rng.next();
      const float maximum = function.max_mu_t(lower, upper);
      ASSERT_GE(maximum, greatest_look_up(function.view(), points, lower, upper));
      const double opacity = test::curve_maximum(points, lower, upper);
      const double expected = -std::log1p(-std::min(opacity, 0.9999)) / reference_mm;
      ASSERT_NEAR(maximum, expected, 2e-4 * expected) << lower << " " << upper;
    }
  }
}

TEST(MaxMuT, SeesASpikeBetweenTwoVoxelValues) {
  const TransferFunction function(mu_t_function({{49.9, 0}, {50, 7}, {50.1, 0}}));
  EXPECT_EQ(function.max_mu_t(0, 100), 7.0f);
  EXPECT_EQ(function.max_mu_t(0, 50), 7.0f);
  EXPECT_EQ(function.max_mu_t(50, 100), 7.0f);
  EXPECT_NEAR(function.max_mu_t(0, 49.95f), 3.5f, 1e-3);
  EXPECT_EQ(function.max_mu_t(60, 100), 0.0f);
}

TEST(MaxMuT, TakesBothSidesOfAStep) {
  const TransferFunction down(mu_t_function({{0, 5}, {10, 5}, {10, 1}, {20, 1}}));
  EXPECT_EQ(down.max_mu_t(3, 10), 5.0f);
  EXPECT_EQ(down.max_mu_t(10, 15), 1.0f);
  const TransferFunction up(mu_t_function({{0, 1}, {10, 1}, {10, 5}, {20, 5}}));
  EXPECT_EQ(up.max_mu_t(3, 10), 5.0f);
  EXPECT_EQ(up.max_mu_t(3, std::nextafter(10.0f, 0.0f)), 1.0f);
}

TEST(MaxMuT, OddRanges) {
  const float inf = std::numeric_limits<float>::infinity(), nan = std::numeric_limits<float>::quiet_NaN();
  const TransferFunction function(mu_t_function({{0, 1}, {10, 3}}));
  EXPECT_EQ(function.max_mu_t(5, 4), 0.0f);
  EXPECT_EQ(function.max_mu_t(nan, 4), 0.0f);
  EXPECT_EQ(function.max_mu_t(-1, nan), 0.0f);
  EXPECT_EQ(function.max_mu_t(-inf, inf), 3.0f);
  EXPECT_EQ(function.max_mu_t(-1e38f, 3e38f), 3.0f);
  EXPECT_EQ(function.max_mu_t(), 3.0f);
}

}  // namespace
}  // namespace voxlume
