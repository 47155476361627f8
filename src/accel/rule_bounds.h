#pragma once
#include <span>
#include <vector>

#include "grid/cell_ranges.h"
#include "transfer/classifier.h"

namespace voxlume {

/// Bounds of the extinction of cells under rules of several volumes: ranges of volumes that are interpolated,
/// sets of labels of those that are not (xu2025 section 4: updates for transfer functions of any kind).
/// Ranges and sets are built once per set of volumes.
class RuleBounds {
 public:
  /// Cells and their order are those of build_value_ranges(main, cell_voxels, order). The first volume is the
  /// main one, whose ranges the caller has.
  RuleBounds(const GridView& main, int cell_voxels, CellOrder order, std::span<const RuleVolume> volumes);

  /// Takes the rules for the calls of find() that follow; its volumes are those of the constructor.
  /// `classifier` must outlive them.
  void prepare(const Classifier& classifier) { classifier_ = &classifier; }

  /// mu_maj [1/mm] of cells first .. first + count - 1, at most kCellsAtOnce, whose ranges of the main volume
  /// are `data`: no mu_t in a cell is above, times `scale`.
  void find(std::int64_t first, int count, const ValueRange* data, float scale, float* mu_maj) const;

 private:
  struct Cells {
    bool complete = false;
    std::vector<ValueRange> ranges;  ///< of an interpolated volume
    LabelSets sets;                  ///< of labels
  };

  std::vector<Cells> volumes_;
  const Classifier* classifier_ = nullptr;
};

}  // namespace voxlume
