#include "accel/rule_bounds.h"

namespace voxlume {

RuleBounds::RuleBounds(const GridView& main, int cell_voxels, CellOrder order,
                       std::span<const RuleVolume> volumes)
    : volumes_(volumes.size()) {
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    const RuleVolume& volume = volumes[v];
    Cells& cells = volumes_[v];
    cells.complete = volume.covers_main && !volume.has_nonfinite;
    if (v == 0) continue;
    if (volume.view.nearest)
      cells.sets = label_sets_over(main, cell_voxels, order, volume.view.grid,
                                   volume.view.leads ? Outline::kSmooth : Outline::kVoxels);
    else
      cells.ranges = value_ranges_over(main, cell_voxels, order, volume.view.grid);
  }
}

void RuleBounds::find(std::int64_t first, int count, const ValueRange* data, float scale,
                      float* mu_maj) const {
  CellValues values[kMostVolumes];
  for (std::size_t v = 0; v < volumes_.size(); ++v) {
    const Cells& cells = volumes_[v];
    values[v].complete = cells.complete;
    if (v == 0) {
      values[v].ranges = data;
    } else if (!cells.ranges.empty()) {
      values[v].ranges = &cells.ranges[first];
    } else {
      values[v].sets = &cells.sets;
      values[v].set_of_cell = &cells.sets.set_of_cell[first];
    }
  }
  classifier_->find_upper(std::span(values, volumes_.size()), count, mu_maj);
  for (int n = 0; n < count; ++n) mu_maj[n] *= scale;
}

}  // namespace voxlume
