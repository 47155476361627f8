#pragma once
#include <cstdint>
#include <vector>

#include "grid/grid_view.h"

namespace voxlume {

/// Least and greatest value of the interpolated data in a cell; lower > upper when the cell has no finite
/// value.
struct ValueRange {
  float lower, upper;
  bool empty() const { return lower > upper; }
};

/// How the cells of a grid lie in memory: row after row, or by cubes of 8^3 cells (both i fastest), of which
/// the outermost may reach beyond the grid.
enum class CellOrder { kRows, kCubes };
inline constexpr std::int32_t kCubeSide = 8;
inline constexpr std::int64_t kCubeCells = std::int64_t{kCubeSide} * kCubeSide * kCubeSide;

/// Value ranges of cubic cells of `cell_voxels` spacings. Cell (i,j,k) starts at the integer p_index
/// (i,j,k)*cell_voxels; the outermost cells reach to the end of the domain. A cell's range is taken over its
/// (cell_voxels+1)^3 voxels: the trilinear field is continuous and attains that range and nothing outside it.
struct ValueRangeGrid {
  std::int32_t cells[3] = {0, 0, 0};
  std::int32_t cell_voxels = 0;
  std::vector<ValueRange> ranges;  ///< in the order asked for; empty beyond the grid
};

/// Builds the ranges, once per volume, on all threads. `cell_voxels` >= 1. Ranges are widened by the rounding
/// of the interpolation (a few ulp), so that they hold for the floats sample_trilinear returns.
ValueRangeGrid build_value_ranges(const GridView& grid, int cell_voxels, CellOrder order = CellOrder::kRows);

/// Which cells of `ranges`, built in rows, have a NaN, which their range leaves out; empty for voxels of
/// whole numbers.
std::vector<std::uint8_t> find_nan_cells(const GridView& grid, const ValueRangeGrid& ranges);

}  // namespace voxlume
