#include "server/side_volumes.h"

#include <algorithm>
#include <cmath>

#include "grid/grid_view.h"
#include "scene/label_values.h"
#include "scene/rule_volumes.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

/// Scenes have three proxies and labels at most; some more are kept for those that come back by undo.
constexpr std::size_t kMostKept = 6;
/// Labels have names and colours up to here.
constexpr float kMostTabled = 65535;

/// The proxy that `proxy`, one of the scene's, is derived from; null: the main volume.
const ProxyDescription* source_of(const SceneDescription& scene, const ProxyDescription& proxy) {
  if (proxy.kind == ProxyKind::kFile) return nullptr;
  for (const ProxyDescription& other : scene.proxies) {
    if (&other == &proxy) break;  // only those further up
    if (other.name == proxy.of) return &other;
  }
  return nullptr;
}

}  // namespace

std::shared_ptr<const SideVolume> SideVolumes::find(const SceneDescription& scene, const std::string& name) {
  if (name == "labels" && scene.labels) {
    ProxyDescription labels;
    labels.path = scene.labels->path;
    labels.lookup = Lookup::kNearest;
    return keep({{labels}, scene.labels->names}, main_, "/labels");
  }
  for (std::size_t i = 0; i < scene.proxies.size(); ++i) {
    const ProxyDescription* const proxy = &scene.proxies[i];
    if (proxy->name != name) continue;
    Origin origin;
    for (const auto* p = proxy; p != nullptr; p = source_of(scene, *p)) origin.proxies.push_back(*p);
    const ProxyDescription* const source = source_of(scene, *proxy);
    const auto from = source ? find(scene, source->name) : nullptr;
    return keep(origin, from ? from->volume : main_, "/proxies/" + std::to_string(i));
  }
  throw Error(ErrorCode::kFileNotFound, "of", "the scene has no volume called \"" + name + "\"");
}

std::shared_ptr<const SideVolume> SideVolumes::keep(const Origin& origin, const Volume& from,
                                                    const std::string& where) {
  const std::lock_guard lock(mutex_);
  const auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.origin == origin; });
  if (found != kept_.end()) {
    kept_.splice(kept_.begin(), kept_, found);
    return kept_.front().volume;
  }
  const ProxyDescription& proxy = origin.proxies.front();
  auto side = std::make_shared<SideVolume>();
  side->volume = proxy_volume(proxy, from, where);
  const GridView grid = make_grid_view(side->volume);
  side->statistics = compute_statistics(grid);
  side->labels = proxy.lookup == Lookup::kNearest;
  if (side->labels) {
    side->label_values = label_values(grid, proxy.path);
    const float last = side->label_values.empty() ? 0 : side->label_values.back();
    side->table = read_label_table(proxy.path, origin.names,
                                   static_cast<std::size_t>(std::clamp(last, 0.0f, kMostTabled)) + 1);
  }
  kept_.push_front({origin, side});
  if (kept_.size() > kMostKept) kept_.pop_back();
  return side;
}

std::vector<std::string> label_volume_names(const SceneDescription& scene) {
  std::vector<std::string> out;
  for (const ProxyDescription& proxy : scene.proxies)
    if (proxy.lookup == Lookup::kNearest) out.push_back(proxy.name);
  if (scene.labels) out.push_back("labels");
  return out;
}

std::string label_name(const LabelTable& table, double value) {
  if (!(value >= 0 && value < static_cast<double>(table.names.size()))) return "";
  return table.names[static_cast<std::size_t>(value)];
}

}  // namespace voxlume::server
