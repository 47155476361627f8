#include "grid/grid_view.h"

namespace voxlume {

Affined world_from_index(const Volume& volume) {
  const auto column = [&](int a) {
    return Vec3d(volume.direction[a], volume.direction[3 + a], volume.direction[6 + a]) *
           volume.spacing_mm[a];
  };
  return {column(0), column(1), column(2),
          Vec3d(volume.origin_mm[0], volume.origin_mm[1], volume.origin_mm[2])};
}

GridView make_grid_view(const Volume& volume) {
  GridView view;
  view.voxels = volume.voxels.get();
  view.type = volume.type;
  for (int a = 0; a < 3; ++a) view.size[a] = static_cast<std::int32_t>(volume.size[a]);
  view.stride_j = volume.size[0];
  view.stride_k = volume.size[0] * volume.size[1];
  const Affined world = world_from_index(volume);
  view.world_from_index = Affinef(world);
  view.index_from_world = Affinef(world.inverse());
  const double step = std::min({volume.spacing_mm[0], volume.spacing_mm[1], volume.spacing_mm[2]});
  view.step_mm = static_cast<float>(step);
  for (int a = 0; a < 3; ++a) view.step_index[a] = static_cast<float>(step / volume.spacing_mm[a]);
  return view;
}

Box3d world_bounds(const Volume& volume) {
  const Affined world = world_from_index(volume);
  Box3d box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d p;
    for (int a = 0; a < 3; ++a) p[a] = (corner >> a & 1) ? volume.size[a] - 0.5 : -0.5;
    box.extend(world.point(p));
  }
  return box;
}

}  // namespace voxlume
