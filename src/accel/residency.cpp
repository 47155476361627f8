#include "accel/residency.h"

#include "accel/majorant_grid.h"

namespace voxlume {

void ResidencyOctree::update(const TransferFunction& transfer) {
  bricks_.update(transfer);
  const OctreeView octree = bricks_.view();
  struct Place {
    std::int32_t i, j, k;
  };
  nodes_.assign(1, {});
  std::vector<Place> places{{0, 0, 0}};  // of the nodes, in units of their level
  std::size_t begin = 0;
  for (int level = octree.top_level; level >= 0; --level) {
    const std::size_t end = nodes_.size();
    const OctreeLevel& majorants = octree.levels[level];
    for (std::size_t n = begin; n < end; ++n) {
      const Place at = places[n];
      bool inside = true;
      for (const auto& [place, count] :
           {std::pair{at.i, octree.count[0]}, {at.j, octree.count[1]}, {at.k, octree.count[2]}})
        inside &= std::int64_t{place} << level < count;
      const float mu_maj =
          inside ? majorants.mu_maj[at.k * majorants.count_ij + std::int64_t{at.j} * majorants.count_i + at.i]
                 : 0.0f;
      if (!(mu_maj > 0)) continue;
      if (level == 0) {
        nodes_[n].mu_maj = mu_maj;
        continue;
      }
      nodes_[n].children = static_cast<std::uint32_t>(nodes_.size());
      nodes_.resize(nodes_.size() + 8);
      for (int part = 0; part < 8; ++part)
        places.push_back({2 * at.i + (part & 1), 2 * at.j + (part >> 1 & 1), 2 * at.k + (part >> 2)});
    }
    begin = end;
  }
}

ResidencyView ResidencyOctree::view() const {
  const OctreeView octree = bricks_.view();
  ResidencyView view;
  static_cast<CellGrid&>(view) = octree;
  view.nodes = nodes_.data();
  view.top_level = octree.top_level;
  return view;
}

int default_brick_voxels(const GridView& grid) { return default_macrocell_voxels(grid); }

}  // namespace voxlume
