#pragma once
#include <span>
#include <vector>

#include "transfer/classifier.h"
#include "visibility/importance.h"

namespace voxlume {

/// A grid of cells over the main volume that says where importance is one everywhere: decided from the ranges
/// that the volumes' values have there and from where the cell lies, rounding included, so that a look-up
/// that asks the cells first returns what one that does not would. Owns what view() points to.
class ImportanceCells {
 public:
  /// Of rules that are asked at points, whose volumes these are, the main one first.
  ImportanceCells(std::span<const ImportanceRule> rules, std::span<const RuleVolume> volumes,
                  int cell_voxels);
  /// Of importances stored by voxel, all of them 0 or that of a rule where a cell has but one.
  ImportanceCells(std::span<const ImportanceRule> rules, const GridView& voxels, int cell_voxels);

  ImportanceCellsView view() const;

 private:
  ImportanceCells(std::span<const ImportanceRule> rules, const GridView& main, int cell_voxels, float step);
  void find_important(const GridView& main);
  std::uint8_t level_of(float importance) const;

  ImportanceCellsView view_;
  std::vector<float> importance_;
  std::vector<std::uint8_t> levels_;
};

}  // namespace voxlume
