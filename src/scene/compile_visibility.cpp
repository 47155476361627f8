#include <cmath>

#include "scene/compile.h"
#include "scene/presets.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// The number of the volume of that name; throws at `where` if there is none.
std::int32_t number_of(const std::string& name, std::span<const RuleVolume> volumes,
                       const std::string& where) {
  std::string known;
  for (std::size_t i = 0; i < volumes.size(); ++i) {
    if (volumes[i].name == name) return static_cast<std::int32_t>(i);
    known += (i == 0 ? "" : ", ") + volumes[i].name;
  }
  throw Error(ErrorCode::kBadParameter, where, "unknown volume \"" + name + "\"; expected one of " + known);
}

void put_range(const std::optional<std::array<double, 2>>& range, int i, ImportanceRule& rule) {
  rule.lower[i] = range ? static_cast<float>((*range)[0]) : -INFINITY;
  rule.upper[i] = range ? static_cast<float>((*range)[1]) : INFINITY;
}

Vec3f to_float(const Double3& p) { return Vec3f(Vec3d(p[0], p[1], p[2])); }

ImportanceRule compiled(const ImportanceDescription& d, std::span<const RuleVolume> volumes,
                        const std::string& where) {
  ImportanceRule rule{};
  rule.importance = static_cast<float>(d.importance);
  const std::int32_t volume = number_of(d.volume, volumes, where + "/volume");
  rule.volume = d.range ? volume : -1;
  rule.along = d.along.empty() ? -1 : number_of(d.along, volumes, where + "/along");
  put_range(d.range, 0, rule);
  put_range(d.along_range, 1, rule);
  rule.box = {};
  if (d.center_mm) rule.center = to_float(*d.center_mm);
  rule.radius2 = d.radius_mm ? static_cast<float>(*d.radius_mm * *d.radius_mm) : -1.0f;
  if (d.size_mm)
    rule.box = {rule.center - to_float(*d.size_mm) * 0.5f, rule.center + to_float(*d.size_mm) * 0.5f};
  return rule;
}

}  // namespace

std::vector<ImportanceRule> CompiledScene::compile_importance(const SceneDescription& local,
                                                              std::span<const RuleVolume> volumes) {
  std::vector<ImportanceRule> out;
  if (!local.visibility) return out;
  if (local.render.extinction == Extinction::kRgb)
    throw Error(ErrorCode::kUnsupported, "/visibility", "needs extinction single");
  for (std::size_t i = 0; i < local.visibility->important.size(); ++i)
    out.push_back(
        compiled(local.visibility->important[i], volumes, "/visibility/important/" + std::to_string(i)));
  return out;
}

void CompiledScene::put_visibility(std::vector<ImportanceRule> importance, const SceneDescription& local,
                                   bool same_view) {
  VisibilityView& view = view_.visibility;
  view = {};
  if (!local.visibility || local.visibility->important.empty()) {
    pixel_lists_.reset();
    return;
  }
  const VisibilityDescription& d = *local.visibility;
  view.on = true;
  importance_ = std::move(importance);
  view.importance.rules = importance_.data();
  view.importance.rule_count = static_cast<std::int32_t>(importance_.size());
  const std::span<const RuleVolume> volumes = rule_volumes_->volumes();
  for (std::size_t i = 0; i < volumes.size(); ++i) view.importance.volumes[i] = volumes[i].view;
  const double unit_mm = 0.5 * longest_side_mm(volume_);
  view.weights = {static_cast<float>(d.p), static_cast<float>(d.q / unit_mm),
                  static_cast<float>(d.r / unit_mm), static_cast<float>(d.lambda)};
  view.lights = d.lights;
  view.light_samples = d.light_samples;
  if (!same_view || !pixel_lists_) pixel_lists_.emplace(view_, ListRefinement{d.ray_samples, d.ray_passes});
  view.pixels = pixel_lists_->view();
}

}  // namespace voxlume
