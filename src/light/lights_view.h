#pragma once
#include <cstdint>

#include "base/box.h"
#include "base/vec.h"
#include "sampling/distribution.h"
#include "voxlume/scene.h"

namespace voxlume {

/// A compiled light in LPS space. Fields that a kind does not name are not used by it.
struct Light {
  LightKind kind;
  bool two_sided;        ///< rect: emits from its back too
  Vec3f emission;        ///< directional: irradiance; point: radiant intensity; rect: radiance
  Vec3f position_mm;     ///< point; rect: the centre
  Vec3f direction;       ///< directional: unit, toward the light; rect: unit normal of the front
  Vec3f axis_x, axis_y;  ///< rect: unit, along width and height
  float half_width_mm, half_height_mm;  ///< rect
};

/// Radiance from infinitely far. A constant, or a picture of piecewise constant texels: row 0 is the top
/// (+axis_z), column centres run left to right as seen from inside, and the picture's centre (u = 0.5) is
/// along +axis_y, u = 0.75 along +axis_x.
struct EnvironmentView {
  Vec3f axis_x, axis_y, axis_z;        ///< LPS directions of the environment's own axes, orthonormal
  Vec3f scale;                         ///< radiance; with a picture, what its texels are multiplied by
  int width = 0, height = 0;           ///< 0: no picture
  const Vec3f* texels = nullptr;       ///< as the picture has them, row after row
  Distribution2DView choice;           ///< by luminance x solid angle
  const float* cap_versine = nullptr;  ///< [row] = 1 - cos(pi row / height), height + 1 of them
};

/// Where light of the environment comes from, remembered for cells of space: its radiance times how much of
/// it gets there, for every one of DirectionBins. Samples take that half of the time, the environment's own
/// distribution the other half: whatever it says, only the noise depends on it.
struct EnvironmentGuideView {
  Box3f box;  ///< LPS mm; points outside count as the nearest inside
  std::int32_t count[3] = {0, 0, 0};
  const float* cdf = nullptr;  ///< DirectionBins::kCount + 1 for a cell, x fastest; null: no guide
};

/// Every light, as the renderer's inner loops see it.
struct LightsView {
  const Light* lights = nullptr;  ///< rect lights first
  int light_count = 0;
  int rect_count = 0;
  bool has_environment = false;
  EnvironmentView environment;
  Vec3f environment_mean{0};   ///< radiance, over all directions
  EnvironmentGuideView guide;  ///< of scalar code
  /// Probabilities of the lights, then of the environment (index light_count). No bins: nothing to sample.
  Distribution1DView pick;
};

}  // namespace voxlume
