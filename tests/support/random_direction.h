#pragma once
#include "sampling/rng.h"
#include "sampling/warp.h"

namespace voxlume::test {

inline Vec3f random_direction(Rng& rng) {
  const float u0 = rng.next(), u1 = rng.next();
  return uniform_sphere(u0, u1);
}

/// The random numbers at which formulas break.
constexpr float kEdgeNumbers[] = {0.0f, 0x1p-24f, 0.25f, 0.5f, 0.75f, 1.0f - 0x1p-24f};

}  // namespace voxlume::test
