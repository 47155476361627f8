// Bounds of the extinction by all rules, in many cells at once.
#include <algorithm>
#include <limits>

#include "transfer/classifier.h"
#include "transfer/opacities.h"

namespace voxlume {
namespace {

/// What the opacity of the function's own points is where the data is within `data`.
void find_opacity_ranges(const TransferFunction& own, const ValueRange* data, int count,
                         ValueRange* opacity) {
  // A little wider, as the exponential need not grow with its argument to the last bit.
  constexpr float kSlack = 1e-6f;
  float least[kCellsAtOnce], most[kCellsAtOnce];
  own.extremes().find_minima(data, count, least);
  own.extremes().find_maxima(data, count, 1.0f, most);
  const float length_mm = own.view().reference_length_mm;
  simd::find_opacities(least, count, length_mm, least);
  simd::find_opacities(most, count, length_mm, most);
  for (int n = 0; n < count; ++n)
    opacity[n] = data[n].empty() ? ValueRange{1, 0} : ValueRange{least[n] - kSlack, most[n] + kSlack};
}

}  // namespace

/// Some cells, as rules read them.
struct Classifier::RuleCells {
  CellValues volumes[kMostVolumes + 1];
  int count;

  template <Bound kBound>
  void find_bounds(const CompiledRule& rule, float* mu_t) const {
    const RuleView view = rule.view();
    rule.find_bounds<kBound>(volumes[view.volume], view.along < 0 ? CellValues{} : volumes[view.along], count,
                             mu_t);
  }
};

void Classifier::find_upper(std::span<const CellValues> volumes, int count, float* mu_t) const {
  RuleCells cells;
  cells.count = count;
  std::copy(volumes.begin(), volumes.end(), cells.volumes);
  ValueRange opacities[kCellsAtOnce];
  const auto reads_opacity = [](const RuleView& rule) {
    return rule.volume == kOpacityVolume || rule.along == kOpacityVolume;
  };
  if (std::any_of(rule_views_.begin(), rule_views_.end(), reads_opacity)) {
    find_opacity_ranges(own_points_.front(), volumes[0].ranges, count, opacities);
    cells.volumes[kOpacityVolume] = volumes[0];
    cells.volumes[kOpacityVolume].ranges = opacities;
  }
  if (merge_ == Merge::kProduct)
    find_product(cells, mu_t);
  else
    find_in_order(cells, mu_t);
}

void Classifier::find_product(const RuleCells& cells, float* mu_t) const {
  const float length_mm = own_points_.front().view().reference_length_mm;
  float upper[kCellsAtOnce], own[kCellsAtOnce], opacity[kCellsAtOnce], least_opacity[kCellsAtOnce];
  std::fill_n(mu_t, cells.count, std::numeric_limits<float>::infinity());
  std::fill_n(opacity, cells.count, 1.0f);
  std::fill_n(least_opacity, cells.count, 1.0f);
  bool any = false;
  for (const CompiledRule& rule : rules_) {
    if (!rule.gives_extinction()) continue;
    any = true;
    cells.find_bounds<Bound::kUpper>(rule, upper);
    simd::find_opacities(upper, cells.count, length_mm, own);
    for (int n = 0; n < cells.count; ++n) {
      const float factor = std::min(own[n] / kSaturated, 1.0f);
      opacity[n] *= factor;
      least_opacity[n] = std::min(least_opacity[n], factor);
      mu_t[n] = std::min(mu_t[n], upper[n]);
    }
  }
  for (int n = 0; n < cells.count; ++n)
    mu_t[n] = any ? mu_t_of_product(opacity[n], least_opacity[n], mu_t[n], length_mm) : 0;
}

/// From the last rule to the first: the bound of a rule and those after it, which count unless it hides them.
void Classifier::find_in_order(const RuleCells& cells, float* mu_t) const {
  std::fill_n(mu_t, cells.count, 0.0f);
  float upper[kCellsAtOnce], lower[kCellsAtOnce];
  for (auto rule = rules_.rbegin(); rule != rules_.rend(); ++rule) {
    if (!rule->gives_extinction()) continue;
    cells.find_bounds<Bound::kUpper>(*rule, upper);
    int may_hide = 0;
    for (int n = 0; n < cells.count; ++n)
      may_hide |= static_cast<int>(upper[n] > 0) & static_cast<int>(upper[n] < mu_t[n]);
    std::fill_n(lower, cells.count, 0.0f);
    if (may_hide != 0 && merge_ == Merge::kPriority) cells.find_bounds<Bound::kLower>(*rule, lower);
    for (int n = 0; n < cells.count; ++n) mu_t[n] = lower[n] > 0 ? upper[n] : std::max(upper[n], mu_t[n]);
  }
}

float Classifier::upper_mu_t() const {
  if (!has_rules()) return 0;
  CellValues all[kMostVolumes];
  for (std::size_t v = 0; v < volumes_.size(); ++v) all[v].ranges = &volumes_[v].values;
  float mu_t = 0;
  find_upper(std::span(all, volumes_.size()), 1, &mu_t);
  return mu_t;
}

}  // namespace voxlume
