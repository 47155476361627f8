#pragma once
#include <algorithm>
#include <string>
#include <vector>

#include "support/rule_volumes.h"

namespace voxlume::test {

/// Materials that random rules name: with an opacity, with an extinction, and with colours alone.
inline std::vector<NamedMaterialDescription> random_rule_materials() {
  std::vector<NamedMaterialDescription> out(3);
  out[0].name = "shell";
  out[0].opacity = 0.7;
  out[0].roughness = 0.2;
  out[1].name = "core";
  out[1].mu_t_per_mm = 2.5;
  out[1].color = Color{{0.9f, 0.4f, 0.1f}};
  out[2].name = "paint";
  out[2].color = Color{{0.1f, 0.4f, 0.9f}};
  out[2].anisotropy = 0.5;
  return out;
}

/// Rules of any kind over the volumes of a set; whatever they are, they are valid.
class RandomRules {
 public:
  RandomRules(const RuleVolumeSet& volumes, Rng& rng) : volumes_(volumes), rng_(rng) {}

  TransferDescription transfer(Merge merge, int rule_count) {
    TransferDescription out;
    out.reference_length_mm = 0.5 + u();
    out.density_scale = 0.5 + 2 * u();
    out.merge = merge;
    const bool has_points = u() < 0.8;
    if (has_points) out.points = curve(volumes_.all()[0].values, true);
    for (int i = 0; i < rule_count; ++i) out.rules.push_back(rule(has_points));
    return out;
  }

  RuleDescription rule(bool has_own_points) {
    RuleDescription out;
    const int kind = pick(5);
    out.kind = static_cast<RuleKind>(kind);
    const bool discrete = kind == 2 || kind == 4;
    out.volume = volume(discrete, has_own_points);
    gives_extinction_ = u() < 0.8;
    if (u() < 0.5) {
      out.points = points(out);
      return out;
    }
    out.column_form = static_cast<ColumnForm>(pick(3));
    out.along = volume(out.column_form == ColumnForm::kPoints, has_own_points);
    for (const float at : values(out.along, 1 + pick(6), out.column_form == ColumnForm::kPoints, false))
      out.columns.push_back({at, points(out)});
    return out;
  }

 private:
  double u() { return static_cast<double>(rng_.next()); }
  int pick(int count) { return std::min(static_cast<int>(u() * count), count - 1); }

  const RuleVolume& find(const std::string& name) const {
    for (const RuleVolume& volume : volumes_.all())
      if (volume.name == name) return volume;
    return volumes_.all()[0];
  }

  std::string volume(bool discrete, bool has_own_points) {
    std::vector<std::string> names;
    for (const RuleVolume& volume : volumes_.all())
      if (volume.view.nearest || !discrete) names.push_back(volume.name);
    if (has_own_points && !discrete) names.push_back("opacity");
    return names[static_cast<std::size_t>(pick(static_cast<int>(names.size())))];
  }

  ValueRange range(const std::string& name) const {
    return name == "opacity" ? ValueRange{0, 1} : find(name).values;
  }

  /// Sorted values within the volume's range; whole numbers where labels are asked for.
  std::vector<float> values(const std::string& name, int count, bool labels, bool may_repeat) {
    const ValueRange r = range(name);
    std::vector<float> out;
    for (int i = 0; i < count; ++i) {
      const float value = r.lower + (r.upper - r.lower) * rng_.next();
      out.push_back(labels || (name != "opacity" && find(name).view.nearest) ? std::floor(value) : value);
      if (may_repeat && u() < 0.2) out.push_back(out.back());
    }
    std::sort(out.begin(), out.end());
    if (!may_repeat) out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
  }

  void give(TransferPoint& point, bool extinction) {
    if (extinction) point.opacity = u() < 0.25 ? 0 : u() < 0.1 ? 1 : u();
    if (u() < 0.5) point.color = Color{{rng_.next(), rng_.next(), rng_.next()}};
    if (u() < 0.3) point.roughness = u();
    if (u() < 0.2) point.emission = Color{{rng_.next(), 0, 0}};
  }

  std::vector<TransferPoint> curve(ValueRange r, bool extinction) {
    std::vector<float> at;
    for (int i = 0; i < 2 + pick(6); ++i) at.push_back(r.lower + (r.upper - r.lower) * rng_.next());
    std::sort(at.begin(), at.end());
    std::vector<TransferPoint> out;
    for (const float value : at) {
      out.emplace_back().value = value;
      give(out.back(), extinction);
    }
    return out;
  }

  std::vector<TransferPoint> points(const RuleDescription& rule) {
    const bool discrete = rule.kind == RuleKind::kCoefficientPoints || rule.kind == RuleKind::kMaterialPoints;
    const bool material = rule.kind == RuleKind::kMaterialSteps || rule.kind == RuleKind::kMaterialPoints;
    std::vector<TransferPoint> out;
    for (const float value :
         values(rule.volume, 1 + pick(7), discrete, rule.kind == RuleKind::kCoefficientCurve)) {
      out.emplace_back().value = value;
      give(out.back(), gives_extinction_);
      if (!material) continue;
      const int which = pick(3);
      out.back().material = gives_extinction_ ? (which == 0   ? "shell"
                                                 : which == 1 ? "core"
                                                              : "paint")
                                              : "paint";
      if (gives_extinction_ && which < 2 && u() < 0.5) out.back().opacity.reset();
    }
    if (!rule_gives_anything(out)) out.front().color = Color{};
    return out;
  }
  static bool rule_gives_anything(const std::vector<TransferPoint>& points) {
    return std::any_of(points.begin(), points.end(), [](const TransferPoint& p) {
      return p.opacity || p.color || p.roughness || p.emission || !p.material.empty();
    });
  }

  const RuleVolumeSet& volumes_;
  Rng& rng_;
  bool gives_extinction_ = true;
};

}  // namespace voxlume::test
