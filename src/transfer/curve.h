#pragma once
#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "base/vec.h"
#include "voxlume/scene.h"

namespace voxlume {

/// A curve through (value, y) knots, constant outside them; equal values are a step.
template <class Y>
struct Curve {
  std::vector<std::pair<double, Y>> knots;

  /// The limit at `value` from below or from above.
  Y limit(double value, bool from_above) const {
    if (value < knots.front().first || (value == knots.front().first && !from_above))
      return knots.front().second;
    if (value > knots.back().first || (value == knots.back().first && from_above)) return knots.back().second;
    const auto upper = from_above ? std::upper_bound(knots.begin(), knots.end(), value,
                                                     [](double v, const auto& k) { return v < k.first; })
                                  : std::lower_bound(knots.begin(), knots.end(), value,
                                                     [](const auto& k, double v) { return k.first < v; });
    const auto& [v0, y0] = *(upper - 1);
    const auto& [v1, y1] = *upper;
    return y0 + (y1 - y0) * ((value - v0) / (v1 - v0));
  }
};

/// The curve of what `get` finds at the points that have it; `fallback` everywhere where none has.
template <class Y, class Get>
Curve<Y> collect(const std::vector<TransferPoint>& points, const Get& get, Y fallback) {
  // Data is looked up as floats, so that values that are the same float are a step.
  Curve<Y> curve;
  for (const TransferPoint& p : points)
    if (const std::optional<Y> y = get(p)) curve.knots.emplace_back(static_cast<float>(p.value), *y);
  if (curve.knots.empty()) curve.knots.emplace_back(0.0, fallback);
  return curve;
}

inline std::optional<Vec3d> to_vec(const std::optional<Color>& color) {
  if (!color) return std::nullopt;
  return Vec3d(color->linear[0], color->linear[1], color->linear[2]);
}

}  // namespace voxlume
