#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "grid/value_range.h"
#include "voxlume/scene.h"

namespace voxlume {

/// What another volume, on a grid of its own in the same physical space, holds within the cells of the main
/// volume's grid. Cells and their order are those of build_value_ranges(main, cell_voxels, order). The other
/// volume is looked up at proxy.index_from_world(main.world_from_index(p_index)); where that is outside
/// proxy.index_box() it has no value, and nothing counts. Cells are closed: a face belongs to both its cells.

/// Holds every value that sample_trilinear(proxy, ...) returns within each cell; empty (lower > upper) for
/// cells wholly outside the proxy and for padding. NaN is not counted. Conservative: taken over the smallest
/// box along the proxy's index axes around the cell, widened by the rounding of the maps. For a proxy of the
/// same size and maps as the main volume equal to build_value_ranges(proxy, cell_voxels, order): it then
/// holds for look-ups at the main p_index itself, or at index_from_world of the same point in space.
/// `cell_voxels` >= 1.
std::vector<ValueRange> value_ranges_over(const GridView& main, int cell_voxels, CellOrder order,
                                          const GridView& proxy);

/// The same of what sample_nearest(labels, ...) or, of a smooth outline, sample_outline(labels, ...) returns,
/// on any grid; exact bounds of the voxels that may give the label.
std::vector<ValueRange> label_ranges_over(const GridView& main, int cell_voxels, CellOrder order,
                                          const GridView& labels, Outline outline = Outline::kVoxels);

/// Which cells may have a point that is outside the proxy: not 0.
std::vector<std::uint8_t> cells_beyond(const GridView& main, int cell_voxels, CellOrder order,
                                       const GridView& proxy);

/// Sets of labels of cells; equal sets are stored once. Set 0 is the empty set; the others are numbered in
/// the order of the cells that have them first.
struct LabelSets {
  std::vector<std::uint32_t> set_of_cell;  ///< by the cells' places
  std::vector<std::uint32_t> begin;        ///< set s is labels[begin[s] .. begin[s + 1])
  std::vector<float> labels;               ///< within a set: sorted, distinct, as look-ups return them

  std::size_t set_count() const { return begin.size() - 1; }
  std::span<const float> set(std::uint32_t s) const {
    return {labels.data() + begin[s], labels.data() + begin[s + 1]};
  }
};

/// The labels that sample_nearest(labels, ...) or, of a smooth outline, sample_outline(labels, ...) returns
/// within each cell, conservative as value_ranges_over is; for labels on the main volume's own grid exactly
/// those whose voxels the cell touches. NaN is no label.
/// The result is the same for any number of threads. Throws Error kOutOfMemory when the sets together hold
/// 2^32 labels or more (noise). `cell_voxels` >= 1.
LabelSets label_sets_over(const GridView& main, int cell_voxels, CellOrder order, const GridView& labels,
                          Outline outline = Outline::kVoxels);

}  // namespace voxlume
