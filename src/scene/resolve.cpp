#include "scene/resolve.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "grid/grid_view.h"
#include "scene/check_picture.h"
#include "scene/peers.h"
#include "scene/presets.h"
#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

Color grey_srgb(float encoded) {
  return {{linear_from_srgb(encoded), linear_from_srgb(encoded), linear_from_srgb(encoded)}};
}

/// A square light at `position` (in units of `radius_mm`, camera axes) that gives `irradiance` at the target.
LightDescription soft_box(Double3 position, double edge, double irradiance, Color color, double radius_mm) {
  LightDescription light;
  light.kind = LightKind::kRect;
  light.attached_to = Attachment::kCamera;
  light.color = color;
  double distance2 = 0;
  for (double& p : position) {
    distance2 += p * p;
    p *= radius_mm;
  }
  light.position_mm = position;
  light.size_mm = {edge * radius_mm, edge * radius_mm};
  light.intensity = irradiance * distance2 / (edge * edge);
  return light;
}

/// A warm key from the upper left and a cool, weaker rim from the right behind.
std::vector<LightDescription> default_lights(double radius_mm) {
  return {soft_box({-1.5, 2.0, 2.2}, 1.2, 6.5, {{1.0f, 0.955f, 0.90f}}, radius_mm),
          soft_box({2.6, 0.6, -0.6}, 1.2, 2.6, {{0.80f, 0.89f, 1.0f}}, radius_mm)};
}

EnvironmentDescription default_environment() {
  EnvironmentDescription environment;
  environment.color = {{0.92f, 0.96f, 1.0f}};
  environment.intensity = 0.45;
  return environment;
}

BackgroundDescription default_background() {
  BackgroundDescription background;
  background.color = grey_srgb(0.22f);
  return background;
}

constexpr int kDefaultSpp = 64;

}  // namespace

BoundingSphere visible_sphere(const Volume& volume, const std::optional<ClipDescription>& clip) {
  Vec3d last;
  for (int a = 0; a < 3; ++a) last[a] = static_cast<double>(volume.size[a]) - 0.5;
  const Affined world = world_from_index(volume);
  Vec3d center = world.point((last + Vec3d(-0.5)) * 0.5);
  double radius = length(world.point(last) - center);
  if (clip) {
    Box3d kept{{clip->x_mm[0], clip->y_mm[0], clip->z_mm[0]}, {clip->x_mm[1], clip->y_mm[1], clip->z_mm[1]}};
    const Box3d whole = world_bounds(volume);
    kept = intersect(kept, whole);
    for (int a = 0; a < 3; ++a)
      if (kept.lower[a] > kept.upper[a])
        throw Error(ErrorCode::kBadParameter, std::string("/clip/") + "xyz"[a] + "_mm",
                    fmt::format("keeps nothing of the volume, which lies from {:.6g} to {:.6g}",
                                whole.lower[a], whole.upper[a]));
    if (0.5 * length(kept.extent()) < radius) {
      center = kept.center();
      radius = 0.5 * length(kept.extent());
    }
  }
  return {{center.x, center.y, center.z}, std::max(radius, 1e-6)};
}

SceneDescription resolve(const SceneDescription& scene, const Volume& volume,
                         const VolumeStatistics& statistics) {
  SceneDescription out = scene;
  TransferDescription& transfer = out.transfer;
  // Rules do without points of the function's own.
  const bool needs_points = transfer.points.empty() && (transfer.rules.empty() || !transfer.preset.empty());
  const Preset& preset =
      transfer.preset.empty() ? automatic_preset(volume, statistics) : find_preset(transfer.preset);
  if (needs_points) {
    transfer.points = preset.points(statistics);
    transfer.preset = preset.name;
  }
  if (!transfer.reference_length_mm)
    transfer.reference_length_mm = default_reference_length_mm(volume, statistics);

  const BoundingSphere sphere = visible_sphere(volume, scene.clip);
  if (!out.lights) out.lights = default_lights(sphere.radius_mm);
  if (!out.environment) out.environment = default_environment();
  if (!out.background) out.background = default_background();
  if (!out.camera.target_mm) out.camera.target_mm = sphere.center_mm;
  if (!out.camera.fit_radius_mm) out.camera.fit_radius_mm = static_cast<float>(sphere.radius_mm);
  ImageDescription& image = out.image;
  if (!image.spp && !image.seconds && !image.noise) image.spp = kDefaultSpp;
  apply_integrator(out);
  check_picture(out, volume);
  return out;
}

}  // namespace voxlume
