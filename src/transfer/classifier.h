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

  /// No mu_t [1/mm] is above mu_t[n] in cell n of `count`, at most kCellsAtOnce, in which volume v has
  /// volumes[v].
  void find_upper(std::span<const CellValues> volumes, int count, float* mu_t) const;
  /// No mu_t [1/mm] is above, anywhere.
  float upper_mu_t() const;
  bool emits() const;
  /// Whether a rule gives more than extinction, colour and emission.
  bool gives_numbers() const;

  std::span<const RuleVolume> volumes() const { return volumes_; }

 private:
  struct RuleCells;
  void find_product(const RuleCells& cells, float* mu_t) const;
  void find_in_order(const RuleCells& cells, float* mu_t) const;

  Merge merge_ = Merge::kPriority;
  bool smooth_labels_ = true;
  std::vector<RuleVolume> volumes_;
  std::vector<CompiledRule> rules_;
  std::vector<RuleView> rule_views_;
  std::vector<TransferFunction> own_points_;  ///< one, where there are rules
};

/// Throws Error kBadParameter at `where` (a JSON path) for what Classifier refuses.
void check_rule(const RuleDescription& rule, std::span<const RuleVolume> volumes, bool has_own_points,
                std::span<const NamedMaterialDescription> materials, const std::string& where);

}  // namespace voxlume
