#pragma once
#include <cstdint>
#include <vector>

#include "visibility/importance.h"

namespace voxlume {

/// Importance at the centre of every voxel of the main volume, in kImportanceStep, i fastest: by the rules of
/// `view`, whose lookup is kInterpolated. On all threads.
std::vector<std::uint16_t> importance_of_voxels(const ImportanceView& view);

/// The mean of 3 x 3 x 3 voxels around every one; beyond the border the outermost voxels go on. `size` of the
/// volume. On all threads.
std::vector<std::uint16_t> mean_of_neighbours(const std::vector<std::uint16_t>& voxels,
                                              const std::int32_t (&size)[3]);

}  // namespace voxlume
