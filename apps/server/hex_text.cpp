#include "server/hex_text.h"

#include <fmt/format.h>

#include <algorithm>

#include "tonemap/srgb.h"

namespace voxlume::server {

std::string hex_text(const Color& color) {
  std::string out = "#";
  for (const float x : color.linear)
    out += fmt::format("{:02x}", std::lround(255 * srgb_from_linear(std::clamp(x, 0.0f, 1.0f))));
  return out;
}

}  // namespace voxlume::server
