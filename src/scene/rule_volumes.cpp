#include "scene/rule_volumes.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "base/parallel.h"
#include "base/progress_parts.h"
#include "grid/derive.h"
#include "scene/label_values.h"
#include "scene/open_volume.h"
#include "scene/recenter.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, where, message);
}

Affinef composed(const Affinef& outer, const Affinef& inner) {
  const Affined o(outer), i(inner);
  return Affinef(
      Affined(o.vector(i.column_x), o.vector(i.column_y), o.vector(i.column_z), o.point(i.translation)));
}

bool same_grid(const GridView& a, const GridView& b) {
  const auto same = [](Vec3f x, Vec3f y) { return x == y; };
  const Affinef &p = a.world_from_index, &q = b.world_from_index;
  return std::equal(a.size, a.size + 3, b.size) && same(p.column_x, q.column_x) &&
         same(p.column_y, q.column_y) && same(p.column_z, q.column_z) && same(p.translation, q.translation);
}

/// The smallest box of the proxy's index space that holds the main volume.
Box3f main_in_proxy(const RuleVolumeView& proxy, const GridView& main) {
  const Box3f domain = main.index_box();
  Box3f out;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3f p;
    for (int a = 0; a < 3; ++a) p[a] = corner >> a & 1 ? domain.upper[a] : domain.lower[a];
    out.extend(proxy.index_of(p));
  }
  return out;
}

/// Whether every point of the main volume is inside the proxy's grid, rounding aside.
bool covers(const RuleVolumeView& proxy, const GridView& main) {
  if (proxy.is_main_grid) return true;
  const Box3f inside = main_in_proxy(proxy, main), box = proxy.grid.index_box();
  for (int a = 0; a < 3; ++a)
    if (!(inside.lower[a] > box.lower[a] + 1e-2f && inside.upper[a] < box.upper[a] - 1e-2f)) return false;
  return true;
}

/// Whether the values of a volume of labels hold none of these.
bool has_none_of(const GridView& labels, const std::vector<std::int64_t>& wanted) {
  std::atomic<bool> found{false};
  with_voxels(labels.type, labels.voxels, [&](const auto* voxels) {
    parallel_for(labels.size[2], 1, [&](std::int64_t k) {
      for (std::int64_t i = k * labels.stride_k; i < (k + 1) * labels.stride_k && !found; ++i)
        for (const std::int64_t label : wanted)
          if (static_cast<double>(voxels[i]) == static_cast<double>(label)) found = true;
    });
  });
  return !found;
}

std::vector<float> inside_labels(const ProxyDescription& proxy, const std::string& where) {
  if (proxy.labels.empty()) refuse(where + "/labels", "found none, expected the labels that are inside");
  std::vector<float> labels;
  for (const std::int64_t label : proxy.labels) labels.push_back(static_cast<float>(label));
  return labels;
}

}  // namespace

Volume proxy_volume(const ProxyDescription& proxy, const Volume& from, const std::string& where,
                    const Progress& progress) {
  switch (proxy.kind) {
    case ProxyKind::kGradient:
      return gradient_magnitude(from, progress);
    case ProxyKind::kSmoothed:
      return smoothed(from, proxy.sigma_mm, progress);
    case ProxyKind::kDistance:
      return signed_distance(from, inside_labels(proxy, where), progress);
    case ProxyKind::kFile:
      break;
  }
  VolumeDescription file;
  file.path = proxy.path;
  try {
    return open_volume(file);
  } catch (const Error& e) {
    throw Error(e.code(), where + "/path", e.what());
  }
}

RuleVolumes::RuleVolumes(const Volume& main, const VolumeStatistics& statistics,
                         const std::vector<ProxyDescription>& proxies, const Double3& origin_mm,
                         const Progress& progress) {
  RuleVolume data;
  data.name = "data";
  data.view.grid = make_grid_view(moved_to_origin(main, origin_mm));
  data.view.inverse_gradient_scale = 1 / statistics.gradient_p999;
  data.values = {statistics.lower, statistics.upper};
  data.has_nonfinite = statistics.nonfinite_voxels > 0;
  volumes_.push_back(data);
  for (std::size_t i = 0; i < proxies.size(); ++i) {
    const ProxyDescription& proxy = proxies[i];
    const std::string where = "/proxies/" + std::to_string(i);
    const auto named = [&](const std::string& name) {
      return std::find_if(volumes_.begin(), volumes_.end(), [&](const auto& v) { return v.name == name; });
    };
    if (proxy.name.empty() || proxy.name == "opacity" || named(proxy.name) != volumes_.end())
      refuse(
          where + "/name",
          fmt::format(
              "found \"{}\", expected a name that is neither empty, nor data or opacity, nor another proxy's",
              proxy.name));
    const bool from_file = proxy.kind == ProxyKind::kFile;
    if (from_file && proxy.path.empty()) refuse(where + "/path", "found \"\", expected a volume file");
    if (!from_file && !proxy.path.empty()) refuse(where + "/path", "a derived volume has none");
    const auto of = named(proxy.of);
    if (!from_file && of == volumes_.end())
      refuse(where + "/of", fmt::format("found \"{}\", expected \"data\" or a proxy further up", proxy.of));
    if (proxy.kind == ProxyKind::kDistance && of != volumes_.begin() && !of->view.nearest)
      refuse(where + "/of", fmt::format("found \"{}\", which is interpolated, expected labels", proxy.of));
    const auto number = from_file ? 0 : static_cast<std::size_t>(of - volumes_.begin());
    if (proxy.kind == ProxyKind::kDistance && has_none_of(of->view.grid, proxy.labels))
      warnings_.push_back(where + "/labels: none of them occurs in \"" + proxy.of + "\"");
    // Its voxels, and looking them over.
    const int part = 2 * static_cast<int>(i), parts = 2 * static_cast<int>(proxies.size());
    Volume volume =
        proxy_volume(proxy, number == 0 ? main : voxels_[number - 1], where, part_of(progress, part, parts));
    add(proxy, std::move(volume), origin_mm, where, part_of(progress, part + 1, parts));
    // Where the gradient is large says nothing about which way a surface faces.
    if (proxy.kind == ProxyKind::kGradient)
      volumes_.back().view.surface_volume = volumes_[number].view.surface_volume;
  }
}

void RuleVolumes::add(const ProxyDescription& proxy, Volume volume, const Double3& origin_mm,
                      const std::string& where, const Progress& progress) {
  warnings_.insert(warnings_.end(), volume.warnings.begin(), volume.warnings.end());
  voxels_.push_back(std::move(volume));
  RuleVolume out;
  out.name = proxy.name;
  RuleVolumeView& view = out.view;
  view.grid = make_grid_view(moved_to_origin(voxels_.back(), origin_mm));
  const GridView& main = volumes_.front().view.grid;
  view.is_main_grid = same_grid(view.grid, main);
  view.index_from_main = composed(view.grid.index_from_world, main.world_from_index);
  view.nearest = proxy.lookup == Lookup::kNearest;
  view.surface_volume = view.nearest ? 0 : static_cast<std::int32_t>(volumes_.size());
  const VolumeStatistics statistics = compute_statistics(view.grid, progress);
  const std::string file = proxy.kind == ProxyKind::kFile ? proxy.path : where;
  if (!std::isfinite(statistics.lower) || !std::isfinite(statistics.upper))
    throw Error(ErrorCode::kUnsupported, file, "its values exceed what a 32-bit float holds; rescale them");
  out.values = {statistics.lower, statistics.upper};
  out.has_nonfinite = statistics.nonfinite_voxels > 0;
  view.inverse_gradient_scale = 1 / statistics.gradient_p999;
  out.covers_main = covers(view, main);
  if (out.has_nonfinite)
    warnings_.push_back(fmt::format("{}: {} voxels are not finite; rules do not apply there", where,
                                    statistics.nonfinite_voxels));
  if (!view.is_main_grid && intersect(main_in_proxy(view, main), view.grid.index_box()).empty())
    warnings_.push_back(where + ": \"" + proxy.name +
                        "\" lies nowhere in the volume, so its rules apply nowhere");
  if (view.nearest) {
    label_values(view.grid, file);  // refuses what no labels are
    if (proxy.outline == Outline::kSmooth) {
      leads_.push_back(label_leads(view.grid));
      view.leads = leads_.back().data();
    }
  }
  volumes_.push_back(std::move(out));
}

}  // namespace voxlume
