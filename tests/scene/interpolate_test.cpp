#include "scene/interpolate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace voxlume {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

double at(const NumberWindow& window, double time_s, Interpolation interpolation) {
  return interpolate(window, time_s, interpolation);
}

TEST(Interpolate, LinearAndStep) {
  const NumberWindow w{{}, {1, 10}, {3, 20}, {}};
  EXPECT_EQ(at(w, 1, Interpolation::kLinear), 10);
  EXPECT_EQ(at(w, 1.5, Interpolation::kLinear), 12.5);
  EXPECT_EQ(at(w, 2.999, Interpolation::kStep), 10);
}

TEST(Interpolate, SmoothStartsAndEndsAtRest) {
  const NumberWindow w{{}, {0, 0}, {2, 1}, {}};
  for (const double s : {0.0, 0.1, 0.25, 0.5, 0.8}) {
    EXPECT_NEAR(at(w, 2 * s, Interpolation::kSmooth), s * s * (3 - 2 * s), 1e-15) << s;
  }
}

TEST(Interpolate, SmoothIsStraightThroughEvenKeysAndKeepsItsSpeedAcrossThem) {
  const NumberWindow straight{{{0, 0}}, {1, 10}, {2, 20}, {{3, 30}}};
  EXPECT_NEAR(at(straight, 1.3, Interpolation::kSmooth), 13, 1e-12);
  // The course through (0, 0), (1, 1), (3, 2), (4, 8), (5, 9): the same slope on both sides of a key.
  const NumberWindow left{{{0, 0}}, {1, 1}, {3, 2}, {{4, 8}}}, right{{{1, 1}}, {3, 2}, {4, 8}, {{5, 9}}};
  constexpr double h = 1e-6;
  const double before = (2 - at(left, 3 - h, Interpolation::kSmooth)) / h;
  const double after = (at(right, 3 + h, Interpolation::kSmooth) - 2) / h;
  EXPECT_NEAR(before, after, 1e-4);
  EXPECT_NEAR(before, 9 / (4 / 0.5 + 5 / 6.0), 1e-4);  // Fritsch and Butland's mean of 1/2 and 6
}

TEST(Interpolate, SmoothNeverLeavesTheKeys) {
  const NumberWindow w{{{0, 0}}, {1, 100}, {1.1, 101}, {{50, 101.01}}};
  double last = 100;
  for (int i = 0; i < 1000; ++i) {
    const double value = at(w, 1 + 1e-4 * i, Interpolation::kSmooth);
    EXPECT_GE(value, last);
    EXPECT_LE(value, 101);
    last = value;
  }
}

TEST(Interpolate, DirectionsTurnEvenly) {
  const KeyWindow<Double3> w{{}, {0, {2, 0, 0}}, {3, {0, 0.5, 0}}, {}};
  for (const double t : {0.0, 1.0, 2.5}) {
    const Double3 d = interpolate_direction(w, t, Interpolation::kLinear);
    EXPECT_NEAR(d[0], std::cos(30 * kDegree * t), 1e-15);
    EXPECT_NEAR(d[1], std::sin(30 * kDegree * t), 1e-15);
    EXPECT_EQ(d[2], 0);
  }
  const Double3 d = interpolate_direction(w, 0.75, Interpolation::kSmooth);
  EXPECT_NEAR(std::atan2(d[1], d[0]), 90 * kDegree * 0.15625, 1e-12);  // s^2 (3 - 2s) at 1/4
}

TEST(Interpolate, OppositeDirectionsGoOverTheTop) {
  const KeyWindow<Double3> across{{}, {0, {1, 0, 0}}, {2, {-1, 0, 0}}, {}};
  EXPECT_NEAR(interpolate_direction(across, 1, Interpolation::kLinear)[2], 1, 1e-12);
  const KeyWindow<Double3> upright{{}, {0, {0, 0, 1e12}}, {2, {0, 0, -1e-12}}, {}};
  EXPECT_NEAR(interpolate_direction(upright, 1, Interpolation::kLinear)[1], 1, 1e-12);
  const KeyWindow<Double3> still{{}, {0, {0, 3, 0}}, {2, {0, 7, 0}}, {}};
  EXPECT_NEAR(interpolate_direction(still, 1, Interpolation::kLinear)[1], 1, 1e-12);
}

}  // namespace
}  // namespace voxlume
