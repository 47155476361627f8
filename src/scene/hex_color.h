#pragma once
#include "tonemap/srgb.h"
#include "voxlume/scene.h"

namespace voxlume {

/// The colour that 0xrrggbb encodes in sRGB.
inline Color hex_color(int hex) {
  const auto channel = [&](int shift) {
    return linear_from_srgb(static_cast<float>(hex >> shift & 255) / 255.0f);
  };
  return {{channel(16), channel(8), channel(0)}};
}

}  // namespace voxlume
