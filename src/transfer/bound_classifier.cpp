// Bounds of the extinction by all rules, in many cells at once.
#include <algorithm>

#include "transfer/classifier.h"

namespace voxlume {
namespace {

/// What the opacity of the function's own points is where the data is within `data`.
void find_opacities(const TransferFunction& own, const ValueRange* data, int count, ValueRange* opacity) {
  // A little wider, as the exponential need not grow with its argument to the last bit.
  constexpr float kSlack = 1e-6f;
  float least[kMostCells], most[kMostCells];
  own.extremes().find_minima(data, count, least);
  own.extremes().find_maxima(data, count, 1.0f, most);
  const TransferView view = own.view();
  for (int n = 0; n < count; ++n) {
    opacity[n] = {opacity_of(view, least[n]) - kSlack, opacity_of(view, most[n]) + kSlack};
    if (data[n].empty()) opacity[n] = {1, 0};
  }
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
  ValueRange opacities[kMostCells];
  const auto reads_opacity = [](const RuleView& rule) {
    return rule.volume == kOpacityVolume || rule.along == kOpacityVolume;
  };
  if (std::any_of(rule_views_.begin(), rule_views_.end(), reads_opacity)) {
    find_opacities(own_points_.front(), volumes[0].ranges, count, opacities);
    cells.volumes[kOpacityVolume] = volumes[0];
    cells.volumes[kOpacityVolume].ranges = opacities;
  }
  if (merge_ == Merge::kProduct)
    find_product(cells, mu_t);
  else
    find_in_order(cells, mu_t);
}

void Classifier::find_product(const RuleCells& cells, float* mu_t) const {
  float upper[kMostRules][kMostCells];
  int rules = 0;
  for (const CompiledRule& rule : rules_)
    if (rule.gives_extinction()) cells.find_bounds<Bound::kUpper>(rule, upper[rules++]);
  for (int n = 0; n < cells.count; ++n) {
    float of_rules[kMostRules];
    for (int i = 0; i < rules; ++i) of_rules[i] = upper[i][n];
    mu_t[n] = merged_mu_t(merge_, of_rules, rules, own_points_.front().view().reference_length_mm);
  }
}

/// From the last rule to the first: the bound of a rule and those after it, which count unless it hides them.
void Classifier::find_in_order(const RuleCells& cells, float* mu_t) const {
  std::fill_n(mu_t, cells.count, 0.0f);
  float upper[kMostCells], lower[kMostCells];
  for (auto rule = rules_.rbegin(); rule != rules_.rend(); ++rule) {
    if (!rule->gives_extinction()) continue;
    cells.find_bounds<Bound::kUpper>(*rule, upper);
    bool may_hide = false;
    for (int n = 0; n < cells.count; ++n) may_hide |= (upper[n] > 0) & (upper[n] < mu_t[n]);
    std::fill_n(lower, cells.count, 0.0f);
    if (may_hide && merge_ == Merge::kPriority) cells.find_bounds<Bound::kLower>(*rule, lower);
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
