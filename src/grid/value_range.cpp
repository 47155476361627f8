#include "grid/value_range.h"

#include <algorithm>
#include <limits>
#include <type_traits>

#include "base/parallel.h"

namespace voxlume {
namespace {

/// Least and greatest voxel of every column of a block of rows, in the voxels' type: converting to float
/// keeps the order. (f64 is converted first, so that what is no float counts as it does in the look-up.)
template <class T>
class ColumnRanges {
 public:
  explicit ColumnRanges(std::int32_t columns)
      : lower_(columns), upper_(columns), has_nan_(kMayBeNan ? columns : 0) {}
  void clear() {
    std::fill(lower_.begin(), lower_.end(), std::numeric_limits<Bound>::max());
    std::fill(upper_.begin(), upper_.end(), std::numeric_limits<Bound>::lowest());
    std::fill(has_nan_.begin(), has_nan_.end(), std::uint8_t{0});
  }
  void add_row(const T* row) {
    Bound* lower = lower_.data();
    Bound* upper = upper_.data();
    const auto columns = static_cast<std::int64_t>(lower_.size());
    for (std::int64_t i = 0; i < columns; ++i) {
      const auto v = static_cast<Bound>(row[i]);
      // Written so that a NaN changes neither bound: where it enters the interpolation, nothing is visible.
      lower[i] = v < lower[i] ? v : lower[i];
      upper[i] = v > upper[i] ? v : upper[i];
    }
    if constexpr (kMayBeNan)
      for (std::int64_t i = 0; i < columns; ++i) has_nan_[i] |= row[i] != row[i];
  }
  ValueRange over(std::int32_t first, std::int32_t last) const {
    return {static_cast<float>(*std::min_element(&lower_[first], &lower_[last] + 1)),
            static_cast<float>(*std::max_element(&upper_[first], &upper_[last] + 1))};
  }
  bool has_nan(std::int32_t first, std::int32_t last) const {
    return *std::max_element(&has_nan_[first], &has_nan_[last] + 1) != 0;
  }

  static constexpr bool kMayBeNan = std::is_floating_point_v<T>;

 private:
  using Bound = std::conditional_t<std::is_same_v<T, double>, float, T>;
  std::vector<Bound> lower_, upper_;
  std::vector<std::uint8_t> has_nan_;
};

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
  const auto last_voxel = [&](int axis, std::int32_t cell) {
    return std::min(cell * cell_voxels + cell_voxels, grid.size[axis] - 1);
  };
  with_voxels(grid.type, grid.voxels, [&]<class T>(const T* voxels) {
    constexpr bool kMayBeNan = ColumnRanges<T>::kMayBeNan;
    if constexpr (kMayBeNan) out.has_nan.resize(out.ranges.size());
    constexpr std::int64_t kRun = 8;
    parallel_for((rows + kRun - 1) / kRun, 1, [&](std::int64_t run) {
      ColumnRanges<T> columns(grid.size[0]);
      for (std::int64_t row = run * kRun; row < std::min(rows, (run + 1) * kRun); ++row) {
        const auto cell_j = static_cast<std::int32_t>(row % out.cells[1]);
        const auto cell_k = static_cast<std::int32_t>(row / out.cells[1]);
        columns.clear();
        for (std::int64_t k = cell_k * cell_voxels; k <= last_voxel(2, cell_k); ++k)
          for (std::int64_t j = cell_j * cell_voxels; j <= last_voxel(1, cell_j); ++j)
            columns.add_row(voxels + k * grid.stride_k + j * grid.stride_j);
        for (std::int32_t i = 0; i < out.cells[0]; ++i) {
          const std::int64_t cell = row * out.cells[0] + i;
          out.ranges[cell] = widened(columns.over(i * cell_voxels, last_voxel(0, i)));
          if constexpr (kMayBeNan) out.has_nan[cell] = columns.has_nan(i * cell_voxels, last_voxel(0, i));
        }
      }
    });
  });
  return out;
}

}  // namespace voxlume
