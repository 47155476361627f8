#pragma once
#include <array>
#include <cstdint>

#include "integrator/scatter_point.h"
#include "integrator/scene_view.h"
#include "light/sample_light.h"
#include "sampling/sobol.h"

namespace voxlume {

/// How matter at a point scatters light that leaves along wo, by the model that the scene shades.
class ScatterKernel {
 public:
  /// `matter` must outlive this.
  ScatterKernel(const SceneView& scene, const MatterPoint& matter, Vec3f wo) noexcept
      : matter_(matter), wo_(wo), model_(model_of(scene)) {
    if (model_ == Model::kParticles) {
      particles_ = particle_choice(matter.particles, wo);
      choice_ = {particles_.coat, particles_.diffuse, particles_.any};
    } else {
      choice_ = model_ == Model::kBlinnPhong ? blinn_phong_choice(matter.scatter, matter.highlight)
                                             : scatter_choice(matter.scatter, wo);
    }
  }
  /// The same with a choice that was made before; particles make theirs again.
  ScatterKernel(const SceneView& scene, const MatterPoint& matter, const ScatterChoice& choice,
                Vec3f wo) noexcept
      : matter_(matter), wo_(wo), model_(model_of(scene)), choice_(choice) {
    if (model_ == Model::kParticles) particles_ = particle_choice(matter.particles, wo);
  }

  const ScatterChoice& choice() const noexcept { return choice_; }
  ScatterParts eval(Vec3f wi) const noexcept {
    if (model_ == Model::kParticles) return eval_particles(matter_.particles, particles_, wo_, wi);
    if (model_ == Model::kBlinnPhong)
      return eval_blinn_phong(matter_.scatter, matter_.highlight, choice_, wo_, wi);
    return eval_scatter_parts(matter_.scatter, choice_, wo_, wi);
  }
  ScatterSample sample(float u_lobe, float u0, float u1) const noexcept {
    if (model_ == Model::kParticles)
      return sample_particles(matter_.particles, particles_, wo_, u_lobe, u0, u1);
    if (model_ == Model::kBlinnPhong)
      return sample_blinn_phong(matter_.scatter, matter_.highlight, choice_, wo_, u_lobe, u0, u1);
    return sample_scatter(matter_.scatter, choice_, wo_, u_lobe, u0, u1);
  }
  /// What of light from all around comes back: phase function and diffuse lobe, and the rest.
  struct Albedo {
    Vec3f diffuse, specular;
  };
  Albedo albedo() const noexcept;

 private:
  enum class Model { kReciprocal, kParticles, kBlinnPhong };
  static Model model_of(const SceneView& scene) noexcept {
    if (scene.scattering.shading == Shading::kBlinnPhong) return Model::kBlinnPhong;
    return scene.scattering.particles ? Model::kParticles : Model::kReciprocal;
  }

  const MatterPoint& matter_;
  Vec3f wo_;
  Model model_;
  ScatterChoice choice_;
  ParticleChoice particles_;
};

/// A real collision, and numbers in [0, 1) for what is drawn there.
struct ScatteringQuery {
  Vec3f p_index;
  float value;                    ///< data at p_index
  Vec3f wo;                       ///< unit, to where the path came from
  bool samples_light, turns;      ///< whether a light and a direction are to be drawn
  float u_surface = 0;            ///< with Exposure Render's shading: surface or medium
  float u_pick = 0, u_light = 0;  ///< which light: of all light samples of the scattering, and of the first
  UnitPair light{0, 0};           ///< and where on it
  float u_lobe = 0;               ///< which part of the matter scatters
  UnitPair direction{0, 0};
};

/// What is found and drawn at a collision. Light and direction are of no use unless they were asked for.
struct Scattering {
  MatterPoint matter;
  float surface_share;  ///< before Exposure Render's shading decides
  ScatterChoice choice;
  LightSample light;
  ScatterValue toward_light;
  TrackRay light_ray;
  ScatterSample turn;
  TrackRay turn_ray;
  bool turn_meets_rect;  ///< whether any rect light shines against it
};

/// The ray from a point of the volume, given in both spaces, up to t_max [mm].
inline TrackRay ray_from(const SceneView& scene, Vec3f p_index, Vec3f p_world, Vec3f direction_world,
                         float t_max) noexcept {
  const IndexRay ray{p_index, scene.medium.grid.index_from_world.vector(direction_world)};
  return visible_part(scene, ray, p_world, direction_world, t_max, !scene.clip_blocks_light);
}

/// Finds what is at a collision and draws what the query asks for, from its numbers.
Scattering scatter_at(const SceneView& scene, const ScatteringQuery& query) noexcept;

/// Many scatterings, a column of every array each.
struct alignas(64) ScatteringBatch {
  static constexpr int kCount = 16;
  template <class T>
  using Column = std::array<T, kCount>;
  using Column3 = Column<float>[3];

  // Given; what a query does not draw need not be put.
  int count = 0;
  bool samples_light = false, turns = false;  ///< whether any of them does
  alignas(64) Column3 p_index{}, wo{};
  alignas(64) Column<float> value{}, u_surface{}, u_light{}, light0{}, light1{}, u_lobe{}, direction0{},
      direction1{};
  // Filled.
  alignas(64) Column3 emission{}, p_world{}, normal{}, albedo{};
  alignas(64) Column<float> p_brdf{}, surface_share{};
  alignas(64) Column<float> specular{}, surface{}, any{};
  alignas(64) Column3 light_wi{}, light_radiance{}, light_value{};
  alignas(64) Column<float> light_mm{}, light_pdf{}, light_value_pdf{};
  alignas(64) Column<std::uint32_t> light_delta{};  ///< 0 or not
  alignas(64) Column3 turn_wi{}, turn_value{};
  alignas(64) Column<float> turn_pdf{};
  alignas(64) Column<std::uint32_t> turn_meets_rect{};  ///< 0 or not
  alignas(64) Column3 light_direction_index{}, turn_direction_index{};
  alignas(64) Column<float> light_near{}, light_far{}, turn_near{}, turn_far{};

  void clear() noexcept {
    count = 0;
    samples_light = turns = false;
  }
  /// Puts a query behind the others.
  void add(const ScatteringQuery& query) noexcept;
  Scattering at(const SceneView& scene, int i) const noexcept;
};

/// Fills a batch with what scatter_at computes, to the last bit.
using FillScatterings = void (*)(const SceneView& scene, ScatteringBatch& batch);

/// The filler for an instruction set that the machine has; nullptr for scalar code.
FillScatterings vector_scatterings(SimdTarget target);

}  // namespace voxlume
