#pragma once
#include <vector>

#include "accel/majorant_view.h"
#include "accel/rule_bounds.h"
#include "grid/value_range.h"
#include "transfer/transfer_function.h"

namespace voxlume {

/// A majorant over the supremum of mu_t; covers what the look-up's own rounding can add.
inline constexpr float kMajorantSafety = 1 + 1e-4f;

/// The majorants of cells with given ranges, on all threads; `mu_maj` has as many elements.
void find_majorants(const TransferFunction& transfer, const ValueRangeGrid& ranges,
                    std::vector<float>& mu_maj);

enum class CellMinima { kNone, kKept };

/// Majorants of one volume under one transfer function. The value ranges are built once per volume; a new
/// transfer function only recomputes the majorants.
class MajorantGrid {
 public:
  /// `cell_voxels` >= 1 is a macrocell's edge; at least the volume's longest side gives one global majorant.
  MajorantGrid(const GridView& grid, int cell_voxels, CellMinima minima = CellMinima::kNone);

  /// Recomputes every majorant: the exact supremum of mu_t over the cell's value range, times
  /// kMajorantSafety; and every minimum that is kept: the exact infimum, 0 where a voxel is NaN or the field
  /// overflows.
  void update(const TransferFunction& transfer);
  /// The same under rules, without minima. `bounds` are of this grid, cells of cell_voxels() in rows, and
  /// prepared.
  void update(const RuleBounds& bounds);

  int cell_voxels() const { return ranges_.cell_voxels; }
  MajorantView view() const;

 private:
  float minimum_of(std::int64_t cell, const TransferFunction& transfer) const;

  ValueRangeGrid ranges_;
  std::vector<float> mu_maj_, mu_min_;
  std::vector<std::uint8_t> has_nan_;  ///< by cell, where minima are kept
  Box3f domain_;
};

/// The macrocell edge chosen when the user names none: 4 voxels up to 2^24 voxels, 8 above.
int default_macrocell_voxels(const GridView& grid);

}  // namespace voxlume
