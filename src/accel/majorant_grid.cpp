#include "accel/majorant_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace voxlume {
MajorantGrid::MajorantGrid(const GridView& grid, int cell_voxels, CellMinima minima)
    : ranges_(build_value_ranges(grid, cell_voxels)),
      mu_maj_(ranges_.ranges.size()),
      mu_min_(minima == CellMinima::kKept ? ranges_.ranges.size() : 0),
      has_nan_(minima == CellMinima::kKept ? find_nan_cells(grid, ranges_) : std::vector<std::uint8_t>{}),
      domain_(grid.index_box()) {}

void MajorantGrid::update(const TransferFunction& transfer) {
  find_majorants(transfer, ranges_, mu_maj_);
  parallel_for(static_cast<std::int64_t>(mu_min_.size()), 4096,
               [&](std::int64_t cell) { mu_min_[cell] = minimum_of(cell, transfer); });
}

void MajorantGrid::update(const RuleBounds& bounds) {
  constexpr std::int64_t kRun = kCellsAtOnce;
  const auto cells = static_cast<std::int64_t>(mu_maj_.size());
  parallel_for((cells + kRun - 1) / kRun, 1, [&](std::int64_t run) {
    const std::int64_t begin = run * kRun;
    bounds.find(begin, static_cast<int>(std::min(kRun, cells - begin)), &ranges_.ranges[begin],
                kMajorantSafety, &mu_maj_[begin]);
  });
}

float MajorantGrid::minimum_of(std::int64_t cell, const TransferFunction& transfer) const {
  const ValueRange range = ranges_.ranges[cell];
  if (!has_nan_.empty() && has_nan_[cell]) return 0;
  // Differences beyond this overflow when interpolated, and what comes of them is transparent.
  constexpr float kSafe = std::numeric_limits<float>::max() / 4;
  if (range.empty() || !(std::abs(range.lower) < kSafe && std::abs(range.upper) < kSafe)) return 0;
  return transfer.min_mu_t(range.lower, range.upper);
}

MajorantView MajorantGrid::view() const {
  MajorantView view;
  view.mu_maj = mu_maj_.data();
  view.mu_min = mu_min_.empty() ? nullptr : mu_min_.data();
  for (int a = 0; a < 3; ++a) view.cells[a] = ranges_.cells[a];
  view.cell_voxels = static_cast<float>(ranges_.cell_voxels);
  view.domain = domain_;
  return view;
}

void find_majorants(const TransferFunction& transfer, const ValueRangeGrid& ranges,
                    std::vector<float>& mu_maj) {
  constexpr std::int64_t kRun = 4096;
  const auto count = static_cast<std::int64_t>(mu_maj.size());
  parallel_for((count + kRun - 1) / kRun, 1, [&](std::int64_t run) {
    const std::int64_t begin = run * kRun;
    transfer.extremes().find_maxima(&ranges.ranges[begin], std::min(kRun, count - begin), kMajorantSafety,
                                    &mu_maj[begin]);
  });
}

int default_macrocell_voxels(const GridView& grid) {
  return std::int64_t{grid.size[0]} * grid.size[1] * grid.size[2] <= (std::int64_t{1} << 24) ? 4 : 8;
}

}  // namespace voxlume
