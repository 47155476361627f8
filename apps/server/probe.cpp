#include "server/probe.h"

#include <algorithm>
#include <cmath>

#include "grid/grid_view.h"
#include "grid/sample.h"

namespace voxlume::server {

using nlohmann::json;

std::optional<Vec3d> place_in_picture(const LiveFrame& frame, double x, double y) {
  const int width = frame.picture.width, height = frame.picture.height;
  const auto pixel = [](double share, int count) {
    return std::clamp(static_cast<int>(share * count), 0, count - 1);
  };
  const std::size_t i = static_cast<std::size_t>(pixel(y, height)) * width + pixel(x, width);
  if (i >= frame.depth_mm.size() || !(frame.depth_mm[i] > 0)) return std::nullopt;
  const CameraView& camera = frame.camera;
  const CameraRay ray = camera_ray(camera, static_cast<float>(x) * camera.width_px,
                                   static_cast<float>(y) * camera.height_px, 0.5f, 0.5f);
  // From the eye: an orthographic ray begins beside it.
  return Vec3d(ray.origin) + Vec3d(ray.direction) * static_cast<double>(frame.depth_mm[i]);
}

bool is_inside(const Volume& volume, Vec3d p_world) {
  return make_grid_view(volume).index_box().contains(
      Vec3f(world_from_index(volume).inverse().point(p_world)));
}

json data_at(const Volume& volume, Vec3d p_world) {
  const GridView grid = make_grid_view(volume);
  const Vec3d p_index = world_from_index(volume).inverse().point(p_world);
  json voxel = json::array();
  for (int a = 0; a < 3; ++a)
    voxel.push_back(std::clamp<std::int64_t>(std::llround(p_index[a]), 0, volume.size[a] - 1));
  const float value = sample_trilinear(grid, Vec3f(p_index));
  return {{"position_mm", {p_world.x, p_world.y, p_world.z}},
          {"voxel", voxel},
          {"value", std::isfinite(value) ? json(value) : json(nullptr)}};
}

json labels_at(const SceneDescription& scene, SideVolumes& sides, Vec3d p_world) {
  json out = json::array();
  for (const std::string& name : label_volume_names(scene)) {
    try {
      const auto side = sides.find(scene, name);
      const GridView grid = make_grid_view(side->volume);
      const Vec3f p_index(world_from_index(side->volume).inverse().point(p_world));
      if (!grid.index_box().contains(p_index)) continue;
      const float value = sample_nearest(grid, p_index);
      out.push_back({{"of", name}, {"value", value}, {"name", label_name(side->table, value)}});
    } catch (const std::exception&) {
      continue;  // the picture's own trouble tells of it
    }
  }
  return out;
}

}  // namespace voxlume::server
