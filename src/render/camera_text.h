#pragma once
#include <string>
#include <string_view>

#include "camera/camera.h"

namespace voxlume {

/// The camera that rendered a picture as one line of JSON, in the volume's own space (docs/animation.md).
/// `origin_mm` is the place there of the origin that the view's coordinates have [LPS mm].
std::string write_camera(const CameraView& camera, const Double3& origin_mm);

/// The view that write_camera described, with the volume's own origin and a pinhole. Throws Error kBadFormat
/// at `where` unless the text is complete, its numbers within +-1e9 and its axes orthonormal to 1e-3.
CameraView parse_camera(std::string_view text, const std::string& where);

}  // namespace voxlume
