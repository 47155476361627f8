#pragma once
#include <span>
#include <vector>

#include "grid/value_range.h"
#include "transfer/classifier_view.h"
#include "transfer/transfer_function.h"

namespace voxlume {

/// What a volume's values can be in a cell: the labels of a volume that is looked up by nearest voxel, else a
/// range.
struct VolumeRange {
  ValueRange range{1, 0};  ///< empty: no value
  std::span<const float> labels;
  bool by_labels = false;
  bool complete = false;  ///< whether every point of the cell has a value
};

/// What rules are compiled from besides their own description.
struct RuleContext {
  double reference_length_mm = 1, density_scale = 1;
  /// With the values that `like` names filled in; a rule's material index counts here.
  std::span<const NamedMaterialDescription> materials;
};

/// One transfer function of a volume, or of two, compiled. Immutable.
class CompiledRule {
 public:
  /// `volume` and `along` are numbers of volumes; along is -1 for a 1-D rule. The description is valid
  /// (check_rule); materials that points name exist in the context.
  CompiledRule(const RuleDescription& rule, int volume, int along, const RuleContext& context);
  CompiledRule(CompiledRule&&) = default;
  CompiledRule& operator=(CompiledRule&&) = default;

  /// Points into this, which must stay where it is.
  RuleView view() const;

  /// No look-up of mu_t [1/mm] is above, where the volumes' values are within these; the supremum for 1-D
  /// rules.
  float upper_mu_t(const VolumeRange& values, const VolumeRange& along) const;
  /// No look-up of mu_t [1/mm] is below.
  float lower_mu_t(const VolumeRange& values, const VolumeRange& along) const;
  /// Of the first column.
  const RangeMaximum& range_maximum() const { return columns_.front().optics.range_maximum(); }
  bool gives_extinction() const { return given_ & kGivesExtinction; }
  bool emits() const;

 private:
  struct Column {
    TransferFunction optics;
    std::vector<NumberPiece> pieces;
  };
  Column compile_column(const RuleDescription& rule, std::vector<TransferPoint> points,
                        const RuleContext& context) const;
  float column_upper(const Column& column, const VolumeRange& values) const;
  float column_lower(const Column& column, const VolumeRange& values) const;

  int volume_, along_;
  ColumnForm column_form_;
  std::uint32_t given_ = 0;
  std::vector<Column> columns_;
  std::vector<float> column_at_;
  std::vector<ColumnView> column_views_;
};

}  // namespace voxlume
