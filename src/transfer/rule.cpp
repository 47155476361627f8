#include "transfer/rule.h"

#include <algorithm>
#include <limits>
#include <string_view>

#include "transfer/curve.h"

namespace voxlume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
/// Half the distance between labels.
constexpr double kHalf = 0.5;

constexpr std::optional<double> TransferPoint::*kPointNumbers[kLobeNumberCount] = {
    &TransferPoint::roughness, &TransferPoint::metallic, &TransferPoint::specular, &TransferPoint::anisotropy,
    &TransferPoint::surface_share};
constexpr std::optional<double> NamedMaterialDescription::*kMaterialNumbers[kLobeNumberCount] = {
    &NamedMaterialDescription::roughness, &NamedMaterialDescription::metallic,
    &NamedMaterialDescription::specular, &NamedMaterialDescription::anisotropy,
    &NamedMaterialDescription::surface_share};

std::optional<double> number_of(const TransferPoint& point, int n) {
  if (n < kLobeNumberCount) return point.*kPointNumbers[n];
  if (!point.extinction_color) return std::nullopt;
  return point.extinction_color->linear[static_cast<std::size_t>(n - kLobeNumberCount)];
}

bool is_curve(RuleKind kind) { return kind == RuleKind::kCoefficientCurve; }
bool is_steps(RuleKind kind) {
  return kind == RuleKind::kCoefficientSteps || kind == RuleKind::kMaterialSteps;
}

std::int32_t material_index(std::span<const NamedMaterialDescription> materials, std::string_view name) {
  for (std::size_t i = 0; i < materials.size(); ++i)
    if (materials[i].name == name) return static_cast<std::int32_t>(i);
  return -1;
}

/// Gives the point what its material gives and it does not.
void take_from_material(const NamedMaterialDescription& material, TransferPoint& point) {
  if (!point.opacity && !point.mu_t_per_mm) {
    point.opacity = material.opacity;
    point.mu_t_per_mm = material.mu_t_per_mm;
  }
  if (!point.color) point.color = material.color;
  if (!point.emission) point.emission = material.emission;
  if (!point.extinction_color) point.extinction_color = material.extinction_color;
  for (int n = 0; n < kLobeNumberCount; ++n)
    if (!(point.*kPointNumbers[n])) point.*kPointNumbers[n] = material.*kMaterialNumbers[n];
}

bool has_extinction(const TransferPoint& point) { return point.opacity || point.mu_t_per_mm; }

std::uint32_t bits_of(const TransferPoint& point, std::int32_t material) {
  std::uint32_t bits = 0;
  if (has_extinction(point)) bits |= kGivesExtinction;
  if (point.color) bits |= kGivesColor;
  if (point.emission) bits |= kGivesEmission;
  if (material >= 0) bits |= kGivesMaterial;
  for (int n = 0; n < kNumberCount; ++n)
    if (number_of(point, n)) bits |= gives(static_cast<Number>(n));
  return bits;
}

/// A run of values on which a point of steps or of discrete points holds.
struct Run {
  double begin, end;  ///< end is infinite for the last step
  const TransferPoint* point;
};
std::vector<Run> runs_of(RuleKind kind, const std::vector<TransferPoint>& points) {
  std::vector<Run> runs;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double value = points[i].value;
    if (!is_steps(kind))
      runs.push_back({value - kHalf, value + kHalf, &points[i]});
    else
      runs.push_back({value, i + 1 < points.size() ? points[i + 1].value : HUGE_VAL, &points[i]});
  }
  return runs;
}

/// Points of a curve that has these runs as steps; extinction 0 elsewhere.
std::vector<TransferPoint> points_of_runs(const std::vector<Run>& runs) {
  std::vector<TransferPoint> out;
  const auto add = [&](double value, TransferPoint point) {
    point.value = value;
    out.push_back(std::move(point));
  };
  const auto nothing = [](TransferPoint point) {
    point.mu_t_per_mm = 0;
    return point;
  };
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    if (i == 0 || runs[i - 1].end < run.begin) add(run.begin, nothing(*run.point));
    add(run.begin, *run.point);
    if (run.end == HUGE_VAL) break;
    add(run.end, *run.point);
    if (i + 1 == runs.size() || run.end < runs[i + 1].begin) add(run.end, nothing(*run.point));
  }
  return out;
}

NumberPiece constant_piece(double start, const TransferPoint& point, std::uint32_t given,
                           std::int32_t material) {
  NumberPiece piece{static_cast<float>(start), static_cast<float>(start), given, material, {}, {}};
  for (int n = 0; n < kNumberCount; ++n)
    piece.numbers[n] = static_cast<float>(number_of(point, n).value_or(0));
  return piece;
}

std::vector<NumberPiece> pieces_of_runs(const std::vector<Run>& runs,
                                        std::span<const NamedMaterialDescription> materials) {
  std::vector<NumberPiece> pieces{{-kInfinity, 0, 0, -1, {}, {}}};
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const std::int32_t material = material_index(materials, runs[i].point->material);
    pieces.push_back(
        constant_piece(runs[i].begin, *runs[i].point, bits_of(*runs[i].point, material), material));
    if (runs[i].end != HUGE_VAL && (i + 1 == runs.size() || runs[i].end < runs[i + 1].begin))
      pieces.push_back({static_cast<float>(runs[i].end), 0, 0, -1, {}, {}});
  }
  return pieces;
}

/// Every number's own curve; all of them hold everywhere.
std::vector<NumberPiece> pieces_of_curve(const std::vector<TransferPoint>& points) {
  std::uint32_t given = 0;
  Curve<double> curves[kNumberCount];
  std::vector<double> cuts;
  for (const TransferPoint& point : points) given |= bits_of(point, -1);
  for (int n = 0; n < kNumberCount; ++n) {
    curves[n] = collect<double>(
        points, [n](const TransferPoint& p) { return number_of(p, n); }, 0.0);
    for (const auto& knot : curves[n].knots) cuts.push_back(knot.first);
  }
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end()), cuts.end());
  std::vector<NumberPiece> pieces;
  for (std::size_t i = 0; i <= cuts.size(); ++i) {
    const double v0 = cuts[i == 0 ? 0 : i - 1], v1 = cuts[std::min(i, cuts.size() - 1)];
    NumberPiece piece{
        i == 0 ? -kInfinity : static_cast<float>(v0), static_cast<float>(v0), given, -1, {}, {}};
    for (int n = 0; n < kNumberCount; ++n) {
      const double lower = curves[n].limit(v0, i > 0);
      piece.numbers[n] = static_cast<float>(lower);
      if (v1 > v0) piece.slopes[n] = static_cast<float>((curves[n].limit(v1, false) - lower) / (v1 - v0));
    }
    pieces.push_back(piece);
  }
  return pieces;
}

}  // namespace

CompiledRule::CompiledRule(const RuleDescription& rule, int volume, int along, const RuleContext& context)
    : volume_(volume), along_(along), column_form_(rule.column_form) {
  if (along < 0) {
    columns_.push_back(compile_column(rule, rule.points, context));
  } else {
    for (const RuleColumn& column : rule.columns) {
      column_at_.push_back(static_cast<float>(column.at));
      columns_.push_back(compile_column(rule, column.points, context));
    }
  }
  for (const Column& column : columns_) {
    for (const NumberPiece& piece : column.pieces) given_ |= piece.given;
    column_views_.push_back(
        {column.optics.view(), column.pieces.data(), static_cast<std::int32_t>(column.pieces.size())});
  }
}

CompiledRule::Column CompiledRule::compile_column(const RuleDescription& rule,
                                                  std::vector<TransferPoint> points,
                                                  const RuleContext& context) const {
  bool dense = false;
  for (TransferPoint& point : points) {
    const std::int32_t material = material_index(context.materials, point.material);
    if (material >= 0) take_from_material(context.materials[material], point);
    dense |= has_extinction(point);
  }
  const bool curve = is_curve(rule.kind);
  const std::vector<Run> runs = curve ? std::vector<Run>{} : runs_of(rule.kind, points);
  std::vector<NumberPiece> pieces = curve ? pieces_of_curve(points) : pieces_of_runs(runs, context.materials);
  // Where a function has an extinction of its own only, it has colours: one that gives none is compiled
  // with 1.
  for (TransferPoint& point : points) {
    if (!dense) {
      point.mu_t_per_mm = 1;
    } else if (!curve && point.opacity) {
      point.mu_t_per_mm = mu_t_from_opacity(*point.opacity, context.reference_length_mm);
      point.opacity.reset();
    }
  }
  TransferDescription optics;
  optics.reference_length_mm = context.reference_length_mm;
  optics.density_scale = dense ? context.density_scale : 1;
  optics.points = curve ? std::move(points) : points_of_runs(runs);
  return {TransferFunction(optics), std::move(pieces)};
}

RuleView CompiledRule::view() const {
  RuleView view;
  view.volume = volume_;
  view.along = along_;
  view.column_form = column_form_;
  view.columns = column_views_.data();
  view.column_at = column_at_.data();
  view.column_count = static_cast<std::int32_t>(column_views_.size());
  view.given = given_;
  return view;
}

bool CompiledRule::emits() const {
  return std::any_of(columns_.begin(), columns_.end(), [](const Column& c) { return c.optics.emits(); });
}

}  // namespace voxlume
