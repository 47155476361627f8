#pragma once
#include <algorithm>

#include "sampling/elementary.h"
#include "voxlume/scene.h"

namespace voxlume {

/// P_brdf in [0,1]: the share of a scattering that a surface does, of which the volume does the rest. 0 at
/// zero gradient, and never falls as the gradient grows. `gradient_normalized`: gradient magnitude over the
/// volume's 99.9th percentile, >= 0, may exceed 1. `gradient_factor` >= 0 is used by the hybrid and
/// exponential forms, `opacity` in [0,1] by the hybrid form alone.
inline float surface_share(SurfaceShareForm form, float gradient_factor, bool opacity_modulated,
                           float opacity, float gradient_normalized) noexcept {
  switch (form) {
    case SurfaceShareForm::kHybrid: {
      const float exponent = 25.0f * gradient_factor * gradient_factor * gradient_factor;
      const float share = one_minus_exp(exponent * gradient_normalized);
      return opacity_modulated ? opacity * share : share;
    }
    case SurfaceShareForm::kExponential:
      return one_minus_exp(gradient_factor * gradient_normalized);
    case SurfaceShareForm::kModulation: {
      const float rest = 1.0f - std::min(gradient_normalized, 1.0f);
      return 1.0f - rest * rest;
    }
    case SurfaceShareForm::kThreshold:
      return gradient_normalized > 0.5f ? 1.0f : 0.0f;
  }
  return 0.0f;
}

}  // namespace voxlume
