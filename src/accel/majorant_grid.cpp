#include "accel/majorant_grid.h"

#include "base/parallel.h"

namespace voxlume {
namespace {
// Covers what the look-up's own rounding can add to the supremum.
constexpr float kSafety = 1 + 1e-4f;
}  // namespace

MajorantGrid::MajorantGrid(const GridView& grid, int cell_voxels)
    : ranges_(build_value_ranges(grid, cell_voxels)),
      mu_maj_(ranges_.ranges.size()),
      domain_(grid.index_box()) {}

void MajorantGrid::update(const TransferFunction& transfer) {
  constexpr std::int64_t kRun = 4096;
  const auto count = static_cast<std::int64_t>(mu_maj_.size());
  parallel_for((count + kRun - 1) / kRun, 1, [&](std::int64_t run) {
    const std::int64_t begin = run * kRun;
    transfer.range_maximum().find(&ranges_.ranges[begin], std::min(kRun, count - begin), kSafety,
                                  &mu_maj_[begin]);
  });
}

MajorantView MajorantGrid::view() const {
  MajorantView view;
  view.mu_maj = mu_maj_.data();
  for (int a = 0; a < 3; ++a) view.cells[a] = ranges_.cells[a];
  view.cell_voxels = static_cast<float>(ranges_.cell_voxels);
  view.domain = domain_;
  return view;
}

int default_macrocell_voxels(const GridView& grid) {
  return std::int64_t{grid.size[0]} * grid.size[1] * grid.size[2] <= (std::int64_t{1} << 24) ? 4 : 8;
}

}  // namespace voxlume
