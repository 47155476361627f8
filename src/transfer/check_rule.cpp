#include <fmt/format.h>

#include <cmath>

#include "transfer/classifier.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, where, message);
}

bool is_material_rule(RuleKind kind) {
  return kind == RuleKind::kMaterialSteps || kind == RuleKind::kMaterialPoints;
}
bool is_discrete(RuleKind kind) {
  return kind == RuleKind::kCoefficientPoints || kind == RuleKind::kMaterialPoints;
}

/// Checks rules of one scene.
class RuleCheck {
 public:
  RuleCheck(std::span<const RuleVolume> volumes, bool has_own_points,
            std::span<const NamedMaterialDescription> materials)
      : volumes_(volumes), has_own_points_(has_own_points), materials_(materials) {}

  void check(const RuleDescription& rule, const std::string& where) {
    check_volume(rule.volume, is_discrete(rule.kind), where + "/volume");
    if (rule.along.empty()) {
      if (!rule.columns.empty()) refuse(where + "/columns", "found columns and no \"along\", expected both");
      check_points(rule, rule.points, where + "/points");
      return;
    }
    const bool discrete = rule.column_form == ColumnForm::kPoints;
    check_volume(rule.along, discrete, where + "/along");
    if (!rule.points.empty()) refuse(where + "/points", "found points in a 2-D rule, expected columns");
    if (rule.columns.empty()) refuse(where + "/columns", "found none, expected at least one");
    for (std::size_t i = 0; i < rule.columns.size(); ++i) {
      const std::string column = where + "/columns/" + std::to_string(i);
      check_value(rule.columns[i].at, i > 0 ? &rule.columns[i - 1].at : nullptr, false, column + "/at");
      if (discrete) check_label(rule.along, rule.columns[i].at, column + "/at");
      check_points(rule, rule.columns[i].points, column + "/points");
    }
  }

 private:
  const RuleVolume* find(const std::string& name) const {
    for (const RuleVolume& volume : volumes_)
      if (volume.name == name) return &volume;
    return nullptr;
  }

  void check_volume(const std::string& name, bool discrete, const std::string& where) const {
    if (name == "opacity") {
      if (discrete) refuse(where, "found \"opacity\" in a rule of discrete points, expected a label volume");
      if (!has_own_points_)
        refuse(where, "found \"opacity\" in a transfer function without points, expected points");
      return;
    }
    const RuleVolume* volume = find(name);
    if (!volume) {
      std::string known = "opacity";
      for (const RuleVolume& one : volumes_) known += ", " + one.name;
      refuse(where, fmt::format("found \"{}\", expected one of {}", name, known));
    }
    if (discrete && !volume->view.nearest)
      refuse(where, fmt::format("found \"{}\", which is interpolated, in a rule of discrete points; expected "
                                "a volume whose lookup is nearest",
                                name));
  }

  void check_value(double value, const double* before, bool may_repeat, const std::string& where) const {
    if (!std::isfinite(static_cast<float>(value))) refuse(where, "expected a finite 32-bit float");
    if (!before) return;
    // Values are looked up as floats.
    const auto a = static_cast<float>(*before), b = static_cast<float>(value);
    if (b < a || (b == a && !may_repeat))
      refuse(where, fmt::format("found {} after {}, expected values sorted{}", value, *before,
                                may_repeat ? "" : " and no two alike"));
  }

  void check_label(const std::string& name, double value, const std::string& where) const {
    const RuleVolume& volume = *find(name);
    if (value != std::floor(value)) refuse(where, fmt::format("found {}, expected a whole number", value));
    if (!(value >= volume.values.lower && value <= volume.values.upper))
      refuse(where, fmt::format("found label {}, expected one from {} to {}, which \"{}\" has", value,
                                volume.values.lower, volume.values.upper, name));
  }

  void check_points(const RuleDescription& rule, const std::vector<TransferPoint>& points,
                    const std::string& where) {
    if (points.empty()) refuse(where, "found none, expected at least one");
    const bool curve = rule.kind == RuleKind::kCoefficientCurve;
    bool by_opacity = false, by_extinction = false;
    for (std::size_t i = 0; i < points.size(); ++i) {
      const std::string address = where + "/" + std::to_string(i);
      check_value(points[i].value, i > 0 ? &points[i - 1].value : nullptr, curve, address + "/value");
      if (is_discrete(rule.kind)) check_label(rule.volume, points[i].value, address + "/value");
      check_material(rule, points[i], address);
      if (points[i].opacity && points[i].mu_t_per_mm)
        refuse(address, "found both opacity and mu_t_per_mm, expected one of them");
      by_opacity |= points[i].opacity.has_value();
      by_extinction |= points[i].mu_t_per_mm.has_value();
      if (curve && by_opacity && by_extinction)
        refuse(address, "found both opacity and mu_t_per_mm in one rule, expected one of them");
      if (!curve) check_extinction(points[i], address);
    }
    if (curve) note_extinction(by_opacity || by_extinction, where);
  }

  const NamedMaterialDescription* material(const std::string& name) const {
    for (const NamedMaterialDescription& one : materials_)
      if (one.name == name) return &one;
    return nullptr;
  }

  void check_material(const RuleDescription& rule, const TransferPoint& point,
                      const std::string& where) const {
    if (!is_material_rule(rule.kind)) {
      if (!point.material.empty())
        refuse(where + "/material", "found a material in a coefficient rule, expected kind mpctf or mdptf");
      return;
    }
    if (point.material.empty()) refuse(where, "missing key \"material\", which a material rule needs");
    if (!material(point.material))
      refuse(where + "/material", fmt::format("found \"{}\", expected a material of the scene or of the "
                                              "library (`voxlume materials` lists it)",
                                              point.material));
  }

  /// Points of steps, and discrete ones, either all have an extinction or none.
  void check_extinction(const TransferPoint& point, const std::string& where) {
    const NamedMaterialDescription* named = material(point.material);
    note_extinction(point.opacity || point.mu_t_per_mm || (named && (named->opacity || named->mu_t_per_mm)),
                    where);
  }

  void note_extinction(bool has_extinction, const std::string& where) {
    if (extinction_ && *extinction_ != has_extinction)
      refuse(where,
             fmt::format("found {}, expected an opacity (or mu_t_per_mm) of all points of the rule, or "
                         "of their materials, or of none; two rules do for some with and some without",
                         has_extinction ? "an extinction where points before have none"
                                        : "no extinction where points before have one"));
    extinction_ = has_extinction;
  }

  std::span<const RuleVolume> volumes_;
  bool has_own_points_;
  std::span<const NamedMaterialDescription> materials_;
  std::optional<bool> extinction_;
};

}  // namespace

void check_rule(const RuleDescription& rule, std::span<const RuleVolume> volumes, bool has_own_points,
                std::span<const NamedMaterialDescription> materials, const std::string& where) {
  RuleCheck(volumes, has_own_points, materials).check(rule, where);
}

}  // namespace voxlume
