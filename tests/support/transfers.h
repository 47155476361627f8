#pragma once
#include <algorithm>
#include <cmath>
#include <vector>

#include "sampling/rng.h"
#include "voxlume/scene.h"

namespace voxlume::test {

/// (data value, mu_t in 1/mm or opacity) points of a transfer function.
using CurvePoints = std::vector<std::pair<double, double>>;

inline TransferDescription mu_t_function(const CurvePoints& points) {
  TransferDescription d;
  d.reference_length_mm = 1.0;
  for (const auto& [value, mu_t] : points) {
    TransferPoint point;
    point.value = value;
    point.mu_t_per_mm = mu_t;
    d.points.push_back(point);
  }
  return d;
}

inline TransferDescription opacity_function(const CurvePoints& points, double reference_length_mm) {
  TransferDescription d;
  d.reference_length_mm = reference_length_mm;
  for (const auto& [value, opacity] : points) {
    TransferPoint point;
    point.value = value;
    point.opacity = opacity;
    d.points.push_back(point);
  }
  return d;
}

/// The curve through `points` in double precision, found by walking over them. At a step: the value from
/// above, or the one from below.
inline double curve_at(const CurvePoints& points, double value, bool from_above = true) {
  const auto past = [&](double knot) { return from_above ? knot > value : knot >= value; };
  std::size_t next = 0;
  while (next < points.size() && !past(points[next].first)) ++next;
  if (next == 0) return points.front().second;
  if (next == points.size()) return points.back().second;
  const auto& [v0, y0] = points[next - 1];
  const auto& [v1, y1] = points[next];
  return (y0 * (v1 - value) + y1 * (value - v0)) / (v1 - v0);
}

/// The supremum of the curve over [lower, upper]: at its ends or at a knot in between, from either side.
inline double curve_maximum(const CurvePoints& points, double lower, double upper) {
  double maximum = std::max(curve_at(points, lower), curve_at(points, upper));
  if (lower < upper) maximum = std::max(maximum, curve_at(points, upper, false));
  for (const auto& point : points) {
    const double value = point.first;
    if (value > lower && value < upper)
      maximum = std::max({maximum, curve_at(points, value, false), curve_at(points, value, true)});
  }
  return maximum;
}

/// The infimum of the curve over [lower, upper].
inline double curve_minimum(CurvePoints points, double lower, double upper) {
  for (auto& point : points) point.second = -point.second;
  return -curve_maximum(points, lower, upper);
}

/// A random function over [lower, upper]: ramps, steps, and needles much narrower than a unit.
inline CurvePoints random_curve(double lower, double upper, double y_max, int segments, Rng& rng) {
  CurvePoints points;
  std::vector<double> values;
  for (int i = 0; i < segments; ++i)
    values.push_back(static_cast<float>(lower + (upper - lower) * static_cast<double>(rng.next())));
  std::sort(values.begin(), values.end());
  const auto level = [&] { return y_max * std::pow(static_cast<double>(rng.next()), 3); };
  for (const double v : values) {
    const float kind = rng.next();
    if (kind < 0.3f) {
      points.emplace_back(v, level());
      points.emplace_back(v, level());
    } else if (kind < 0.5f && points.size() && points.back().first < v) {
      const double base = level();
      const float next = std::nextafter(static_cast<float>(v), 1e30f);
      points.emplace_back(v, base);
      points.emplace_back(static_cast<double>(next), y_max * 4);
      points.emplace_back(static_cast<double>(std::nextafter(next, 1e30f)), base);
    } else {
      points.emplace_back(v, level());
    }
  }
  std::stable_sort(points.begin(), points.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  return points;
}

}  // namespace voxlume::test
