#include "visibility/importance.h"

namespace voxlume {
namespace {

bool holds(const ImportanceView& view, const ImportanceRule& rule, Vec3f p_index) noexcept {
  const std::int32_t volumes[2] = {rule.volume, rule.along};
  if (rule.radius2 >= 0 || !rule.box.empty()) {
    const Vec3f p_world = view.volumes[0].grid.world_from_index.point(p_index);
    if (!rule.box.empty() && !rule.box.contains(p_world)) return false;
    const Vec3f off = p_world - rule.center;
    if (rule.radius2 >= 0 && !(dot(off, off) <= rule.radius2)) return false;
  }
  for (int i = 0; i < 2; ++i) {
    if (volumes[i] < 0) continue;
    const float value = look_up(view.volumes[volumes[i]], p_index);
    if (!(value >= rule.lower[i] && value <= rule.upper[i])) return false;
  }
  return true;
}

}  // namespace

float look_up_importance(const ImportanceView& view, Vec3f p_index) noexcept {
  if (view.lookup != ImportanceLookup::kInterpolated)
    return sample_trilinear(view.voxels, p_index) * kImportanceStep;
  float most = 0;
  for (std::int32_t i = 0; i < view.rule_count; ++i) {
    const ImportanceRule& rule = view.rules[i];
    if (rule.importance > most && holds(view, rule, p_index)) most = rule.importance;
  }
  return most;
}

}  // namespace voxlume
