#include "accel/hierarchy.h"

#include "base/parallel.h"

namespace voxlume {
namespace {

// Covers what the look-up's own rounding can add to the supremum.
constexpr float kSafety = 1 + 1e-4f;
constexpr std::int32_t kSide = BlockCube::kSide;

std::int64_t volume_of(const std::int32_t (&n)[3]) { return std::int64_t{n[0]} * n[1] * n[2]; }

}  // namespace

MajorantHierarchy::MajorantHierarchy(const GridView& grid, int cell_voxels, HierarchyCosts costs)
    : ranges_(build_value_ranges(grid, cell_voxels)), costs_(costs), domain_(grid.index_box()) {
  Vec3f edge_mm;
  std::size_t words = 1;
  for (int a = 0; a < 3; ++a) {
    edge_mm[a] = static_cast<float>(ranges_.cell_voxels) * grid.step_mm / grid.step_index[a];
    cubes_[a] = (ranges_.cells[a] + kSide - 1) / kSide;
    super_cubes_[a] = (cubes_[a] + kSide - 1) / kSide;
    words *= static_cast<std::size_t>(ranges_.cells[a]) + 2;
  }
  // Four times volume over surface, by Cauchy's formula.
  chord_mm_ = 2 * edge_mm.x * edge_mm.y * edge_mm.z /
              (edge_mm.x * edge_mm.y + edge_mm.y * edge_mm.z + edge_mm.z * edge_mm.x);
  words_.resize(words);
  cube_tops_.resize(static_cast<std::size_t>(volume_of(cubes_)));
}

void MajorantHierarchy::update(const TransferFunction& transfer) {
  parallel_for(volume_of(cubes_), 16,
               [&](std::int64_t cube) { cube_tops_[cube] = join_cube(cube, transfer); });
  parallel_for(volume_of(super_cubes_), 1, [&](std::int64_t super_cube) { join_cubes(super_cube); });
  fill_ring();
}

MajorantHierarchy::CellBox MajorantHierarchy::cells_of(std::int64_t cube) const {
  const std::int32_t at[3] = {static_cast<std::int32_t>(cube % cubes_[0]),
                              static_cast<std::int32_t>(cube / cubes_[0] % cubes_[1]),
                              static_cast<std::int32_t>(cube / cubes_[0] / cubes_[1])};
  CellBox box;
  for (int a = 0; a < 3; ++a) {
    box.lower[a] = at[a] * kSide;
    box.upper[a] = std::min(box.lower[a] + kSide, ranges_.cells[a]);
  }
  return box;
}

Block MajorantHierarchy::join_cube(std::int64_t cube, const TransferFunction& transfer) {
  BlockCube blocks;
  const CellBox box = cells_of(cube);
  const JoinRule cell_rule{costs_.lookup, chord_mm_};
  const auto each_cell = [&](auto&& visit) {
    for (std::int32_t k = box.lower[2]; k < box.upper[2]; ++k)
      for (std::int32_t j = box.lower[1]; j < box.upper[1]; ++j)
        for (std::int32_t i = box.lower[0]; i < box.upper[0]; ++i)
          visit(i, j, k, i - box.lower[0], j - box.lower[1], k - box.lower[2]);
  };
  each_cell([&](std::int32_t i, std::int32_t j, std::int32_t k, int x, int y, int z) {
    const ValueRange range =
        ranges_.ranges[(static_cast<std::size_t>(k) * ranges_.cells[1] + j) * ranges_.cells[0] + i];
    blocks.part(x, y, z) =
        cell_rule.whole(range.empty() ? 0.0f : kSafety * transfer.max_mu_t(range.lower, range.upper));
  });
  blocks.join(costs_.lookup, chord_mm_, costs_.max_level);
  each_cell([&](std::int32_t i, std::int32_t j, std::int32_t k, int x, int y, int z) {
    const int level = blocks.level_of(x, y, z);
    word(i, j, k) = make_word(blocks.block(level, x, y, z).mu_maj, level);
  });
  return blocks.top();
}

void MajorantHierarchy::join_cubes(std::int64_t super_cube) {
  BlockCube blocks;
  const std::int32_t lower[3] = {
      static_cast<std::int32_t>(super_cube % super_cubes_[0]) * kSide,
      static_cast<std::int32_t>(super_cube / super_cubes_[0] % super_cubes_[1]) * kSide,
      static_cast<std::int32_t>(super_cube / super_cubes_[0] / super_cubes_[1]) * kSide};
  const auto each_cube = [&](auto&& visit) {
    for (std::int32_t z = 0; z < std::min(kSide, cubes_[2] - lower[2]); ++z)
      for (std::int32_t y = 0; y < std::min(kSide, cubes_[1] - lower[1]); ++y)
        for (std::int32_t x = 0; x < std::min(kSide, cubes_[0] - lower[0]); ++x)
          visit((std::int64_t{lower[2] + z} * cubes_[1] + lower[1] + y) * cubes_[0] + lower[0] + x, x, y, z);
  };
  each_cube([&](std::int64_t cube, int x, int y, int z) { blocks.part(x, y, z) = cube_tops_[cube]; });
  blocks.join(costs_.lookup, kSide * chord_mm_, costs_.max_level - BlockCube::kLevels);
  each_cube([&](std::int64_t cube, int x, int y, int z) {
    const int level = blocks.level_of(x, y, z);
    if (level == 0) return;
    const std::uint32_t joined = make_word(blocks.block(level, x, y, z).mu_maj, level + BlockCube::kLevels);
    const CellBox box = cells_of(cube);
    for (std::int32_t k = box.lower[2]; k < box.upper[2]; ++k)
      for (std::int32_t j = box.lower[1]; j < box.upper[1]; ++j)
        std::fill(&word(box.lower[0], j, k), &word(box.upper[0], j, k), joined);
  });
}

/// The cells around the grid continue their neighbours, each alone.
void MajorantHierarchy::fill_ring() {
  const auto& n = ranges_.cells;
  parallel_for(n[2] + 2, 4, [&](std::int64_t plane) {
    const auto k = static_cast<std::int32_t>(plane) - 1;
    for (std::int32_t j = -1; j <= n[1]; ++j) {
      const bool outside = k < 0 || k == n[2] || j < 0 || j == n[1];
      for (std::int32_t i = -1; i <= n[0]; i += outside || i == n[0] ? 1 : n[0] + 1)
        word(i, j, k) =
            word(std::clamp(i, 0, n[0] - 1), std::clamp(j, 0, n[1] - 1), std::clamp(k, 0, n[2] - 1)) &
            ~kLevelMask;
    }
  });
}

HierarchyView MajorantHierarchy::view() const {
  HierarchyView view;
  view.stride_j = ranges_.cells[0] + 2;
  view.stride_k = view.stride_j * (ranges_.cells[1] + 2);
  view.words = words_.data() + view.stride_k + view.stride_j + 1;
  for (int a = 0; a < 3; ++a) view.count[a] = ranges_.cells[a];
  view.cell_voxels = static_cast<float>(ranges_.cell_voxels);
  view.cells_per_voxel = 1.0f / view.cell_voxels;
  view.domain = domain_;
  return view;
}

std::uint32_t& MajorantHierarchy::word(std::int32_t i, std::int32_t j, std::int32_t k) {
  const auto& n = ranges_.cells;
  return words_[(static_cast<std::size_t>(k + 1) * (n[1] + 2) + j + 1) * (n[0] + 2) + i + 1];
}

int default_hierarchy_voxels(const GridView& grid) {
  const std::int64_t voxels = std::int64_t{grid.size[0]} * grid.size[1] * grid.size[2];
  return voxels <= std::int64_t{1} << 24 ? 2 : voxels <= std::int64_t{1} << 30 ? 4 : 8;
}

}  // namespace voxlume
