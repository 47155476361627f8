#include "accel/majorant_grid.h"

#include "base/parallel.h"

namespace voxlume {
MajorantGrid::MajorantGrid(const GridView& grid, int cell_voxels)
    : ranges_(build_value_ranges(grid, cell_voxels)),
      mu_maj_(ranges_.ranges.size()),
      domain_(grid.index_box()) {}

void MajorantGrid::update(const TransferFunction& transfer) { find_majorants(transfer, ranges_, mu_maj_); }

MajorantView MajorantGrid::view() const {
  MajorantView view;
  view.mu_maj = mu_maj_.data();
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
    transfer.range_maximum().find(&ranges.ranges[begin], std::min(kRun, count - begin), kMajorantSafety,
                                  &mu_maj[begin]);
  });
}

int default_macrocell_voxels(const GridView& grid) {
  return std::int64_t{grid.size[0]} * grid.size[1] * grid.size[2] <= (std::int64_t{1} << 24) ? 4 : 8;
}

}  // namespace voxlume
