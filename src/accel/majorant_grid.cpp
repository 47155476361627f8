#include "accel/majorant_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/parallel.h"

namespace voxlume {
namespace {
// Covers what the look-up's own rounding can add to the supremum.
constexpr float kSafety = 1 + 1e-4f;
}  // namespace

MajorantGrid::MajorantGrid(const GridView& grid, int cell_voxels, CellMinima minima)
    : ranges_(build_value_ranges(grid, cell_voxels)),
      mu_maj_(ranges_.ranges.size()),
      mu_min_(minima == CellMinima::kKept ? ranges_.ranges.size() : 0),
      domain_(grid.index_box()) {}

void MajorantGrid::update(const TransferFunction& transfer) {
  constexpr std::int64_t kRun = 4096;
  const auto count = static_cast<std::int64_t>(mu_maj_.size());
  parallel_for((count + kRun - 1) / kRun, 1, [&](std::int64_t run) {
    for (std::int64_t i = run * kRun; i < std::min(count, (run + 1) * kRun); ++i) {
      const ValueRange range = ranges_.ranges[i];
      mu_maj_[i] = range.empty() ? 0.0f : kSafety * transfer.max_mu_t(range.lower, range.upper);
      if (!mu_min_.empty()) mu_min_[i] = minimum_of(i, transfer);
    }
  });
}

float MajorantGrid::minimum_of(std::int64_t cell, const TransferFunction& transfer) const {
  const ValueRange range = ranges_.ranges[cell];
  if (!ranges_.has_nan.empty() && ranges_.has_nan[cell]) return 0;
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

int default_macrocell_voxels(const GridView& grid) {
  return std::int64_t{grid.size[0]} * grid.size[1] * grid.size[2] <= (std::int64_t{1} << 24) ? 4 : 8;
}

}  // namespace voxlume
