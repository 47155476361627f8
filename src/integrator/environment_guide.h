#pragma once
#include <vector>

#include "integrator/scene_view.h"

namespace voxlume {

/// Remembers how much of the environment reaches cells of the visible region, by sweeping planes of cells
/// along every direction (Kroes, Eisemann and Eisemann 2015, "Visibility sweeps for joint-hierarchical
/// importance sampling of direct lighting for stochastic volume rendering"). Owns the tables behind view().
class EnvironmentGuide {
 public:
  /// `scene` has its medium, clip box and lights; takes a fraction of a second.
  explicit EnvironmentGuide(const SceneView& scene);

  /// Valid while this lives.
  EnvironmentGuideView view() const;

 private:
  EnvironmentGuideView view_;
  std::vector<float> cdf_;
};

/// Cells of equal size over a box, each with a mean extinction.
struct CoarseMedium {
  Box3f box;  ///< LPS mm
  std::int32_t count[3] = {0, 0, 0};
  std::vector<float> mu_t;  ///< [1/mm], x fastest

  std::size_t cell_count() const { return mu_t.size(); }
  Vec3f cell_extent() const {
    return box.extent() /
           Vec3f(static_cast<float>(count[0]), static_cast<float>(count[1]), static_cast<float>(count[2]));
  }
};

/// The medium in at most `most_cells` cells along the longest side of what is visible.
CoarseMedium coarse_medium(const SceneView& scene, int most_cells);

/// By cell: about what part of the light that comes from `direction` (unit, to the light) reaches its middle.
/// Planes of cells across the direction's longest axis are swept in the light's sense, each taking the light
/// of the one before, interpolated where the direction leads.
std::vector<float> sweep_visibility(const CoarseMedium& medium, Vec3f direction);

}  // namespace voxlume
