#pragma once
#include "camera/camera.h"
#include "denoise/plane.h"

namespace voxlume {

/// Where the matter of each pixel was seen in the frame before.
struct Reprojection {
  Plane x, y;  ///< image point from the top left corner [pixels]; kNowhere where it was not in the picture
  Plane depth_mm;  ///< from the eye of the frame before; 0 at kNowhere

  /// Left of every picture.
  static constexpr float kNowhere = -1e9f;
};

/// Follows the matter at `depth_mm` (distance from the eye through the pixel's centre; 0: none) from where
/// `now` sees it to where `before` saw it. Matter stands still. A pixel without matter takes the smallest
/// depth of those around it (5 x 5), where there is one: the next frame may find matter there. Both cameras
/// see pictures of the planes' size; lenses are taken for pinholes.
class Reprojector {
 public:
  const Reprojection& operator()(const CameraView& now, const Plane& depth_mm, const CameraView& before);

 private:
  Plane row_minimum_, near_depth_mm_;
  Reprojection result_;
};

}  // namespace voxlume
