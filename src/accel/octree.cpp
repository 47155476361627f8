#include "accel/octree.h"

#include "accel/majorant_grid.h"
#include "base/parallel.h"

namespace voxlume {

MajorantOctree::MajorantOctree(const GridView& grid, int cell_voxels)
    : ranges_(build_value_ranges(grid, cell_voxels)), domain_(grid.index_box()) {
  const float edge = static_cast<float>(ranges_.cell_voxels) * grid.step_mm;
  const Vec3f per_mm = grid.step_index / edge;
  cell_mm_ = 3.0f / (per_mm.x + per_mm.y + per_mm.z);
  std::int32_t n[3] = {ranges_.cells[0], ranges_.cells[1], ranges_.cells[2]};
  for (;;) {
    Level level{{n[0], n[1], n[2]}, {}};
    level.mu_maj.resize(static_cast<std::size_t>(n[0]) * n[1] * n[2]);
    levels_.push_back(std::move(level));
    if (n[0] == 1 && n[1] == 1 && n[2] == 1) break;
    for (std::int32_t& count : n) count = (count + 1) / 2;
  }
  for (const Level& level : levels_)
    level_views_.push_back(
        {level.mu_maj.data(), level.count[0], std::int64_t{level.count[0]} * level.count[1]});
}

void MajorantOctree::update(const TransferFunction& transfer) {
  find_majorants(transfer, ranges_, levels_[0].mu_maj);
  for (std::size_t level = 1; level < levels_.size(); ++level) reduce(static_cast<int>(level));
}

void MajorantOctree::reduce(int level) {
  const Level& from = levels_[level - 1];
  Level& to = levels_[level];
  parallel_for(std::int64_t{to.count[1]} * to.count[2], 16, [&](std::int64_t row) {
    const auto j = static_cast<std::int32_t>(row % to.count[1]),
               k = static_cast<std::int32_t>(row / to.count[1]);
    float* out = &to.mu_maj[row * to.count[0]];
    std::fill_n(out, to.count[0], 0.0f);
    for (std::int32_t z = 2 * k; z < std::min(2 * k + 2, from.count[2]); ++z)
      for (std::int32_t y = 2 * j; y < std::min(2 * j + 2, from.count[1]); ++y) {
        const float* parts = &from.mu_maj[(std::int64_t{z} * from.count[1] + y) * from.count[0]];
        for (std::int32_t x = 0; x < from.count[0]; ++x) out[x / 2] = std::max(out[x / 2], parts[x]);
      }
  });
}

OctreeView MajorantOctree::view() const {
  OctreeView view;
  for (int a = 0; a < 3; ++a) view.count[a] = ranges_.cells[a];
  view.cell_voxels = static_cast<float>(ranges_.cell_voxels);
  view.cells_per_voxel = 1.0f / view.cell_voxels;
  view.domain = domain_;
  view.levels = level_views_.data();
  view.top_level = static_cast<std::int32_t>(levels_.size()) - 1;
  return view;
}

int octree_cell_voxels(const GridView& grid, int level) {
  const std::int32_t longest = std::max({grid.size[0], grid.size[1], grid.size[2]}) - 1;
  const std::int32_t leaves = std::int32_t{1} << level;
  return std::max(1, (longest + leaves - 1) / leaves);
}

}  // namespace voxlume
