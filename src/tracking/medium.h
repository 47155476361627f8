#pragma once
#include "accel/accelerator_view.h"
#include "grid/sample.h"
#include "transfer/classifier_view.h"
#include "transfer/extinction_color.h"

namespace voxlume {

/// The participating medium: data, its classification and a bound of it.
struct Medium {
  GridView grid;
  TransferView transfer;
  AcceleratorView accelerator;
  ClassifierView rules{};  ///< where there are some, they classify in place of `transfer`
  /// Multiplies the extinction that shadow rays meet, in (0, 1] (xu2025 section 3.4).
  float shadow_extinction = 1;
  /// Of `transfer`, for trackers that tell channels apart (tracking/rgb_tracking.h).
  ExtinctionColorView extinction_color{};
};

/// A ray in index space that keeps t in mm.
struct IndexRay {
  Vec3f origin_index;
  Vec3f direction_index;  ///< index units per mm
};

/// The part of a ray that is tracked: t from t_near to t_far [mm], inside the volume's domain.
struct TrackRay {
  IndexRay ray;
  float t_near = 0, t_far = 0;
  /// Random numbers in [0, 1) that the ray's stream gives where they are negative: of a free flight's
  /// threshold, and of the first optical depth.
  float u_collision = -1, u_depth = -1;
  bool fine = false;  ///< whether tentative collisions are denser than they need be: collision_rates
};

inline IndexRay to_index_ray(const GridView& grid, Vec3f origin_world, Vec3f direction_world) noexcept {
  return {grid.index_from_world.point(origin_world), grid.index_from_world.vector(direction_world)};
}

/// mu_t [1/mm] at a point where the data is `value`.
inline float extinction_of(const Medium& medium, Vec3f p_index, float value) noexcept {
  return medium.rules.rule_count == 0 ? classify_mu_t(medium.transfer, value)
                                      : classify_mu_t(medium.rules, p_index, value);
}

/// mu_t [1/mm] at a point, as the trackers see it.
inline float extinction_at(const Medium& medium, Vec3f p_index) noexcept {
  return extinction_of(medium, p_index, sample_trilinear(medium.grid, p_index));
}

}  // namespace voxlume
