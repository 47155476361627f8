#pragma once
#include <span>
#include <vector>

#include "accel/block_join.h"
#include "accel/hierarchy_view.h"
#include "accel/rule_bounds.h"
#include "grid/value_range.h"
#include "transfer/transfer_function.h"

namespace voxlume {

/// What decides which cells are joined to blocks. Any values give the same picture, at another speed.
struct HierarchyCosts {
  /// A look-up in units of a cell crossing; >= 0. Blocks are joined where crossing their parts would cost
  /// more than the look-ups that the parts' own majorants save.
  float lookup = 2.5f;
  /// The largest block is 2^max_level cells a side, 0..6; at 0 every cell stands alone.
  int max_level = 6;
};

/// Majorants of one volume under one transfer function, fine where the data varies and coarse where it is
/// empty or even. Value ranges are built once per volume; a new transfer function recomputes what it changes.
class MajorantHierarchy {
 public:
  /// `cell_voxels` >= 1 is the finest cell's edge.
  MajorantHierarchy(const GridView& grid, int cell_voxels, HierarchyCosts costs = {});

  /// Brings every majorant up to date: of a finest cell the exact supremum of mu_t over its value range times
  /// kMajorantSafety, of a block the largest of its cells. Only cubes of cells with values that the function
  /// changes since the last update are computed; the result is the same as if all were.
  void update(const TransferFunction& transfer);
  /// The same under rules; computes every cube. `bounds` are of this grid, cells of cell_voxels() in cubes,
  /// and prepared.
  void update(const RuleBounds& bounds);

  int cell_voxels() const { return ranges_.cell_voxels; }
  HierarchyView view() const;

 private:
  /// 8^3 finest cells.
  struct Cube {
    ValueRange values;                    ///< of all its cells
    Block block;                          ///< the cube as a whole
    std::uint32_t own_word = kNotJoined;  ///< the word of all its cells, or kNotJoined
    std::uint32_t written = kNotJoined;   ///< the word that stands in all its cells now; kNotJoined: various
  };
  /// The cells [lower, upper) of a cube.
  struct CellBox {
    std::int32_t lower[3], upper[3];
  };
  CellBox cells_of(std::int64_t cube) const;
  std::int64_t super_cube_of(std::int64_t cube) const;
  bool find_cells(std::int64_t cube, BlockCube& blocks) const;
  void join_all(std::span<const std::int64_t> cubes, std::span<const std::int64_t> super_cubes);
  void join_cells(std::int64_t cube);
  void join_cubes(std::int64_t super_cube);
  void write_cells(std::int64_t cube, const BlockCube& blocks);
  void fill_cells(std::int64_t cube, std::uint32_t word);
  void fill_ring();
  std::uint32_t& word(std::int32_t i, std::int32_t j, std::int32_t k);

  ValueRangeGrid ranges_;
  HierarchyCosts costs_;
  Box3f domain_;
  float chord_mm_;  ///< mean length of a random line through a finest cell
  std::int32_t cubes_[3], super_cubes_[3];
  RangeExtremes extremes_;              ///< of the last update, unless that had rules
  const RuleBounds* bounds_ = nullptr;  ///< during an update with rules
  std::vector<Cube> table_;
  std::vector<std::uint32_t> words_;
};

/// The finest cell chosen when the user names none: 2 voxels up to 2^24 voxels, 4 up to 2^30, 8 above.
int default_hierarchy_voxels(const GridView& grid);

}  // namespace voxlume
