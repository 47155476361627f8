#pragma once
#include <cmath>

namespace voxlume {

// The sRGB transfer curve (IEC 61966-2-1). Its only home.

/// Encodes linear [0,1] to sRGB [0,1]. Below 0 the linear part goes on; above 1 the power does.
inline float srgb_from_linear(float linear) {
  return linear <= 0.0031308f ? 12.92f * linear : 1.055f * std::pow(linear, 1.0f / 2.4f) - 0.055f;
}

/// Decodes sRGB [0,1] to linear [0,1]; the inverse of srgb_from_linear.
inline float linear_from_srgb(float encoded) {
  return encoded <= 0.04045f ? encoded / 12.92f : std::pow((encoded + 0.055f) / 1.055f, 2.4f);
}

}  // namespace voxlume
