#include "grid/value_range.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/parallel.h"
#include "grid/cell_layout.h"

namespace voxlume {
namespace {

ValueRange joined(ValueRange range, ValueRange other) {
  // Written so that a NaN changes neither bound: where it enters the interpolation, nothing is visible.
  return {other.lower < range.lower ? other.lower : range.lower,
          other.upper > range.upper ? other.upper : range.upper};
}

/// The ranges of `count` cells in a row from cell `first` on. Bounds are kept in the voxels' type: converting
/// to float keeps the order. (f64 is converted first, so that what is no float counts as it does in the
/// look-up.)
template <class T>
void find_row(const T* voxels, const GridView& grid, const std::int32_t (&first)[3], int cell_voxels,
              std::int32_t count, ValueRange* out) {
  using Bound = std::conditional_t<std::is_same_v<T, double>, float, T>;
  using Limits = std::numeric_limits<Bound>;
  constexpr std::int32_t kBlock = 256;  // voxels along i that are done at once
  std::int32_t begin[3], end[3];
  for (int a = 0; a < 3; ++a) {
    begin[a] = first[a] * cell_voxels;
    end[a] = std::min(begin[a] + cell_voxels, grid.size[a] - 1) + 1;
  }
  end[0] = std::min(begin[0] + count * cell_voxels + 1, grid.size[0]);
  std::fill_n(out, count, kNoValues);
  Bound lower[kBlock], upper[kBlock];
  for (std::int32_t block = begin[0]; block < end[0]; block += kBlock) {
    const std::int32_t width = std::min(kBlock, end[0] - block);
    std::fill_n(lower, width, Limits::max());
    std::fill_n(upper, width, Limits::lowest());
    for (std::int32_t k = begin[2]; k < end[2]; ++k)
      for (std::int32_t j = begin[1]; j < end[1]; ++j) {
        const T* row = voxels + k * grid.stride_k + j * grid.stride_j + block;
        for (std::int32_t x = 0; x < width; ++x) {
          const auto v = static_cast<Bound>(row[x]);
          // A NaN changes neither bound.
          lower[x] = v < lower[x] ? v : lower[x];
          upper[x] = v > upper[x] ? v : upper[x];
        }
      }
    for (std::int32_t x = 0; x < width; ++x) {
      // A voxel between two cells belongs to both.
      const std::int32_t at = block + x - begin[0], cell = at / cell_voxels;
      const ValueRange column{static_cast<float>(lower[x]), static_cast<float>(upper[x])};
      if (cell < count) out[cell] = joined(out[cell], column);
      if (cell > 0 && cell * cell_voxels == at) out[cell - 1] = joined(out[cell - 1], column);
    }
  }
}

}  // namespace

ValueRangeGrid build_value_ranges(const GridView& grid, int cell_voxels, CellOrder order) {
  const CellLayout layout(grid, cell_voxels, order);
  ValueRangeGrid out;
  out.cell_voxels = layout.cell_voxels;
  std::copy_n(layout.cells, 3, out.cells);
  out.ranges.assign(static_cast<std::size_t>(layout.place_count()), kNoValues);
  with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    layout.each_run(
        [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t count, std::int64_t place) {
          ValueRange* run = &out.ranges[place];
          find_row(voxels, grid, {i, j, k}, layout.cell_voxels, count, run);
          std::transform(run, run + count, run, widened);
        });
  });
  return out;
}

std::vector<std::uint8_t> find_nan_cells(const GridView& grid, const ValueRangeGrid& ranges) {
  std::vector<std::uint8_t> has_nan;
  with_voxels(grid.type, grid.voxels, [&]<class T>(const T* voxels) {
    if constexpr (std::is_floating_point_v<T>) {
      const auto& n = ranges.cells;
      const std::int64_t edge = ranges.cell_voxels;
      has_nan.resize(ranges.ranges.size());
      // A voxel between cells belongs to both; cells write for themselves.
      parallel_for(std::int64_t{n[1]} * n[2], 4, [&](std::int64_t row) {
        const std::int64_t first[2] = {row % n[1] * edge, row / n[1] * edge};
        for (std::int64_t k = first[1]; k <= std::min<std::int64_t>(first[1] + edge, grid.size[2] - 1); ++k)
          for (std::int64_t j = first[0]; j <= std::min<std::int64_t>(first[0] + edge, grid.size[1] - 1); ++j)
            for (std::int64_t i = 0; i < grid.size[0]; ++i) {
              const T value = voxels[k * grid.stride_k + j * grid.stride_j + i];
              if (value == value) continue;
              const std::int64_t cell = i / edge;
              if (cell < n[0]) has_nan[row * n[0] + cell] = 1;
              if (cell > 0 && cell * edge == i) has_nan[row * n[0] + cell - 1] = 1;
            }
      });
    }
  });
  return has_nan;
}

}  // namespace voxlume
