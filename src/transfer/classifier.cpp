#include "transfer/classifier.h"

#include <algorithm>

#include "voxlume/error.h"

namespace voxlume {
namespace {

/// The number of the volume that a rule names; -1 for the empty name.
int volume_number(const std::string& name, std::span<const RuleVolume> volumes) {
  if (name == "opacity") return kOpacityVolume;
  for (std::size_t i = 0; i < volumes.size(); ++i)
    if (volumes[i].name == name) return static_cast<int>(i);
  return -1;
}

}  // namespace

Classifier::Classifier(const TransferDescription& transfer, std::span<const RuleVolume> volumes,
                       std::span<const NamedMaterialDescription> materials)
    : merge_(transfer.merge),
      smooth_labels_(transfer.smooth_labels),
      volumes_(volumes.begin(), volumes.end()) {
  if (transfer.rules.empty()) return;
  TransferDescription own = transfer;
  own.rules.clear();
  own_points_.emplace_back(own);
  const RuleContext context{*transfer.reference_length_mm, transfer.density_scale, materials};
  for (std::size_t i = 0; i < transfer.rules.size(); ++i) {
    const RuleDescription& rule = transfer.rules[i];
    check_rule(rule, volumes, !transfer.points.empty(), materials, "/transfer/rules/" + std::to_string(i));
    rules_.emplace_back(rule, volume_number(rule.volume, volumes), volume_number(rule.along, volumes),
                        context);
  }
  if (!transfer.points.empty()) {
    RuleDescription last;
    last.points = transfer.points;
    rules_.emplace_back(last, 0, -1, context);
  }
  for (const CompiledRule& rule : rules_) rule_views_.push_back(rule.view());
}

ClassifierView Classifier::view() const {
  ClassifierView view;
  view.rules = rule_views_.data();
  view.rule_count = static_cast<std::int32_t>(rule_views_.size());
  view.merge = merge_;
  view.smooth_labels = smooth_labels_;
  for (std::size_t i = 0; i < volumes_.size(); ++i) view.volumes[i] = volumes_[i].view;
  if (has_rules()) view.own_points = own_points_.front().view();
  return view;
}

bool Classifier::emits() const {
  return std::any_of(rules_.begin(), rules_.end(), [](const CompiledRule& rule) { return rule.emits(); });
}

bool Classifier::gives_numbers() const {
  constexpr std::uint32_t kOptics = kGivesExtinction | kGivesColor | kGivesEmission |
                                    gives(Number::kExtinctionRed) | gives(Number::kExtinctionGreen) |
                                    gives(Number::kExtinctionBlue);
  return std::any_of(rule_views_.begin(), rule_views_.end(),
                     [](const RuleView& rule) { return (rule.given & ~kOptics) != 0; });
}

}  // namespace voxlume
