#pragma once
#include <vector>

#include "accel/majorant_view.h"
#include "grid/value_range.h"
#include "transfer/transfer_function.h"

namespace voxlume {

enum class CellMinima { kNone, kKept };

/// Majorants of one volume under one transfer function. The value ranges are built once per volume; a new
/// transfer function only recomputes the majorants.
class MajorantGrid {
 public:
  /// `cell_voxels` >= 1 is a macrocell's edge; at least the volume's longest side gives one global majorant.
  MajorantGrid(const GridView& grid, int cell_voxels, CellMinima minima = CellMinima::kNone);

  /// Recomputes every majorant: the exact supremum of mu_t over the cell's value range, times 1 + 1e-4;
  /// and every minimum that is kept: the exact infimum, 0 where a voxel is NaN or the field overflows.
  void update(const TransferFunction& transfer);

  MajorantView view() const;

 private:
  float minimum_of(std::int64_t cell, const TransferFunction& transfer) const;

  ValueRangeGrid ranges_;
  std::vector<float> mu_maj_, mu_min_;
  Box3f domain_;
};

/// The macrocell edge chosen when the user names none: 4 voxels up to 2^24 voxels, 8 above.
int default_macrocell_voxels(const GridView& grid);

}  // namespace voxlume
