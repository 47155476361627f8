#include "server/volume_facts.h"

#include <fmt/format.h>

#include <algorithm>

#include "grid/grid_view.h"
#include "scene/presets.h"
#include "server/hex_text.h"

namespace voxlume::server {

using nlohmann::json;

namespace {

constexpr std::size_t kBins = 512;
constexpr double kPercents[] = {0.1, 1, 5, 50, 95, 99, 99.9};
/// A page lists no more than this.
constexpr std::size_t kMostLabels = 4096;

json triple(Vec3d v) { return {v.x, v.y, v.z}; }

}  // namespace

json histogram_json(const VolumeStatistics& statistics) {
  std::vector<std::uint64_t> counts(kBins, 0);
  const double lower = statistics.lower;
  const double range = static_cast<double>(statistics.upper) - lower;
  for (const auto& [value, count] : statistics.histogram) {
    const double share = range > 0 ? (value - lower) / range : 0;
    counts[static_cast<std::size_t>(std::clamp(share * kBins, 0.0, kBins - 1.0))] += count;
  }
  return {{"lo", statistics.lower}, {"hi", statistics.upper}, {"counts", counts}};
}

json volume_json(const std::string& name, const Volume& volume, const VolumeStatistics& statistics) {
  json percentiles = json::object();
  for (const double p : kPercents) percentiles[fmt::format("{}", p)] = statistics.percentile(p / 100);
  const Box3d bounds = world_bounds(volume);
  return {{"name", name},
          {"size", volume.size},
          {"spacing_mm", volume.spacing_mm},
          {"direction", volume.direction},
          {"type", voxel_type_name(volume.type)},
          {"modality", volume.modality},
          {"bounds_mm", {triple(bounds.lower), triple(bounds.upper)}},
          {"range", {statistics.lower, statistics.upper}},
          {"percentiles", percentiles},
          {"histogram", histogram_json(statistics)},
          {"hounsfield", is_hounsfield(volume, statistics)},
          {"voxels", volume.voxel_count()},
          {"warnings", volume.warnings}};
}

json labels_json(const SideVolume& labels) {
  json out = json::array();
  for (const auto& [value, count] : labels.statistics.histogram) {
    if (count == 0 || value == 0 || out.size() >= kMostLabels) continue;
    const auto index = static_cast<std::size_t>(std::max(value, 0.0f));
    const bool known = value > 0 && index < labels.table.colors.size();
    const Vec3f color = known ? labels.table.colors[index] : Vec3f(0.5f);
    out.push_back({{"value", value},
                   {"name", label_name(labels.table, value)},
                   {"color", hex_text({{color.x, color.y, color.z}})}});
  }
  return out;
}

}  // namespace voxlume::server
