#pragma once
#include <algorithm>
#include <span>
#include <string>
#include <vector>

#include "transfer/rule.h"

namespace voxlume {

/// A volume that rules may name.
struct RuleVolume {
  std::string name;  ///< "data" for the main volume, which is the first
  RuleVolumeView view;
  ValueRange values;           ///< of the whole volume
  bool covers_main = true;     ///< its grid holds the main one's domain
  bool has_nonfinite = false;  ///< some voxels are no numbers
};

/// The transfer-function manager of xu2025 section 5: rules of several volumes and how they merge. Immutable;
/// without rules it says nothing, and the transfer function classifies alone.
class Classifier {
 public:
  Classifier() = default;
  /// `transfer` has its reference length and points. Throws Error kBadParameter with the JSON path of what is
  /// wrong with a rule: an unknown volume or material, unsorted or repeated breakpoints, labels that are not
  /// whole numbers or that the volume cannot have, discrete points of a volume that is interpolated.
  Classifier(const TransferDescription& transfer, std::span<const RuleVolume> volumes,
             std::span<const NamedMaterialDescription> materials);
  Classifier(Classifier&&) = default;
  Classifier& operator=(Classifier&&) = default;

  bool has_rules() const { return !rules_.empty(); }
  /// Points into this, which must stay where it is. Outside bytes are not copied: the volumes must outlive
  /// it.
  ClassifierView view() const;

  /// No mu_t [1/mm] is above where the volumes' values are within `volumes`, in the order of the volumes.
  float upper_mu_t(const VolumeRange (&volumes)[kMostVolumes]) const;
  /// No mu_t [1/mm] is above, anywhere.
  float upper_mu_t() const;
  bool emits() const;
  /// Whether a rule gives more than extinction, colour and emission.
  bool gives_numbers() const;

  std::span<const CompiledRule> rules() const { return rules_; }
  Merge merge() const { return merge_; }
  std::span<const RuleVolume> volumes() const { return volumes_; }
  /// The values of a volume that a rule reads (kOpacityVolume and -1, none, too) where the volumes' are
  /// within `volumes`.
  VolumeRange range_of(int volume, const VolumeRange (&volumes)[kMostVolumes]) const;
  /// The bound of mu_t [1/mm] where that of every rule i is upper(i), 0 for rules that give none.
  /// `applies(i)` tells whether rule i is above 0 everywhere there; it is asked for few rules.
  template <class Upper, class Applies>
  float merged_upper_mu_t(Upper&& upper, Applies&& applies) const;

 private:
  Merge merge_ = Merge::kPriority;
  bool smooth_labels_ = true;
  std::vector<RuleVolume> volumes_;
  std::vector<CompiledRule> rules_;
  std::vector<RuleView> rule_views_;
  std::vector<TransferFunction> own_points_;  ///< one, where there are rules
};

template <class Upper, class Applies>
float Classifier::merged_upper_mu_t(Upper&& upper, Applies&& applies) const {
  float mu_t[kMostRules];
  int numbers[kMostRules], count = 0;
  for (int i = 0; i < static_cast<int>(rules_.size()); ++i) {
    if (!rules_[i].gives_extinction()) continue;
    numbers[count] = i;
    mu_t[count++] = upper(i);
  }
  if (merge_ != Merge::kPriority)
    return merged_mu_t(merge_, mu_t, count, own_points_.front().view().reference_length_mm);
  // What comes after a rule that applies everywhere is not asked.
  float most = 0;
  for (int n = 0; n < count; ++n) {
    most = std::max(most, mu_t[n]);
    const bool others_matter = std::any_of(mu_t + n + 1, mu_t + count, [most](float m) { return m > most; });
    if (!others_matter || (mu_t[n] > 0 && applies(numbers[n]))) break;
  }
  return most;
}

/// Throws Error kBadParameter at `where` (a JSON path) for what Classifier refuses.
void check_rule(const RuleDescription& rule, std::span<const RuleVolume> volumes, bool has_own_points,
                std::span<const NamedMaterialDescription> materials, const std::string& where);

}  // namespace voxlume
