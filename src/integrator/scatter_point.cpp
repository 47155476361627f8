#include "integrator/scatter_point.h"

#include "material/surface_share.h"

namespace voxlume {

Vec3f labelled_albedo(const LabelsView& labels, Vec3f p_world, Vec3f albedo) noexcept {
  const Vec3f p_index = labels.grid.index_from_world.point(p_world);
  const Box3f box = labels.grid.index_box();
  if (!box.contains(p_index)) return albedo;
  const float label = sample_nearest(labels.grid, p_index);
  if (!(label >= 0) || label >= static_cast<float>(labels.color_count)) return albedo;
  const Vec3f color = labels.color[static_cast<std::int32_t>(label)];
  return color.x < 0 ? albedo : albedo + (color - albedo) * labels.strength;
}

Vec3f face_normals(const Box3f& clip_world, const GridView& grid, Vec3f p_index, Vec3f p_world) noexcept {
  const float reach_mm = grid.step_mm;
  const Box3f domain = grid.index_box();
  const FaceReach reach(clip_world, grid);
  if (reach.deep_index.contains(p_index) && reach.deep_world.contains(p_world)) return Vec3f(0);
  Vec3f sum(0);
  for (int a = 0; a < 3; ++a) {
    Vec3f axis(0);
    axis[a] = 1;
    const auto add = [&](float distance_mm, Vec3f outward) {
      if (distance_mm < reach_mm) sum += outward * (1.0f - std::max(distance_mm, 0.0f) / reach_mm);
    };
    add(p_world[a] - clip_world.lower[a], -axis);
    add(clip_world.upper[a] - p_world[a], axis);
    const float spacing_mm = grid.step_mm / grid.step_index[a];
    const Vec3f direction = grid.world_from_index.vector(axis) / spacing_mm;
    add((p_index[a] - domain.lower[a]) * spacing_mm, -direction);
    add((domain.upper[a] - p_index[a]) * spacing_mm, direction);
  }
  return sum;
}

MatterPoint matter_at(const SceneView& scene, Vec3f p_index, float value) noexcept {
  const GridView& grid = scene.medium.grid;
  const ScatteringView& scattering = scene.scattering;
  const Coefficients optics = classify(scene.medium.transfer, value);
  const Vec3f p_world = grid.world_from_index.point(p_index);

  MatterPoint point;
  point.emission = optics.emission;
  point.p_world = p_world;
  ScatterPoint& scatter = point.scatter;
  scatter.normal = Vec3f(0);
  scatter.p_brdf = 0;
  scatter.albedo =
      scene.labels.color_count ? labelled_albedo(scene.labels, p_world, optics.albedo) : optics.albedo;
  scatter.g = scattering.g;
  scatter.alpha = scattering.alpha;
  scatter.f0 = scattering.f0;
  if (scattering.shading == Shading::kPhase) return point;

  const Vec3f outward = sample_gradient(grid, p_index) * -scattering.inverse_gradient_scale +
                        face_normals(scene.clip_world, grid, p_index, p_world);
  const float magnitude = length(outward);
  if (!(magnitude > 1e-6f) || !std::isfinite(magnitude)) return point;
  scatter.normal = outward / magnitude;
  scatter.p_brdf =
      scattering.shading == Shading::kBrdf
          ? 1.0f
          : surface_share(scattering.surface_share, scattering.gradient_factor, scattering.opacity_modulated,
                          opacity_of(scene.medium.transfer, optics.mu_t), magnitude);
  return point;
}

}  // namespace voxlume
