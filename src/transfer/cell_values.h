#pragma once
#include "grid/cell_ranges.h"

namespace voxlume {

/// How many cells are bounded at a time.
inline constexpr int kCellsAtOnce = 512;

/// What a volume holds in each of some cells: a range of values, or a set of labels.
struct CellValues {
  const ValueRange* ranges = nullptr;  ///< empty: no value
  const LabelSets* sets = nullptr;     ///< of labels, which have no ranges
  const std::uint32_t* set_of_cell = nullptr;
  bool complete = false;  ///< whether every point of the cells has a value

  /// The first cell past n that has another set of labels, at most `end`.
  int end_of_set(int n, int end) const {
    int next = n + 1;
    while (next < end && set_of_cell[next] == set_of_cell[n]) ++next;
    return next;
  }
};

}  // namespace voxlume
