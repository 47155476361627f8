#pragma once
#include "base/vec.h"

namespace voxlume {

/// The axes of a camera in LPS space: what "attached to the camera" means. right, up and toward_eye are an
/// orthonormal right-handed basis; target_mm is the point the camera looks at.
struct ViewFrame {
  Vec3f right{1, 0, 0};
  Vec3f up{0, 0, 1};
  Vec3f toward_eye{0, -1, 0};
  Vec3f target_mm{0, 0, 0};
};

}  // namespace voxlume
