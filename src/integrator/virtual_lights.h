#pragma once
#include <cstdint>
#include <vector>

#include "integrator/scattering.h"
#include "light/compile_lights.h"

namespace voxlume {

/// Where a light particle scatters.
struct VirtualLight {
  MatterPoint matter;
  ScatterChoice choice;
  Vec3f p_index;
  Vec3f wo;    ///< unit, to where the particle came from
  Vec3f flux;  ///< that arrives, over the number of particles
};

/// How virtual lights are made.
struct VirtualLightChoice {
  int count = 1024;        ///< at least; fewer where light hardly meets matter
  int max_scatter = 2;     ///< scatterings of a path with the eye's own; 0: no limit
  float step_mm = 1;       ///< of the march that remembers transmittances
  float nearest_mm = 1;    ///< nearer ones count as this far
  std::uint64_t seed = 0;  ///< the same for all frames of an animation, which would flicker
};

/// Virtual point lights (Weber, Kaplanyan, Stamminger and Dachsbacher 2013, "Interactive direct volume
/// rendering with many-light methods and transmittance caching"): where light particles scatter, each with a
/// volumetric shadow map, the transmittance by direction and distance. Owns the tables behind view().
class VirtualLights {
 public:
  /// `scene` has its medium, materials and lights, whose samples are drawn for the whole environment. Tables
  /// take 19 KB a light.
  VirtualLights(const SceneView& scene, const SceneSphere& sphere, const VirtualLightChoice& choice);

  /// Valid while this lives.
  VirtualLightsView view() const;

 private:
  void trace(const SceneView& scene, const SceneSphere& sphere, const VirtualLightChoice& choice);

  std::vector<VirtualLight> lights_;
  std::vector<std::uint16_t> transmittance_;
  float reach_mm_ = 1, nearest_mm_ = 1;
};

/// About how much of a virtual light's light arrives at `p_world`: the table's entry of a direction near the
/// right one, chosen by u0 and u1 so that the mean interpolates, and interpolated in distance.
float virtual_transmittance(const VirtualLightsView& view, int light, Vec3f p_world, float u0,
                            float u1) noexcept;

/// Light from the virtual lights that matter at a point scatters along the kernel's wo: an estimate from some
/// of them, evenly chosen.
Vec3f light_of_virtual(const SceneView& scene, const ScatterKernel& kernel, Vec3f p_world, Rng& rng) noexcept;

}  // namespace voxlume
