#pragma once
#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"
#include "grid/value_range.h"

namespace voxlume {

/// The range of no value at all.
inline constexpr ValueRange kNoValues{std::numeric_limits<float>::max(),
                                      std::numeric_limits<float>::lowest()};

/// Holds what sample_trilinear makes of values in `range`: three nested linear interpolations of floats, each
/// rounding twice. Equal values interpolate to themselves.
inline ValueRange widened(ValueRange range) {
  if (range.empty() || range.lower == range.upper) return range;
  const float slack =
      8 * std::numeric_limits<float>::epsilon() * std::max(std::abs(range.lower), std::abs(range.upper));
  return {range.lower - slack, range.upper + slack};
}

/// Which cells cover a grid, and where they lie in memory: the one layout of everything that is kept by
/// cells.
struct CellLayout {
  std::int32_t cells[3] = {0, 0, 0};
  std::int32_t cell_voxels = 0;  ///< as asked for, but no longer than the grid's longest side
  CellOrder order = CellOrder::kRows;

  /// `voxels_a_cell` >= 1.
  CellLayout(const GridView& grid, int voxels_a_cell, CellOrder cell_order) : order(cell_order) {
    cell_voxels = std::min(voxels_a_cell, std::max({grid.size[0], grid.size[1], grid.size[2]}));
    for (int a = 0; a < 3; ++a) cells[a] = std::max(1, (grid.size[a] - 1 + cell_voxels - 1) / cell_voxels);
  }

  /// Places in memory; in cubes some are beyond the grid.
  std::int64_t place_count() const {
    if (order == CellOrder::kRows) return std::int64_t{cells[0]} * cells[1] * cells[2];
    return block_count() * kCubeCells;
  }

  /// Blocks are neighbours in memory: rows of cells along i, or cubes.
  std::int64_t block_count() const {
    if (order == CellOrder::kRows) return std::int64_t{cells[1]} * cells[2];
    return std::int64_t{cubes(0)} * cubes(1) * cubes(2);
  }

  /// Calls visit(i, j, k, count, place) for the runs of cells along i that make up a block, in the order of
  /// their places.
  template <class Visit>
  void each_run_of(std::int64_t block, Visit&& visit) const {
    if (order == CellOrder::kRows) {
      visit(0, static_cast<std::int32_t>(block % cells[1]), static_cast<std::int32_t>(block / cells[1]),
            cells[0], block * cells[0]);
      return;
    }
    const auto i = static_cast<std::int32_t>(block % cubes(0)) * kCubeSide;
    const auto j = static_cast<std::int32_t>(block / cubes(0) % cubes(1)) * kCubeSide;
    const auto k = static_cast<std::int32_t>(block / cubes(0) / cubes(1)) * kCubeSide;
    for (std::int32_t z = 0; z < std::min(kCubeSide, cells[2] - k); ++z)
      for (std::int32_t y = 0; y < std::min(kCubeSide, cells[1] - j); ++y)
        visit(i, j + y, k + z, std::min(kCubeSide, cells[0] - i),
              block * kCubeCells + (z * kCubeSide + y) * kCubeSide);
  }

  /// each_run_of every block, in parallel.
  template <class Visit>
  void each_run(Visit&& visit) const {
    parallel_for(block_count(), order == CellOrder::kRows ? 4 : 1,
                 [&](std::int64_t block) { each_run_of(block, visit); });
  }

 private:
  std::int32_t cubes(int axis) const { return (cells[axis] + kCubeSide - 1) / kCubeSide; }
};

}  // namespace voxlume
