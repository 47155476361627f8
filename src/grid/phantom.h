#pragma once
#include "voxlume/volume.h"

namespace voxlume {

/// A head built from ellipsoids, in HU on a 192^3 grid of 1.2 mm (int16, LPS, centred): skin, skull with
/// orbits and nasal cavity, teeth, brain with ventricles. For machines without sample data, and for tests.
Volume make_head_phantom();

}  // namespace voxlume
