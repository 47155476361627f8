#include "grid/value_range.h"

#include <limits>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr ValueRange kNoValues{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};

template <class T>
ValueRange range_of_block(const T* voxels, const GridView& grid, const std::int32_t (&first)[3], int extent) {
  std::int32_t last[3];
  for (int a = 0; a < 3; ++a) last[a] = std::min(first[a] + extent, grid.size[a] - 1);
  auto [lower, upper] = kNoValues;
  for (std::int32_t k = first[2]; k <= last[2]; ++k) {
    for (std::int32_t j = first[1]; j <= last[1]; ++j) {
      const T* row = voxels + k * grid.stride_k + j * grid.stride_j;
      for (std::int32_t i = first[0]; i <= last[0]; ++i) {
        const float v = static_cast<float>(row[i]);
        // Written so that a NaN changes neither bound: where it enters the interpolation, nothing is visible.
        lower = v < lower ? v : lower;
        upper = v > upper ? v : upper;
      }
    }
  }
  return {lower, upper};
}

// Three nested linear interpolations of floats, each rounding twice.
ValueRange widened(ValueRange range) {
  if (range.empty() || range.lower == range.upper) return range;
  const float slack =
      8 * std::numeric_limits<float>::epsilon() * std::max(std::abs(range.lower), std::abs(range.upper));
  return {range.lower - slack, range.upper + slack};
}

/// Calls visit(i, j, k, place) for every cell of the grid, in parallel.
template <class Visit>
void each_cell(const std::int32_t (&cells)[3], CellOrder order, Visit&& visit) {
  if (order == CellOrder::kRows) {
    parallel_for(std::int64_t{cells[1]} * cells[2], 4, [&](std::int64_t row) {
      for (std::int32_t i = 0; i < cells[0]; ++i)
        visit(i, static_cast<std::int32_t>(row % cells[1]), static_cast<std::int32_t>(row / cells[1]),
              row * cells[0] + i);
    });
    return;
  }
  std::int32_t cubes[3];
  for (int a = 0; a < 3; ++a) cubes[a] = (cells[a] + kCubeSide - 1) / kCubeSide;
  parallel_for(std::int64_t{cubes[0]} * cubes[1] * cubes[2], 1, [&](std::int64_t cube) {
    const auto i = static_cast<std::int32_t>(cube % cubes[0]) * kCubeSide;
    const auto j = static_cast<std::int32_t>(cube / cubes[0] % cubes[1]) * kCubeSide;
    const auto k = static_cast<std::int32_t>(cube / cubes[0] / cubes[1]) * kCubeSide;
    for (std::int32_t z = 0; z < std::min(kCubeSide, cells[2] - k); ++z)
      for (std::int32_t y = 0; y < std::min(kCubeSide, cells[1] - j); ++y)
        for (std::int32_t x = 0; x < std::min(kCubeSide, cells[0] - i); ++x)
          visit(i + x, j + y, k + z, cube * kCubeCells + (z * kCubeSide + y) * kCubeSide + x);
  });
}

std::int64_t cell_count(const std::int32_t (&cells)[3], CellOrder order) {
  if (order == CellOrder::kRows) return std::int64_t{cells[0]} * cells[1] * cells[2];
  std::int64_t cubes = 1;
  for (const std::int32_t n : cells) cubes *= (n + kCubeSide - 1) / kCubeSide;
  return cubes * kCubeCells;
}

}  // namespace

ValueRangeGrid build_value_ranges(const GridView& grid, int cell_voxels, CellOrder order) {
  ValueRangeGrid out;
  cell_voxels = std::min(cell_voxels, std::max({grid.size[0], grid.size[1], grid.size[2]}));
  out.cell_voxels = cell_voxels;
  for (int a = 0; a < 3; ++a) out.cells[a] = std::max(1, (grid.size[a] - 1 + cell_voxels - 1) / cell_voxels);
  out.ranges.assign(static_cast<std::size_t>(cell_count(out.cells, order)), kNoValues);
  with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    each_cell(out.cells, order, [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int64_t place) {
      const std::int32_t first[3] = {i * cell_voxels, j * cell_voxels, k * cell_voxels};
      out.ranges[place] = widened(range_of_block(voxels, grid, first, cell_voxels));
    });
  });
  return out;
}

}  // namespace voxlume
