#pragma once

namespace voxlume {

class GlassAlbedo;

/// What matter is made of, apart from its colour, which may vary from point to point: the fields of
/// ParticlePoint of the same names.
struct Material {
  float alpha;                  ///< GGX width, the square of the roughness, [0,1]
  float f0;                     ///< of the coat, [0,1]; 0: none
  float metallic;               ///< [0,1]
  float transmission;           ///< [0,1]
  float ior;                    ///< >= 1
  float diffuse_roughness;      ///< [0,1]
  float g, g_back, back_share;  ///< within (-1,1); [0,1]
  const GlassAlbedo* glass;     ///< of `ior`; nullptr where transmission is 0
};

}  // namespace voxlume
