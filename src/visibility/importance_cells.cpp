#include "visibility/importance_cells.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "base/parallel.h"
#include "grid/cell_layout.h"
#include "grid/cell_ranges.h"

namespace voxlume {
namespace {

enum class Holds { kNever, kPerhaps, kAlways };

Holds both(Holds a, Holds b) { return std::min(a, b); }

/// What look-ups of one volume find in every cell.
struct VolumeCells {
  std::vector<ValueRange> ranges;
  std::vector<std::uint8_t> gaps;  ///< whether some point may have no value; empty: none has a gap
  bool gaps_anywhere = false;      ///< no cell is without one for certain

  Holds within(std::size_t cell, float lower, float upper) const {
    const ValueRange& range = ranges[cell];
    if (range.empty() || range.upper < lower || range.lower > upper) return Holds::kNever;
    const bool complete =
        !gaps_anywhere && (gaps.empty() || !gaps[cell]) && range.lower >= lower && range.upper <= upper;
    return complete ? Holds::kAlways : Holds::kPerhaps;
  }
};

VolumeCells find_cells(const RuleVolume& volume, const GridView& main, int cell_voxels) {
  constexpr CellOrder kOrder = CellOrder::kRows;
  const GridView& grid = volume.view.grid;
  VolumeCells out;
  if (volume.view.nearest) {
    out.ranges = label_ranges_over(main, cell_voxels, kOrder, grid,
                                   volume.view.leads ? Outline::kSmooth : Outline::kVoxels);
    out.gaps_anywhere = volume.has_nonfinite;
  } else if (volume.view.is_main_grid) {
    const ValueRangeGrid ranges = build_value_ranges(grid, cell_voxels, kOrder);
    if (volume.has_nonfinite) {
      out.gaps = find_nan_cells(grid, ranges);
      for (std::size_t i = 0; i < out.gaps.size(); ++i)
        if (!std::isfinite(ranges.ranges[i].lower) || !std::isfinite(ranges.ranges[i].upper)) out.gaps[i] = 1;
    }
    out.ranges = ranges.ranges;
    return out;
  } else {
    out.ranges = value_ranges_over(main, cell_voxels, kOrder, grid);
    out.gaps_anywhere = volume.has_nonfinite;
  }
  if (!volume.covers_main && !out.gaps_anywhere) out.gaps = cells_beyond(main, cell_voxels, kOrder, grid);
  return out;
}

/// Where cells lie in space.
class CellsInWorld {
 public:
  CellsInWorld(const GridView& main, const CellLayout& layout)
      : layout_(layout), map_(main.world_from_index) {
    // A point in floats is off by the rounding of three products and their sum.
    constexpr double kEpsilon = 4 * std::numeric_limits<float>::epsilon();
    const Vec3d end(main.size[0], main.size[1], main.size[2]);
    for (int a = 0; a < 3; ++a) {
      end_[a] = end[a] - 0.5;
      slack_[a] = kEpsilon * (std::abs(map_.column_x[a]) * end.x + std::abs(map_.column_y[a]) * end.y +
                              std::abs(map_.column_z[a]) * end.z + std::abs(map_.translation[a]));
    }
  }

  /// The smallest box with the points of a cell, and what rounding makes of them [LPS mm].
  Box3d box(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const std::int32_t cell[3] = {i, j, k};
    Vec3d center, half;
    for (int a = 0; a < 3; ++a) {
      const double side = layout_.cell_voxels;
      const double begin = cell[a] == 0 ? -0.5 : cell[a] * side;
      const double end = cell[a] == layout_.cells[a] - 1 ? end_[a] : (cell[a] + 1) * side;
      center[a] = 0.5 * (begin + end);
      half[a] = 0.5 * (end - begin);
    }
    const Vec3d middle = map_.point(center);
    Vec3d reach = slack_;
    for (int a = 0; a < 3; ++a)
      reach[a] += std::abs(map_.column_x[a]) * half.x + std::abs(map_.column_y[a]) * half.y +
                  std::abs(map_.column_z[a]) * half.z;
    return {middle - reach, middle + reach};
  }

 private:
  const CellLayout& layout_;
  const Affined map_;
  Vec3d end_, slack_;
};

Holds in_box(const Box3f& region, const Box3d& cell) {
  if (region.empty()) return Holds::kAlways;  // not asked
  Holds out = Holds::kAlways;
  for (int a = 0; a < 3; ++a) {
    const double lower = region.lower[a], upper = region.upper[a];
    if (cell.upper[a] < lower || cell.lower[a] > upper) return Holds::kNever;
    if (cell.lower[a] < lower || cell.upper[a] > upper) out = Holds::kPerhaps;
  }
  return out;
}

Holds in_sphere(const ImportanceRule& rule, const Box3d& cell) {
  // The square of a distance in floats is off by at most 5 roundings.
  constexpr double kSlack = 8 * std::numeric_limits<float>::epsilon();
  if (!(rule.radius2 >= 0)) return Holds::kAlways;  // not asked
  double nearest2 = 0, farthest2 = 0;
  for (int a = 0; a < 3; ++a) {
    const double lower = cell.lower[a] - rule.center[a], upper = cell.upper[a] - rule.center[a];
    const double nearest = std::max({lower, -upper, 0.0}), farthest = std::max(upper, -lower);
    nearest2 += nearest * nearest;
    farthest2 += farthest * farthest;
  }
  const double radius2 = rule.radius2;
  if (nearest2 * (1 - kSlack) > radius2) return Holds::kNever;
  return farthest2 * (1 + kSlack) < radius2 ? Holds::kAlways : Holds::kPerhaps;
}

}  // namespace

ImportanceCells::ImportanceCells(std::span<const ImportanceRule> rules, const GridView& main, int cell_voxels,
                                 float step) {
  const auto power = std::bit_ceil(static_cast<unsigned>(cell_voxels));
  const CellLayout layout(main, static_cast<int>(power), CellOrder::kRows);
  for (int a = 0; a < 3; ++a) view_.last[a] = layout.cells[a] - 1;
  view_.stride_j = layout.cells[0];
  view_.stride_k = layout.cells[0] * layout.cells[1];
  view_.shift = std::countr_zero(power);
  view_.domain = main.index_box();
  importance_.push_back(0);
  for (const ImportanceRule& rule : rules)
    importance_.push_back(step > 0 ? std::round(rule.importance / step) * step : rule.importance);
  std::sort(importance_.begin(), importance_.end());
  importance_.erase(std::unique(importance_.begin(), importance_.end()), importance_.end());
  levels_.assign(static_cast<std::size_t>(layout.place_count()), ImportanceCellsView::kMixed);
}

ImportanceCells::ImportanceCells(std::span<const ImportanceRule> rules, std::span<const RuleVolume> volumes,
                                 int cell_voxels)
    : ImportanceCells(rules, volumes[0].view.grid, cell_voxels, 0) {
  const GridView& main = volumes[0].view.grid;
  const int side = 1 << view_.shift;
  std::vector<VolumeCells> values(volumes.size());
  for (const ImportanceRule& rule : rules)
    for (const std::int32_t v : {rule.volume, rule.along})
      if (v >= 0 && values[static_cast<std::size_t>(v)].ranges.empty())
        values[static_cast<std::size_t>(v)] = find_cells(volumes[static_cast<std::size_t>(v)], main, side);
  const CellLayout layout(main, side, CellOrder::kRows);
  const CellsInWorld world(main, layout);
  layout.each_run([&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t count,
                      std::int64_t place) {
    for (std::int32_t x = 0; x < count; ++x) {
      const auto cell = static_cast<std::size_t>(place + x);
      float least = 0, most = 0;
      for (const ImportanceRule& rule : rules) {
        if (!(rule.importance > least)) continue;
        Holds holds = Holds::kAlways;
        if (rule.volume >= 0)
          holds = values[static_cast<std::size_t>(rule.volume)].within(cell, rule.lower[0], rule.upper[0]);
        if (rule.along >= 0)
          holds = both(
              holds, values[static_cast<std::size_t>(rule.along)].within(cell, rule.lower[1], rule.upper[1]));
        if (holds != Holds::kNever && (rule.radius2 >= 0 || !rule.box.empty())) {
          const Box3d box = world.box(i + x, j, k);
          holds = both(holds, both(in_box(rule.box, box), in_sphere(rule, box)));
        }
        if (holds == Holds::kNever) continue;
        most = std::max(most, rule.importance);
        if (holds == Holds::kAlways) least = rule.importance;
      }
      if (!(most > least)) levels_[cell] = level_of(least);
    }
  });
  find_important(main);
}

ImportanceCells::ImportanceCells(std::span<const ImportanceRule> rules, const GridView& voxels,
                                 int cell_voxels)
    : ImportanceCells(rules, voxels, cell_voxels, kImportanceStep) {
  const ValueRangeGrid ranges = build_value_ranges(voxels, 1 << view_.shift, CellOrder::kRows);
  for (std::size_t cell = 0; cell < levels_.size(); ++cell)
    if (ranges.ranges[cell].lower == ranges.ranges[cell].upper)
      levels_[cell] = level_of(ranges.ranges[cell].lower * kImportanceStep);
  find_important(voxels);
}

std::uint8_t ImportanceCells::level_of(float importance) const {
  const auto found = std::lower_bound(importance_.begin(), importance_.end(), importance);
  const auto number = found - importance_.begin();
  const bool known =
      found != importance_.end() && *found == importance && number < ImportanceCellsView::kMixed;
  return known ? static_cast<std::uint8_t>(number) : ImportanceCellsView::kMixed;
}

void ImportanceCells::find_important(const GridView& main) {
  const float side = static_cast<float>(1 << view_.shift);
  std::int32_t first[3], last[3] = {-1, -1, -1};
  std::copy_n(view_.last, 3, first);
  for (std::int32_t k = 0; k <= view_.last[2]; ++k)
    for (std::int32_t j = 0; j <= view_.last[1]; ++j)
      for (std::int32_t i = 0; i <= view_.last[0]; ++i) {
        if (levels_[static_cast<std::size_t>(i) + static_cast<std::size_t>(j) * view_.stride_j +
                    static_cast<std::size_t>(k) * view_.stride_k] == 0)
          continue;
        const std::int32_t at[3] = {i, j, k};
        for (int a = 0; a < 3; ++a) {
          first[a] = std::min(first[a], at[a]);
          last[a] = std::max(last[a], at[a]);
        }
      }
  view_.important = {};
  if (last[0] < 0) return;
  const Box3f domain = main.index_box();
  for (int a = 0; a < 3; ++a) {
    view_.important.lower[a] = first[a] == 0 ? domain.lower[a] : static_cast<float>(first[a]) * side;
    view_.important.upper[a] =
        last[a] == view_.last[a] ? domain.upper[a] : static_cast<float>(last[a] + 1) * side;
  }
}

ImportanceCellsView ImportanceCells::view() const {
  ImportanceCellsView out = view_;
  out.levels = levels_.data();
  out.importance = importance_.data();
  return out;
}

}  // namespace voxlume
