#include "scene/interpolate.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"

namespace voxlume {
namespace {

/// Slope at a key between the differences `before` and `after`, over h_before and h_after [s].
double harmonic_slope(double before, double h_before, double after, double h_after) {
  if (before * after <= 0) return 0;
  const double w_before = 2 * h_after + h_before, w_after = h_after + 2 * h_before;
  return (w_before + w_after) / (w_before / before + w_after / after);
}

double slope_between(const NumberWindow::Key& a, const NumberWindow::Key& b) {
  return (b.value - a.value) / (b.time_s - a.time_s);
}

double slope_at(const NumberWindow::Key& before, const NumberWindow::Key& key,
                const NumberWindow::Key& after) {
  return harmonic_slope(slope_between(before, key), key.time_s - before.time_s, slope_between(key, after),
                        after.time_s - key.time_s);
}

double smooth(const NumberWindow& w, double time_s) {
  const double h = w.end.time_s - w.begin.time_s;
  const double s = (time_s - w.begin.time_s) / h;
  const double slope_begin = w.before ? slope_at(*w.before, w.begin, w.end) : 0.0;
  const double slope_end = w.after ? slope_at(w.begin, w.end, *w.after) : 0.0;
  // Hermite's cubic, written so that s = 0 gives begin exactly.
  const double s2 = s * s, s3 = s2 * s;
  const double value = w.begin.value + (w.end.value - w.begin.value) * (3 * s2 - 2 * s3) +
                       h * (slope_begin * (s3 - 2 * s2 + s) + slope_end * (s3 - s2));
  const auto [low, high] = std::minmax(w.begin.value, w.end.value);
  return std::clamp(value, low, high);  // against rounding
}

Vec3d unit(const Double3& v) {
  // Lengths first made moderate: squares of the longest would overflow.
  const double size = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  return normalize(Vec3d(v[0], v[1], v[2]) * (1 / size));
}

double angle_between(Vec3d a, Vec3d b) { return std::atan2(length(cross(a, b)), dot(a, b)); }

/// The unit vector across `a` toward `b`, or over the top where they are opposite or equal.
Vec3d across(Vec3d a, Vec3d b) {
  Vec3d side = b - a * dot(a, b);
  if (length(side) < 1e-9) {
    const Vec3d top = std::abs(a.z) < 1 - 1e-9 ? Vec3d(0, 0, 1) : Vec3d(0, 1, 0);
    side = top - a * dot(a, top);
  }
  return normalize(side);
}

}  // namespace

double interpolate(const NumberWindow& w, double time_s, Interpolation interpolation) {
  if (interpolation == Interpolation::kStep) return w.begin.value;
  if (interpolation == Interpolation::kSmooth) return smooth(w, time_s);
  const double s = (time_s - w.begin.time_s) / (w.end.time_s - w.begin.time_s);
  return w.begin.value + (w.end.value - w.begin.value) * s;
}

Double3 interpolate_direction(const KeyWindow<Double3>& w, double time_s, Interpolation interpolation) {
  const Vec3d begin = unit(w.begin.value), end = unit(w.end.value);
  const double whole = angle_between(begin, end);
  // The way as one number: the angle gone since begin.
  NumberWindow way{{}, {w.begin.time_s, 0}, {w.end.time_s, whole}, {}};
  if (w.before) way.before = {w.before->time_s, -angle_between(unit(w.before->value), begin)};
  if (w.after) way.after = {w.after->time_s, whole + angle_between(end, unit(w.after->value))};
  const double angle = interpolate(way, time_s, interpolation);
  const Vec3d out = begin * std::cos(angle) + across(begin, end) * std::sin(angle);
  return {out.x, out.y, out.z};
}

}  // namespace voxlume
