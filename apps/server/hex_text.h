#pragma once
#include <string>

#include "voxlume/scene.h"

namespace voxlume::server {

/// "#rrggbb" of a colour, cut to [0, 1].
std::string hex_text(const Color& color);

}  // namespace voxlume::server
