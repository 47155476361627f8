#include "accel/rule_bounds.h"

namespace voxlume {

RuleBounds::RuleBounds(const GridView& main, int cell_voxels, CellOrder order,
                       std::span<const RuleVolume> volumes)
    : volumes_(volumes.size()) {
  for (std::size_t v = 0; v < volumes.size(); ++v) {
    const RuleVolume& volume = volumes[v];
    Cells& cells = volumes_[v];
    cells.by_labels = volume.view.nearest;
    cells.complete = volume.covers_main && !volume.has_nonfinite;
    if (v == 0) continue;
    if (cells.by_labels)
      cells.sets = label_sets_over(main, cell_voxels, order, volume.view.grid);
    else
      cells.ranges = value_ranges_over(main, cell_voxels, order, volume.view.grid);
  }
}

void RuleBounds::prepare(const Classifier& classifier) {
  classifier_ = &classifier;
  rules_.clear();
  upper_of_set_.clear();
  for (const CompiledRule& rule : classifier.rules()) {
    rules_.push_back(rule.view());
    upper_of_set_.emplace_back();
    const RuleView& view = rules_.back();
    if (!rule.gives_extinction() || view.along >= 0 || view.volume == kOpacityVolume ||
        !volumes_[view.volume].by_labels)
      continue;
    const LabelSets& sets = volumes_[view.volume].sets;
    for (std::uint32_t s = 0; s < sets.set_count(); ++s) {
      VolumeRange values;
      values.labels = sets.set(s);
      values.by_labels = true;
      upper_of_set_.back().push_back(rule.upper_mu_t(values, {}));
    }
  }
}

VolumeRange RuleBounds::range_of(int volume, std::int64_t cell, const ValueRange* data) const {
  if (volume < 0) return {};
  if (volume == kOpacityVolume) {
    VolumeRange volumes[kMostVolumes];
    volumes[0] = range_of(0, cell, data);
    return classifier_->range_of(volume, volumes);
  }
  const Cells& cells = volumes_[volume];
  VolumeRange out;
  out.by_labels = cells.by_labels;
  out.complete = cells.complete;
  if (cells.by_labels)
    out.labels = cells.sets.set(cells.sets.set_of_cell[cell]);
  else
    out.range = volume == 0 ? *data : cells.ranges[cell];
  return out;
}

/// The bounds of one rule.
void RuleBounds::find_rule(int rule, std::int64_t first, std::int64_t count, const ValueRange* data,
                           float* upper) const {
  const RuleView& view = rules_[rule];
  const CompiledRule& compiled = classifier_->rules()[rule];
  const std::vector<float>& of_set = upper_of_set_[rule];
  if (!of_set.empty()) {
    const std::uint32_t* set = &volumes_[view.volume].sets.set_of_cell[first];
    for (std::int64_t n = 0; n < count; ++n) upper[n] = of_set[set[n]];
  } else if (view.along < 0 && view.volume != kOpacityVolume) {
    const ValueRange* ranges = view.volume == 0 ? data : &volumes_[view.volume].ranges[first];
    compiled.range_maximum().find(ranges, count, 1.0f, upper);
  } else {
    for (std::int64_t n = 0; n < count; ++n)
      upper[n] = compiled.upper_mu_t(range_of(view.volume, first + n, data + n),
                                     range_of(view.along, first + n, data + n));
  }
}

void RuleBounds::find(std::int64_t first, std::int64_t count, const ValueRange* data, float scale,
                      float* mu_maj) const {
  float upper[kMostRules][kMostCells];
  const std::span<const CompiledRule> rules = classifier_->rules();
  for (std::size_t i = 0; i < rules.size(); ++i)
    if (rules[i].gives_extinction()) find_rule(static_cast<int>(i), first, count, data, upper[i]);
  for (std::int64_t n = 0; n < count; ++n) {
    const auto applies = [&](int i) {
      return rules[i].lower_mu_t(range_of(rules_[i].volume, first + n, data + n),
                                 range_of(rules_[i].along, first + n, data + n)) > 0;
    };
    mu_maj[n] = scale * classifier_->merged_upper_mu_t([&](int i) { return upper[i][n]; }, applies);
  }
}

}  // namespace voxlume
