#pragma once
#include <cmath>
#include <random>
#include <string>

#include "voxlume/image.h"

namespace voxlume::test {

/// Random linear values from 1e-4 to 1e4 with every layer of the table in voxlume/image.h and metadata.
inline Image sample_image(int width, int height, unsigned seed = 1) {
  std::mt19937 generator(seed);
  const auto next = [&] { return static_cast<float>(std::pow(10.0, 8e0 * generator() * 0x1p-32 - 4)); };
  Image image(width, height);
  for (float& value : image.rgba) value = next();
  image.layers = {{"alpha", {"Y"}, {}},
                  {"depth", {"Z"}, {}},
                  {"normal", {"X", "Y", "Z"}, {}},
                  {"albedo", {"R", "G", "B"}, {}},
                  {"samples", {"Y"}, {}},
                  {"variance", {"Y"}, {}}};
  for (ImageLayer& layer : image.layers) {
    layer.values.resize(image.pixel_count() * layer.channels.size());
    for (float& value : layer.values) value = next() - 1;
  }
  image.metadata = {{"voxlume:scene", "{\n  \"version\": 1,\n  \"name\": \"\xc3\xa4\"\n}"},
                    {"voxlume:seed", "18446744073709551615"},
                    {"voxlume:version", "0.1.0"}};
  return image;
}

/// A Radiance picture without run-length coding; `rgbe` holds 4 bytes a pixel.
inline std::string hdr_bytes(int width, int height, const std::string& rgbe) {
  return "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " + std::to_string(height) + " +X " +
         std::to_string(width) + "\n" + rgbe;
}

}  // namespace voxlume::test
