#pragma once
#include <span>
#include <vector>

#include "transfer/cell_values.h"
#include "transfer/classifier_view.h"
#include "transfer/transfer_function.h"

namespace voxlume {

/// Whether no look-up is above, or none below.
enum class Bound { kUpper, kLower };

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

  /// Bounds of mu_t [1/mm] in `count` cells, at most kCellsAtOnce; the suprema and infima of 1-D rules.
  /// `along` is not read of those.
  template <Bound kBound>
  void find_bounds(const CellValues& values, const CellValues& along, int count, float* mu_t) const;
  bool gives_extinction() const { return given_ & kGivesExtinction; }
  bool emits() const;

 private:
  struct Column {
    TransferFunction optics;
    std::vector<NumberPiece> pieces;
  };
  Column compile_column(const RuleDescription& rule, std::vector<TransferPoint> points,
                        const RuleContext& context) const;
  template <Bound kBound>
  class ColumnBounds;
  template <Bound kBound>
  void bound_column(int column, const CellValues& values, int count, float* mu_t) const;
  template <Bound kBound>
  void bound_along_labels(const CellValues& values, const CellValues& along, int count, float* mu_t) const;
  template <Bound kBound>
  void bound_along_ranges(const CellValues& values, const ValueRange* along, int count, float* mu_t) const;

  int volume_, along_;
  ColumnForm column_form_;
  std::uint32_t given_ = 0;
  std::vector<Column> columns_;
  std::vector<float> column_at_;
  std::vector<ColumnView> column_views_;
};

}  // namespace voxlume
