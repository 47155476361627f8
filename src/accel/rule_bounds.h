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
  void prepare(const Classifier& classifier);

  /// mu_maj [1/mm] of cells first .. first + count - 1, at most kMostCells, whose ranges of the main volume
  /// are `data`: no mu_t in a cell is above, times `scale`.
  void find(std::int64_t first, std::int64_t count, const ValueRange* data, float scale, float* mu_maj) const;
  static constexpr std::int64_t kMostCells = 512;

 private:
  struct Cells {
    bool by_labels = false, complete = false;
    std::vector<ValueRange> ranges;
    LabelSets sets;
  };
  void find_rule(int rule, std::int64_t first, std::int64_t count, const ValueRange* data,
                 float* upper) const;
  VolumeRange range_of(int volume, std::int64_t cell, const ValueRange* data) const;

  std::vector<Cells> volumes_;
  const Classifier* classifier_ = nullptr;
  std::vector<RuleView> rules_;
  /// By rule: the bound of every set of labels, where that decides.
  std::vector<std::vector<float>> upper_of_set_;
};

}  // namespace voxlume
