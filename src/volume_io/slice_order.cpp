#include "volume_io/slice_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace voxlume {
namespace {

using Vec = std::array<double, 3>;

double dot(const Vec& a, const Vec& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Drops slices whose depth repeats that of the one before.
void drop_repeated(std::vector<std::size_t>& order, const std::vector<double>& depth, SliceOrder& result) {
  constexpr double kSameShare = 0.01;  // of the mean step
  const double range = depth[order.back()] - depth[order.front()];
  const double same = kSameShare * range / static_cast<double>(order.size());
  const std::size_t before = order.size();
  const auto repeats = [&](std::size_t a, std::size_t b) { return depth[b] - depth[a] <= same; };
  order.erase(std::unique(order.begin(), order.end(), repeats), order.end());
  if (order.size() == before) return;
  result.warnings.push_back(
      fmt::format("repeated positions: {} of {} slices lie where another does (time steps, or copies); the "
                  "first of each is kept",
                  before - order.size(), before));
}

void warn_about_tilt(const std::vector<std::size_t>& order, const std::vector<Vec>& positions,
                     const Vec& normal, SliceOrder& result) {
  constexpr double kMinTiltDegrees = 0.3;
  const Vec& first = positions[order.front()];
  const Vec& last = positions[order.back()];
  const Vec step = {last[0] - first[0], last[1] - first[1], last[2] - first[2]};
  const double along = dot(step, normal);
  const double across = std::sqrt(std::max(0.0, dot(step, step) - along * along));
  const double degrees = std::atan2(across, along) * 180 / std::numbers::pi;
  if (degrees < kMinTiltDegrees) return;
  result.warnings.push_back(
      fmt::format("gantry tilt: the slices are sheared by {:.1f} degrees; they are stacked straight, so the "
                  "shape is distorted",
                  degrees));
}

/// Fills result.slots and result.step_mm from distinct depths in order.
void place_slots(const std::vector<std::size_t>& order, const std::vector<double>& depth,
                 SliceOrder& result) {
  constexpr double kMultipleTolerance = 0.1;  // of a step
  constexpr double kEvenTolerance = 0.02;
  std::vector<double> steps;
  for (std::size_t i = 1; i < order.size(); ++i) steps.push_back(depth[order[i]] - depth[order[i - 1]]);
  const double usual = median(steps);
  const auto [shortest, longest] = std::minmax_element(steps.begin(), steps.end());
  std::size_t missing = 0;
  std::size_t gaps = 0;
  std::size_t first_gap = 0;
  bool uneven = false;
  result.slots = {order[0]};
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const double multiple = std::round(steps[i] / usual);
    const bool is_gap = multiple >= 2 && multiple <= static_cast<double>(order.size()) &&
                        std::abs(steps[i] / usual - multiple) <= kMultipleTolerance;
    if (is_gap) {
      if (gaps++ == 0) first_gap = i;
      missing += static_cast<std::size_t>(multiple) - 1;
      result.slots.insert(result.slots.end(), static_cast<std::size_t>(multiple) - 1, SliceOrder::kMissing);
    } else if (std::abs(steps[i] / usual - 1) > kEvenTolerance) {
      uneven = true;
    }
    result.slots.push_back(order[i + 1]);
  }
  if (missing > order.size()) {  // not a few lost slices: the steps are simply uneven
    result.slots = order;
    missing = 0;
    uneven = true;
  }
  result.step_mm =
      (depth[order.back()] - depth[order.front()]) / static_cast<double>(result.slots.size() - 1);
  if (missing > 0) {
    result.warnings.push_back(
        fmt::format("missing slices: {} in {} gap(s), the first of {:.4g} mm after slice {} where "
                    "{:.4g} mm is usual; they are filled by interpolation",
                    missing, gaps, steps[first_gap], first_gap + 1, usual));
  }
  if (uneven) {
    result.warnings.push_back(
        fmt::format("uneven slice spacing: steps of {:.4g} to {:.4g} mm; the slices are stacked "
                    "evenly at {:.4g} mm, so the shape is distorted",
                    *shortest, *longest, result.step_mm));
  }
}

}  // namespace

SliceOrder order_slices(const std::vector<Vec>& positions_mm, const Vec& normal) {
  SliceOrder result;
  std::vector<double> depth;
  for (const Vec& p : positions_mm) depth.push_back(dot(p, normal));
  std::vector<std::size_t> order(positions_mm.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return depth[a] < depth[b]; });
  if (order.empty()) return result;
  drop_repeated(order, depth, result);
  if (order.size() == 1) {
    result.slots = order;
    return result;
  }
  warn_about_tilt(order, positions_mm, normal, result);
  place_slots(order, depth, result);
  return result;
}

}  // namespace voxlume
