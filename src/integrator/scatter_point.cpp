#include "integrator/scatter_point.h"

#include "grid/label_surface.h"
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

namespace {

/// What the transfer function or the rules say.
Classified classified(const Medium& medium, Vec3f p_index, float value) noexcept {
  if (medium.rules.rule_count > 0) return classify(medium.rules, p_index, value);
  Classified out;
  out.optics = classify(medium.transfer, value);
  return out;
}

/// Minus the data's gradient over its usual magnitude; at borders of labels their normal takes its place.
Vec3f data_normal(const SceneView& scene, const Classified& matter, Vec3f p_index) noexcept {
  if (scene.medium.rules.rule_count == 0)
    return sample_gradient(scene.medium.grid, p_index) * -scene.scattering.inverse_gradient_scale;
  const RuleVolumeView& surface = scene.medium.rules.volumes[matter.surface_volume];
  const Vec3f of_data =
      sample_gradient(surface.grid, surface.index_of(p_index)) * -surface.inverse_gradient_scale;
  if (matter.label_volume < 0) return of_data;
  const RuleVolumeView& labels = scene.medium.rules.volumes[matter.label_volume];
  const Vec3f of_labels = label_normal(labels.grid, labels.index_of(p_index), look_up(labels, p_index));
  return of_labels + of_data * (1.0f - std::min(length(of_labels), 1.0f));
}

/// Minus the gradient of the extinction in LPS [1/mm^2], over a voxel on either side as sample_gradient.
Vec3f extinction_fall(const Medium& medium, Vec3f p_index) noexcept {
  const GridView& grid = medium.grid;
  Vec3f along;
  for (int a = 0; a < 3; ++a) {
    Vec3f offset;
    offset[a] = grid.step_index[a];
    along[a] = (extinction_at(medium, p_index - offset) - extinction_at(medium, p_index + offset)) /
               (2.0f * grid.step_mm);
  }
  return grid.world_from_index.vector(along * grid.step_index) / grid.step_mm;
}

/// The highlight where the extinction is mu_t [1/mm], and its normal. At faces it falls to 0 within a voxel.
Highlight highlight_at(const SceneView& scene, Vec3f p_index, Vec3f p_world, float mu_t,
                       Vec3f& normal) noexcept {
  const GridView& grid = scene.medium.grid;
  const Vec3f faces = face_normals(scene.clip_world, grid, p_index, p_world);
  const Vec3f fall = extinction_fall(scene.medium, p_index) + faces * (0.5f * mu_t / grid.step_mm);
  const float magnitude = length(fall);
  if (!(magnitude > 0) || !std::isfinite(magnitude)) return {0, scene.scattering.shininess};
  normal = fall / magnitude;
  return {scene.scattering.highlight_mm2 * magnitude, scene.scattering.shininess};
}

ParticlePoint particles_of(const SceneView& scene, const Classified& matter,
                           const ScatterPoint& scatter) noexcept {
  const Material& material = scene.scattering.materials[matter.material + 1];
  ParticlePoint out = particle_point(material, scatter.normal, scatter.p_brdf, scatter.albedo);
  out.alpha = scatter.alpha;
  out.f0 = scatter.f0;
  out.g = scatter.g;
  out.metallic = matter.number_or(Number::kMetallic, material.metallic);
  return out;
}

}  // namespace

MatterPoint matter_at(const SceneView& scene, Vec3f p_index, float value) noexcept {
  const GridView& grid = scene.medium.grid;
  const ScatteringView& scattering = scene.scattering;
  const Classified matter = classified(scene.medium, p_index, value);
  const Coefficients& optics = matter.optics;
  const Vec3f p_world = grid.world_from_index.point(p_index);

  MatterPoint point;
  point.emission = optics.emission;
  point.p_world = p_world;
  ScatterPoint& scatter = point.scatter;
  scatter.normal = Vec3f(0);
  scatter.p_brdf = 0;
  scatter.albedo =
      scene.labels.color_count ? labelled_albedo(scene.labels, p_world, optics.albedo) : optics.albedo;
  const float roughness = matter.number_or(Number::kRoughness, -1);
  const float specular = matter.number_or(Number::kSpecular, -1);
  scatter.g = matter.number_or(Number::kAnisotropy, scattering.g);
  scatter.alpha = roughness >= 0 ? roughness * roughness : scattering.alpha;
  scatter.f0 = specular >= 0 ? kMostDielectricF0 * specular : scattering.f0;
  if (scattering.shading == Shading::kBlinnPhong) {
    point.highlight = highlight_at(scene, p_index, p_world, optics.mu_t, scatter.normal);
    point.highlight.strength *= matter.number_or(Number::kSurfaceShare, 1);
  } else if (scattering.shading != Shading::kPhase) {
    const Vec3f outward =
        data_normal(scene, matter, p_index) + face_normals(scene.clip_world, grid, p_index, p_world);
    const float magnitude = length(outward);
    if (magnitude > 1e-6f && std::isfinite(magnitude)) {
      scatter.normal = outward / magnitude;
      const float share = scattering.shading == Shading::kBrdf
                              ? 1.0f
                              : surface_share(scattering.surface_share, scattering.gradient_factor,
                                              scattering.opacity_modulated,
                                              opacity_of(scene.medium.transfer, optics.mu_t), magnitude);
      scatter.p_brdf = share * matter.number_or(Number::kSurfaceShare, 1);
    }
  }
  if (scattering.particles && scattering.shading != Shading::kBlinnPhong)
    point.particles = particles_of(scene, matter, scatter);
  return point;
}

}  // namespace voxlume
