#pragma once
#include "grid/grid_view.h"

namespace voxlume {

/// The outward direction, in LPS space, of the surface of `label`, which p_index is in: where the share of
/// other labels round about grows fastest. Labels alone have stairs for surfaces; this is what to shade them
/// by. "Round about" is a kernel like a Gaussian with a standard deviation of 4/3 voxels that
/// ends at 4; for voxels with sides of different lengths at up to 5 along the short and down to 2.5 along the
/// long ones. The length is 1 (within a few percent) where a straight boundary passes through p_index,
/// never more, and falls to 0 where the kernel ends; it is 0 within a label, where other labels lie alike on
/// opposite sides (in the middle of a thin sheet), and for NaN. Continuous in p_index, but for changes
/// of the label there, at which it turns round. Labels beyond the volume are those at its border. Reads up to
/// some 700 voxels.
Vec3f label_normal(const GridView& labels, Vec3f p_index, float label) noexcept;

}  // namespace voxlume
