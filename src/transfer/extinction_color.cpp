#include "transfer/extinction_color.h"

#include <limits>

#include "transfer/curve.h"

namespace voxlume {

ExtinctionColorCurve::ExtinctionColorCurve(const std::vector<TransferPoint>& points) {
  if (std::none_of(points.begin(), points.end(), [](const auto& p) { return p.extinction_color; })) return;
  const Curve<Vec3d> curve = collect<Vec3d>(
      points, [](const auto& p) { return to_vec(p.extinction_color); }, Vec3d(1));
  const auto& knots = curve.knots;
  pieces_.push_back(
      {-std::numeric_limits<float>::infinity(), 0, Vec3f(curve.limit(knots.front().first, false)), Vec3f(0)});
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const double v0 = knots[i].first, v1 = i + 1 < knots.size() ? knots[i + 1].first : v0;
    if (i + 1 < knots.size() && v0 == v1) continue;  // the last of those at one value holds from there on
    const Vec3d slope = v1 > v0 ? (knots[i + 1].second - knots[i].second) / (v1 - v0) : Vec3d(0);
    pieces_.push_back({static_cast<float>(v0), static_cast<float>(v0), Vec3f(knots[i].second), Vec3f(slope)});
  }
}

}  // namespace voxlume
