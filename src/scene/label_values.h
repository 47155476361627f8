#pragma once
#include <string>
#include <vector>

#include "grid/grid_view.h"

namespace voxlume {

/// Labels lie in [-kMostLabel, kMostLabel]: beyond, floats have no halves, which separate labels.
constexpr float kMostLabel = (1 << 23) - 1;

/// The labels that occur in a volume, ascending; NaN and infinities are none. Throws Error kBadFormat at
/// `where` for fractions and for labels out of range.
std::vector<float> label_values(const GridView& grid, const std::string& where);

}  // namespace voxlume
