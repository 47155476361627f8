#include "grid/value_range.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr ValueRange kNoValues{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};

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

// Three nested linear interpolations of floats, each rounding twice.
ValueRange widened(ValueRange range) {
  if (range.empty() || range.lower == range.upper) return range;
  const float slack =
      8 * std::numeric_limits<float>::epsilon() * std::max(std::abs(range.lower), std::abs(range.upper));
  return {range.lower - slack, range.upper + slack};
}

/// Calls visit(i, j, k, count, place) for runs of cells along i that cover the grid, in parallel.
template <class Visit>
void each_run(const std::int32_t (&cells)[3], CellOrder order, Visit&& visit) {
  if (order == CellOrder::kRows) {
    parallel_for(std::int64_t{cells[1]} * cells[2], 4, [&](std::int64_t row) {
      visit(0, static_cast<std::int32_t>(row % cells[1]), static_cast<std::int32_t>(row / cells[1]), cells[0],
            row * cells[0]);
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
        visit(i, j + y, k + z, std::min(kCubeSide, cells[0] - i),
              cube * kCubeCells + (z * kCubeSide + y) * kCubeSide);
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
    each_run(out.cells, order,
             [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t count, std::int64_t place) {
               ValueRange* run = &out.ranges[place];
               find_row(voxels, grid, {i, j, k}, cell_voxels, count, run);
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
