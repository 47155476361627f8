#include "scene/check_picture.h"

#include <fmt/format.h>

#include <string>

#include "camera/camera.h"
#include "grid/grid_view.h"
#include "light/compile_lights.h"
#include "scene/recenter.h"
#include "scene/resolve.h"
#include "scene/tracking_choice.h"
#include "transfer/transfer_function.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// Looks at one extinction after the other. What several rules make of them together is known when they are
/// compiled.
class DepthCheck {
 public:
  DepthCheck(const TransferDescription& transfer, double step_mm) : transfer_(transfer), step_mm_(step_mm) {}

  /// A point or material at `where`.
  template <class Matter>
  void check(const Matter& matter, const std::string& where) const {
    const bool by_opacity = !matter.mu_t_per_mm && matter.opacity;
    const double reference_mm = *transfer_.reference_length_mm;
    const double mu_t = matter.mu_t_per_mm ? *matter.mu_t_per_mm
                        : by_opacity       ? mu_t_from_opacity(*matter.opacity, reference_mm)
                                           : 0;
    const double depth = mu_t * step_mm_, scaled = depth * transfer_.density_scale;
    if (!(scaled > kMostVoxelDepth)) return;
    if (!(depth > kMostVoxelDepth)) refuse("/transfer/density_scale", transfer_.density_scale, scaled);
    if (by_opacity) refuse("/transfer/reference_length_mm", reference_mm, scaled);
    refuse(where + "/mu_t_per_mm", mu_t, scaled);
  }
  void check_points(const std::vector<TransferPoint>& points, const std::string& where) const {
    for (std::size_t i = 0; i < points.size(); ++i) check(points[i], where + "/" + std::to_string(i));
  }
  void check_rule(const RuleDescription& rule, const std::string& where) const {
    check_points(rule.points, where + "/points");
    for (std::size_t i = 0; i < rule.columns.size(); ++i)
      check_points(rule.columns[i].points, fmt::format("{}/columns/{}/points", where, i));
  }

 private:
  [[noreturn]] static void refuse(const std::string& where, double found, double depth) {
    throw Error(ErrorCode::kBadParameter, where,
                fmt::format("found {}, which makes a voxel {:.3g} deep in optical depth; expected at most {}",
                            found, depth, kMostVoxelDepth));
  }

  const TransferDescription& transfer_;
  const double step_mm_;
};

void check_depths(const SceneDescription& scene, double step_mm) {
  const TransferDescription& transfer = scene.transfer;
  const DepthCheck depth(transfer, step_mm);
  depth.check_points(transfer.points, "/transfer/points");
  for (std::size_t i = 0; i < transfer.rules.size(); ++i)
    depth.check_rule(transfer.rules[i], "/transfer/rules/" + std::to_string(i));
  for (std::size_t i = 0; i < scene.materials.size(); ++i)
    depth.check(scene.materials[i], "/materials/" + std::to_string(i));
}

}  // namespace

void check_picture(const SceneDescription& scene, const Volume& volume) {
  const Double3 origin_mm = visible_sphere(volume, std::nullopt).center_mm;
  const SceneDescription local = moved_to_origin(scene, origin_mm);
  const Volume placed = moved_to_origin(volume, origin_mm);
  const BoundingSphere visible = visible_sphere(placed, local.clip);
  const Double3& c = visible.center_mm;
  const SceneSphere sphere{Vec3f(Vec3d(c[0], c[1], c[2])), static_cast<float>(visible.radius_mm)};
  const CameraView camera =
      compile_camera(local.camera, sphere.center_mm, sphere.radius_mm, local.image.width, local.image.height);
  Lights(*local.lights, *local.environment, nullptr, view_frame(camera), sphere);
  const GridView grid = make_grid_view(placed);
  check_depths(scene, grid.step_mm);
  check_march_steps(scene.render, grid);
}

}  // namespace voxlume
