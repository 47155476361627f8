#pragma once
#include "denoise/frame.h"

namespace voxlume {

/// What tells the matter of one pixel from that of another, for weights between pixels. A pixel without
/// matter that has some within two pixels takes the mean there, weighted by alpha; all is zero elsewhere
/// without matter, and in the border.
struct Guides {
  Plane depth_mm;
  Planes3 normal, albedo;
  /// 1 / the difference in depth that is tolerated between neighbours [pixels / mm]: 1 / (sigma_z |grad z|)
  /// of schied2017 eq. 3. The gradient is the smaller difference to both sides, along the steeper of the
  /// axes, and not below a part of the frame's size.
  Plane depth_rate;
  /// Factor of the squared distance between normals and between albedos. For exact normals it is 64:
  /// max(0, n . n')^128 of schied2017 eq. 4 is exp(-64 |n - n'|^2) for small angles. Means of few samples
  /// differ by chance, all the more where the normals of a pixel disagree (a mean of unit vectors is shorter
  /// than 1 by their scatter), and volumes have such pixels everywhere: 1 / (1 / 64 + 2 v), with v the
  /// variance of the mean.
  Plane feature_rate;
};

/// Makes the planes anew when the frame has another size.
void make_guides(const DenoiseFrame& frame, Guides& out);

}  // namespace voxlume
