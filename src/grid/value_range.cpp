#include "grid/value_range.h"

#include <limits>

#include "base/parallel.h"

namespace voxlume {
namespace {

template <class T>
ValueRange range_of_block(const T* voxels, const GridView& grid, const std::int32_t (&first)[3], int extent) {
  std::int32_t last[3];
  for (int a = 0; a < 3; ++a) last[a] = std::min(first[a] + extent, grid.size[a] - 1);
  float lower = std::numeric_limits<float>::max();
  float upper = std::numeric_limits<float>::lowest();
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

}  // namespace

ValueRangeGrid build_value_ranges(const GridView& grid, int cell_voxels) {
  ValueRangeGrid out;
  cell_voxels = std::min(cell_voxels, std::max({grid.size[0], grid.size[1], grid.size[2]}));
  out.cell_voxels = cell_voxels;
  for (int a = 0; a < 3; ++a) out.cells[a] = std::max(1, (grid.size[a] - 1 + cell_voxels - 1) / cell_voxels);
  const std::int64_t rows = std::int64_t{out.cells[1]} * out.cells[2];
  out.ranges.resize(rows * out.cells[0]);
  with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    parallel_for(rows, 4, [&](std::int64_t row) {
      for (std::int32_t i = 0; i < out.cells[0]; ++i) {
        const std::int32_t first[3] = {i * cell_voxels,
                                       static_cast<std::int32_t>(row % out.cells[1]) * cell_voxels,
                                       static_cast<std::int32_t>(row / out.cells[1]) * cell_voxels};
        out.ranges[row * out.cells[0] + i] = widened(range_of_block(voxels, grid, first, cell_voxels));
      }
    });
  });
  return out;
}

}  // namespace voxlume
