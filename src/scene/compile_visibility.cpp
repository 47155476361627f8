#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/memory.h"
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

bool same_place(ImportanceDescription a, const ImportanceDescription& b) {
  a.importance = b.importance;
  return a == b;
}

/// Of entries for the same values and region the greatest importance counts, so one rule does for all.
std::vector<ImportanceRule> compiled(const std::vector<ImportanceDescription>& important,
                                     std::span<const RuleVolume> volumes) {
  std::vector<ImportanceRule> rules;
  std::vector<std::size_t> entry;  // of each rule
  for (std::size_t i = 0; i < important.size(); ++i) {
    const ImportanceRule rule = compiled(important[i], volumes, "/visibility/important/" + std::to_string(i));
    const auto same = std::find_if(entry.begin(), entry.end(),
                                   [&](std::size_t j) { return same_place(important[i], important[j]); });
    if (same == entry.end()) {
      rules.push_back(rule);
      entry.push_back(i);
    } else {
      float& importance = rules[static_cast<std::size_t>(same - entry.begin())].importance;
      importance = std::max(importance, rule.importance);
    }
  }
  return rules;
}

/// Throws unless there is memory for the lists of all pixels, as far as their number says.
void check_list_memory(const ImageDescription& image) {
  const double bytes = double{sizeof(PixelListsView::Head)} * image.width * image.height;
  if (bytes > static_cast<double>(available_memory_bytes()))
    throw Error(
        ErrorCode::kOutOfMemory, "/image/width",
        fmt::format("a picture of {} x {} with what is important needs {:.0f} MiB for its lists; render "
                    "it smaller",
                    image.width, image.height, bytes / (1 << 20)));
}

}  // namespace

std::optional<ImportanceField> CompiledScene::compile_importance(const SceneDescription& local,
                                                                 std::span<const RuleVolume> volumes,
                                                                 bool same) {
  if (!local.visibility) return {};
  if (local.visibility->important.empty()) return {};
  check_list_memory(local.image);
  if (same) return {};
  const VisibilityDescription& d = *local.visibility;
  return ImportanceField(compiled(d.important, volumes), volumes, d.lookup);
}

void CompiledScene::put_visibility(std::optional<ImportanceField> importance, const SceneDescription& local,
                                   bool same_lists, const ListProgress& progress) {
  VisibilityView& view = view_.visibility;
  view = {};
  importance_list_s_ = 0;
  if (!local.visibility || local.visibility->important.empty()) {
    pixel_lists_.reset();
    importance_.reset();
    return;
  }
  const VisibilityDescription& d = *local.visibility;
  view.on = true;
  if (importance) importance_ = std::move(importance);
  view.importance = importance_->view();
  const double unit_mm = view_.ray_march.counts_steps ? 1 : 0.5 * longest_side_mm(volume_);
  view.weights = {static_cast<float>(d.p), static_cast<float>(d.q / unit_mm),
                  static_cast<float>(d.r / unit_mm), static_cast<float>(d.lambda)};
  view.lights = d.lights;
  view.light_samples = d.light_samples;
  if (view_.ray_march.on) {  // which finds what is important anew along every ray
    pixel_lists_.reset();
    return;
  }
  if (!same_lists || !pixel_lists_) {
    pixel_lists_.reset();
    pixel_lists_.emplace(view_, ListRefinement{d.ray_samples, d.ray_passes}, progress);
    importance_list_s_ = pixel_lists_->seconds();
  }
  view.pixels = pixel_lists_->view();
}

}  // namespace voxlume
