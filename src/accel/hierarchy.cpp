#include "accel/hierarchy.h"

#include <limits>
#include <numeric>

#include "accel/majorant_grid.h"
#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr std::int32_t kSide = BlockCube::kSide;
static_assert(kSide == kCubeSide);

std::int64_t volume_of(const std::int32_t (&n)[3]) { return std::int64_t{n[0]} * n[1] * n[2]; }

/// The place of item `index` in a grid of n, i fastest.
struct Place {
  std::int32_t i, j, k;
  Place(std::int64_t index, const std::int32_t (&n)[3])
      : i(static_cast<std::int32_t>(index % n[0])),
        j(static_cast<std::int32_t>(index / n[0] % n[1])),
        k(static_cast<std::int32_t>(index / n[0] / n[1])) {}
};

}  // namespace

MajorantHierarchy::MajorantHierarchy(const GridView& grid, int cell_voxels, HierarchyCosts costs)
    : ranges_(build_value_ranges(grid, cell_voxels, CellOrder::kCubes)),
      costs_(costs),
      domain_(grid.index_box()) {
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
  table_.resize(static_cast<std::size_t>(volume_of(cubes_)));
  parallel_for(volume_of(cubes_), 64, [&](std::int64_t cube) {
    ValueRange all{std::numeric_limits<float>::max(), std::numeric_limits<float>::lowest()};
    for (const ValueRange* r = &ranges_.ranges[cube * kCubeCells];
         r != &ranges_.ranges[cube * kCubeCells] + kCubeCells; ++r)
      all = {std::min(all.lower, r->lower), std::max(all.upper, r->upper)};
    table_[cube].values = all;
  });
}

void MajorantHierarchy::update(const TransferFunction& transfer) {
  const ValueRange changed = changed_values(extremes_, transfer.extremes());
  extremes_ = transfer.extremes();
  std::vector<std::int64_t> cubes, super_cubes;
  std::vector<bool> touched(static_cast<std::size_t>(volume_of(super_cubes_)));
  for (std::int64_t cube = 0; cube < volume_of(cubes_); ++cube) {
    const ValueRange& values = table_[cube].values;
    if (values.upper < changed.lower || values.lower > changed.upper) continue;
    cubes.push_back(cube);
    const std::int64_t super_cube = super_cube_of(cube);
    if (touched[super_cube]) continue;
    touched[super_cube] = true;
    super_cubes.push_back(super_cube);
  }
  if (!cubes.empty()) join_all(cubes, super_cubes);
}

void MajorantHierarchy::update(const RuleBounds& bounds) {
  extremes_ = {};
  bounds_ = &bounds;
  std::vector<std::int64_t> cubes(static_cast<std::size_t>(volume_of(cubes_)));
  std::vector<std::int64_t> super_cubes(static_cast<std::size_t>(volume_of(super_cubes_)));
  std::iota(cubes.begin(), cubes.end(), std::int64_t{0});
  std::iota(super_cubes.begin(), super_cubes.end(), std::int64_t{0});
  join_all(cubes, super_cubes);
  bounds_ = nullptr;
}

/// Decides about the blocks of some cubes and of the super cubes that they are in.
void MajorantHierarchy::join_all(std::span<const std::int64_t> cubes,
                                 std::span<const std::int64_t> super_cubes) {
  parallel_for(static_cast<std::int64_t>(cubes.size()), 8, [&](std::int64_t n) { join_cells(cubes[n]); });
  parallel_for(static_cast<std::int64_t>(super_cubes.size()), 1,
               [&](std::int64_t n) { join_cubes(super_cubes[n]); });
  fill_ring();
}

MajorantHierarchy::CellBox MajorantHierarchy::cells_of(std::int64_t cube) const {
  const Place at(cube, cubes_);
  CellBox box{{at.i * kSide, at.j * kSide, at.k * kSide}, {}};
  for (int a = 0; a < 3; ++a) box.upper[a] = std::min(box.lower[a] + kSide, ranges_.cells[a]);
  return box;
}

std::int64_t MajorantHierarchy::super_cube_of(std::int64_t cube) const {
  const Place at(cube, cubes_);
  return (std::int64_t{at.k / kSide} * super_cubes_[1] + at.j / kSide) * super_cubes_[0] + at.i / kSide;
}

/// The majorants of a cube's cells; false where all are 0.
bool MajorantHierarchy::find_cells(std::int64_t at, BlockCube& blocks) const {
  const ValueRange* ranges = &ranges_.ranges[at * kCubeCells];
  if (!bounds_) {
    if (!(extremes_.maximum(table_[at].values) > 0)) return false;
    extremes_.find_maxima(ranges, kCubeCells, kMajorantSafety, blocks.mu_maj.data());
    return true;
  }
  bounds_->find(at * kCubeCells, kCubeCells, ranges, kMajorantSafety, blocks.mu_maj.data());
  return std::any_of(blocks.mu_maj.begin(), blocks.mu_maj.end(), [](float mu_maj) { return mu_maj > 0; });
}

/// Decides about the blocks of a cube; writes its words unless they are all one.
void MajorantHierarchy::join_cells(std::int64_t at) {
  Cube& cube = table_[at];
  BlockCube blocks;
  if (!find_cells(at, blocks)) {
    cube.block = {};
    cube.own_word = make_word(0, std::min(costs_.max_level, BlockCube::kLevels));
    return;
  }
  const JoinRule cells{costs_.lookup, chord_mm_};
  for (int i = 0; i < BlockCube::kParts; ++i) blocks.cost[i] = cells.cost(blocks.mu_maj[i]);
  blocks.join(costs_.lookup, chord_mm_, 0, costs_.max_level);
  cube.block = blocks.top();
  cube.own_word = blocks.top_word();
  if (cube.own_word == kNotJoined) write_cells(at, blocks);
}

/// Decides about the blocks of several cubes and writes the words of cubes where they are all one.
void MajorantHierarchy::join_cubes(std::int64_t super_cube) {
  BlockCube blocks;
  blocks.mu_maj.fill(0);
  blocks.cost.fill(1);
  const Place place(super_cube, super_cubes_);
  const std::int32_t lower[3] = {place.i * kSide, place.j * kSide, place.k * kSide};
  const auto each_cube = [&](auto&& visit) {
    for (std::int32_t z = 0; z < std::min(kSide, cubes_[2] - lower[2]); ++z)
      for (std::int32_t y = 0; y < std::min(kSide, cubes_[1] - lower[1]); ++y)
        for (std::int32_t x = 0; x < std::min(kSide, cubes_[0] - lower[0]); ++x)
          visit((std::int64_t{lower[2] + z} * cubes_[1] + lower[1] + y) * cubes_[0] + lower[0] + x, x, y, z);
  };
  each_cube([&](std::int64_t cube, int x, int y, int z) {
    const Block& block = table_[cube].block;
    blocks.mu_maj[BlockCube::at(x, y, z)] = block.mu_maj;
    blocks.cost[BlockCube::at(x, y, z)] = block.cost;
  });
  blocks.join(costs_.lookup, kSide * chord_mm_, BlockCube::kLevels, costs_.max_level);
  each_cube([&](std::int64_t at, int x, int y, int z) {
    Cube& cube = table_[at];
    const std::uint32_t joined = blocks.joined_word(x, y, z);
    const std::uint32_t wanted = joined != kNotJoined ? joined : cube.own_word;
    if (wanted == cube.written) return;
    if (wanted == kNotJoined) return join_cells(at);  // a larger block's word stood there
    fill_cells(at, wanted);
  });
}

void MajorantHierarchy::write_cells(std::int64_t at, const BlockCube& blocks) {
  const CellBox box = cells_of(at);
  const std::int32_t width = box.upper[0] - box.lower[0];
  for (std::int32_t k = box.lower[2]; k < box.upper[2]; ++k)
    for (std::int32_t j = box.lower[1]; j < box.upper[1]; ++j) {
      const int y = j - box.lower[1], z = k - box.lower[2];
      std::uint32_t row[kSide];
      for (int x = 0; x < kSide; ++x) {
        const std::uint32_t joined = blocks.joined_word(x, y, z);
        row[x] = joined == kNotJoined ? make_word(blocks.mu_maj[BlockCube::at(x, y, z)], 0) : joined;
      }
      std::copy_n(row, width, &word(box.lower[0], j, k));
    }
  table_[at].written = kNotJoined;
}

void MajorantHierarchy::fill_cells(std::int64_t at, std::uint32_t value) {
  const CellBox box = cells_of(at);
  for (std::int32_t k = box.lower[2]; k < box.upper[2]; ++k)
    for (std::int32_t j = box.lower[1]; j < box.upper[1]; ++j)
      std::fill_n(&word(box.lower[0], j, k), box.upper[0] - box.lower[0], value);
  table_[at].written = value;
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
