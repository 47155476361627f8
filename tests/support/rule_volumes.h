#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "grid/volume_statistics.h"
#include "support/volumes.h"
#include "transfer/classifier.h"

namespace voxlume::test {

/// Volumes as rules read them; the first is "data".
class RuleVolumeSet {
 public:
  explicit RuleVolumeSet(Volume main) { add("data", std::move(main), Lookup::kLinear); }

  RuleVolumeSet& add(const std::string& name, Volume volume, Lookup lookup,
                     Outline outline = Outline::kVoxels) {
    voxels_.push_back(std::move(volume));
    RuleVolume out;
    out.name = name;
    RuleVolumeView& view = out.view;
    view.grid = make_grid_view(voxels_.back());
    view.nearest = lookup == Lookup::kNearest;
    view.surface_volume = view.nearest ? 0 : static_cast<std::int32_t>(volumes_.size());
    if (view.nearest && outline == Outline::kSmooth) {
      leads_.push_back(std::make_shared<const std::vector<std::uint8_t>>(label_leads(view.grid)));
      view.leads = leads_.back()->data();
    }
    const VolumeStatistics statistics = compute_statistics(view.grid);
    out.values = {statistics.lower, statistics.upper};
    out.has_nonfinite = statistics.nonfinite_voxels > 0;
    if (!volumes_.empty()) place(out);
    volumes_.push_back(out);
    return *this;
  }

  std::span<const RuleVolume> all() const { return volumes_; }
  const Volume& voxels(int volume) const { return voxels_[static_cast<std::size_t>(volume)]; }
  const GridView& main() const { return volumes_.front().view.grid; }

 private:
  void place(RuleVolume& out) const {
    RuleVolumeView& view = out.view;
    const Volume &a = voxels_.front(), &b = voxels_.back();
    view.is_main_grid = a.size == b.size && a.spacing_mm == b.spacing_mm && a.origin_mm == b.origin_mm &&
                        a.direction == b.direction;
    const Affined to_index(view.grid.index_from_world), to_world(main().world_from_index);
    view.index_from_main =
        Affinef(Affined(to_index.vector(to_world.column_x), to_index.vector(to_world.column_y),
                        to_index.vector(to_world.column_z), to_index.point(to_world.translation)));
    if (view.is_main_grid) return;
    const Box3f domain = main().index_box(), box = view.grid.index_box();
    for (int corner = 0; corner < 8; ++corner) {
      Vec3f p;
      for (int axis = 0; axis < 3; ++axis)
        p[axis] = corner >> axis & 1 ? domain.upper[axis] : domain.lower[axis];
      const Vec3f q = view.index_from_main.point(p);
      for (int axis = 0; axis < 3; ++axis)
        out.covers_main &= q[axis] > box.lower[axis] + 0.01f && q[axis] < box.upper[axis] - 0.01f;
    }
  }

  std::vector<Volume> voxels_;
  std::vector<std::shared_ptr<const std::vector<std::uint8_t>>> leads_;
  std::vector<RuleVolume> volumes_;
};

/// A volume of one row: voxel i has values[i].
inline Volume row_volume(const std::vector<float>& values) {
  return make_volume<float>({static_cast<std::int64_t>(values.size()), 1, 1},
                            [&](auto i, auto, auto) { return values[static_cast<std::size_t>(i)]; });
}

inline TransferPoint opacity_point(double value, double opacity) {
  TransferPoint point;
  point.value = value;
  point.opacity = opacity;
  return point;
}
inline TransferPoint color_point(double value, Color color) {
  TransferPoint point;
  point.value = value;
  point.color = color;
  return point;
}
inline TransferPoint material_point(double value, const std::string& material) {
  TransferPoint point;
  point.value = value;
  point.material = material;
  return point;
}
inline RuleDescription rule_of(RuleKind kind, const std::string& volume, std::vector<TransferPoint> points) {
  RuleDescription rule;
  rule.kind = kind;
  rule.volume = volume;
  rule.points = std::move(points);
  return rule;
}
inline RuleDescription rule_of(RuleKind kind, const std::string& volume, const std::string& along,
                               ColumnForm form, std::vector<RuleColumn> columns) {
  RuleDescription rule;
  rule.kind = kind;
  rule.volume = volume;
  rule.along = along;
  rule.column_form = form;
  rule.columns = std::move(columns);
  return rule;
}

}  // namespace voxlume::test
