#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <vector>

#include "base/vec.h"

namespace voxlume::test {

/// P(X >= statistic) for X chi-square distributed: the regularised upper incomplete gamma function Q(k/2,
/// x/2), by its series below a + 1 and its continued fraction (Lentz) above.
inline double chi_square_survival(double statistic, double degrees) {
  const double a = 0.5 * degrees, x = 0.5 * statistic;
  if (!(x > 0)) return 1.0;
  const double scale = std::exp(a * std::log(x) - x - std::lgamma(a));
  if (x < a + 1) {
    double term = 1 / a, sum = term;
    for (double n = a + 1; term > sum * 1e-16; ++n) sum += term *= x / n;
    return 1 - sum * scale;
  }
  double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
  for (int i = 1; i < 100000; ++i) {
    const double an = -i * (i - a);
    b += 2;
    d = 1 / (an * d + b);
    c = b + an / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return scale * h;
}

struct ChiSquareResult {
  double statistic;
  int degrees;
  double p;
};

/// Pearson's test of observed counts against expected ones of the same sum. Bins with the smallest expected
/// counts are pooled until each pool expects at least 5.
inline ChiSquareResult chi_square(const std::vector<double>& observed, const std::vector<double>& expected) {
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  double statistic = 0, pool_observed = 0, pool_expected = 0;
  int pools = 0;
  for (std::size_t i : order) {
    pool_observed += observed[i];
    pool_expected += expected[i];
    if (pool_expected < 5) continue;
    const double difference = pool_observed - pool_expected;
    statistic += difference * difference / pool_expected;
    ++pools;
    pool_observed = pool_expected = 0;
  }
  const int degrees = pools - 1;
  return {statistic, degrees, degrees > 0 ? chi_square_survival(statistic, degrees) : 1.0};
}

/// The p-value below which one of `tests` tests fails, so that all of them pass with probability 0.99
/// (Sidak).
inline double significance(int tests) { return 1 - std::pow(0.99, 1.0 / tests); }

/// Bins of the sphere about an axis: 51 rings x 101 sectors. They have equal areas, except that a
/// `feature_angle` below 1 rad makes the rings finer toward the axis so as to resolve a peak of that width.
class SphereBins {
 public:
  explicit SphereBins(Vec3f axis, double feature_angle = 2.0)
      : z_(normalize(Vec3d(axis))), counts_(kRings * kSectors) {
    x_ = normalize(cross(z_, std::abs(z_.x) < 0.5 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0)));
    y_ = cross(z_, x_);
    const double share = feature_angle * feature_angle / 4;
    if (share < 0.25) power_ = std::log(share) / std::log(0.25);
  }

  void add(Vec3f direction) {
    const Vec3d d(direction);
    const Vec3d from_axis = d - z_;
    const double s = std::pow(std::min(1.0, dot(from_axis, from_axis) / 4), 1 / power_);
    const double t = std::atan2(dot(d, y_), dot(d, x_)) / (2 * std::numbers::pi) + 0.5;
    const int ring = std::clamp(static_cast<int>(s * kRings), 0, kRings - 1);
    const int sector = std::clamp(static_cast<int>(t * kSectors), 0, kSectors - 1);
    counts_[static_cast<std::size_t>(ring * kSectors + sector)] += 1;
  }

  const std::vector<double>& counts() const { return counts_; }

  /// The integral over each bin of a function of direction (1/sr), by adaptive Gauss quadrature; `tolerance`
  /// is the error allowed in one part of a bin.
  template <class Function>
  std::vector<double> integrate(Function&& function, double tolerance = 5e-8) const {
    std::vector<double> out(kRings * kSectors);
    for (int ring = 0; ring < kRings; ++ring)
      for (int sector = 0; sector < kSectors; ++sector) {
        double sum = 0;
        for (int i = 0; i < 2; ++i)
          for (int j = 0; j < 2; ++j) {
            const Cell cell{(ring + 0.5 * i) / kRings, (sector + 0.5 * j) / kSectors, 0.5 / kRings,
                            0.5 / kSectors};
            sum += refine(function, cell, gauss(function, cell), tolerance, 0);
          }
        out[static_cast<std::size_t>(ring * kSectors + sector)] = sum;
      }
    return out;
  }

 private:
  static constexpr int kRings = 51, kSectors = 101;
  struct Cell {
    double s, t, ds, dt;
  };

  /// The direction at a place of the bins' unit square.
  Vec3f direction(double s, double t) const {
    const double share = std::pow(s, power_);  // (1 - cos theta) / 2
    const double sin_theta = 2 * std::sqrt(share * (1 - share));
    const double phi = 2 * std::numbers::pi * (t - 0.5);
    return Vec3f(x_ * (sin_theta * std::cos(phi)) + y_ * (sin_theta * std::sin(phi)) + z_ * (1 - 2 * share));
  }

  template <class Function>
  double at(Function& function, double s, double t) const {
    const double area = 4 * std::numbers::pi * power_ * std::pow(s, power_ - 1);
    return static_cast<double>(function(direction(s, t))) * area;
  }

  /// Whether the function changes by more than a factor of 2, and so that it matters, from the cell's centre
  /// to a corner: Gauss points alone miss slivers beyond a jump at a cell's edge.
  template <class Function>
  bool varies(Function& function, const Cell& c, double tolerance) const {
    const double centre = at(function, c.s + c.ds / 2, c.t + c.dt / 2);
    for (int i = 0; i < 4; ++i) {
      // Not quite on the corner, where the area may vanish.
      const double s = c.s + ((i & 1) ? 0.999 : 0.001) * c.ds, t = c.t + ((i >> 1) ? 0.999 : 0.001) * c.dt;
      const double corner = at(function, s, t);
      const bool jump = corner > 2 * centre || centre > 2 * corner;
      if (jump && std::abs(corner - centre) * c.ds * c.dt > 8 * tolerance) return true;
    }
    return false;
  }

  template <class Function>
  double gauss(Function& function, const Cell& c) const {
    constexpr double kNode = 0.3872983346207417;  // sqrt(0.6) / 2
    constexpr double kNodes[] = {0.5 - kNode, 0.5, 0.5 + kNode};
    constexpr double kWeights[] = {5.0 / 18, 8.0 / 18, 5.0 / 18};
    double sum = 0;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        sum += kWeights[i] * kWeights[j] * at(function, c.s + c.ds * kNodes[i], c.t + c.dt * kNodes[j]);
    return sum * c.ds * c.dt;
  }

  template <class Function>
  double refine(Function& function, const Cell& c, double whole, double tolerance, int depth) const {
    double parts[4], sum = 0;
    const double hs = c.ds / 2, ht = c.dt / 2;
    for (int i = 0; i < 4; ++i)
      sum += parts[i] = gauss(function, {c.s + (i & 1) * hs, c.t + (i >> 1) * ht, hs, ht});
    const bool settled = std::abs(sum - whole) < tolerance && (depth >= 5 || !varies(function, c, tolerance));
    if (settled || depth == 7) return sum;
    sum = 0;
    for (int i = 0; i < 4; ++i)
      sum +=
          refine(function, {c.s + (i & 1) * hs, c.t + (i >> 1) * ht, hs, ht}, parts[i], tolerance, depth + 1);
    return sum;
  }

  Vec3d x_, y_, z_;
  double power_ = 1;
  std::vector<double> counts_;
};

/// A direction drawn by a sampler under test, and the density it reports (0: none was drawn).
struct DirectionDraw {
  Vec3f direction;
  float pdf;
};

constexpr int kDirectionDraws = 1 << 20;

/// Tests 2^20 directions from draw() -> DirectionDraw against pdf(Vec3f). `bins` are about the feature of
/// interest and empty. Draws without direction are a bin of their own, of probability 1 minus the integral of
/// the pdf; without them the integral must be 1. Returns the integral. Fails the current test when the fit is
/// too poor for one of `tests` tests.
template <class Draw, class Pdf>
double expect_directions_fit(SphereBins bins, Draw&& draw, Pdf&& pdf, int tests) {
  double missed = 0;
  for (int i = 0; i < kDirectionDraws; ++i) {
    const DirectionDraw d = draw();
    if (d.pdf > 0)
      bins.add(d.direction);
    else
      missed += 1;
  }
  std::vector<double> expected = bins.integrate(pdf);
  std::vector<double> observed = bins.counts();
  const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
  if (missed > 0) {
    EXPECT_LT(total, 1.0 + 5e-4);
    expected.push_back(std::max(0.0, 1 - total));
    observed.push_back(missed);
  } else {
    EXPECT_NEAR(total, 1.0, 5e-4);
  }
  const double scale =
      missed > 0 ? kDirectionDraws : kDirectionDraws / total;  // an integral near 1 is rounding
  for (double& e : expected) e *= scale;
  const ChiSquareResult result = chi_square(observed, expected);
  EXPECT_GT(result.p, significance(tests))
      << "chi-square " << result.statistic << " of " << result.degrees << " degrees of freedom, integral "
      << total << ", missed " << missed;
  return total;
}

}  // namespace voxlume::test
