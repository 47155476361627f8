#pragma once
#include <cstddef>
#include <random>

#include "base/vec.h"
#include "voxlume/image.h"

namespace voxlume::test {

inline Image constant(int width, int height, Vec3f color) {
  Image image(width, height);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (int c = 0; c < 3; ++c) image.rgba[4 * i + c] = color[c];
    image.rgba[4 * i + 3] = 1;
  }
  return image;
}
inline Image constant(int width, int height, float value) { return constant(width, height, Vec3f(value)); }

/// Every channel uniform in [0,1).
inline Image noise(int width, int height, unsigned seed) {
  Image image = constant(width, height, 0);
  std::mt19937 generator(seed);
  for (float& value : image.rgba) value = static_cast<float>(generator()) * 0x1p-32f;
  return image;
}

}  // namespace voxlume::test
