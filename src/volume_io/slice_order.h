#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace voxlume {

/// How slices found in any order make an evenly spaced stack.
struct SliceOrder {
  static constexpr std::size_t kMissing = static_cast<std::size_t>(-1);
  /// For each slice of the stack, along the normal: the index of the slice found there, or kMissing. The
  /// first and the last are never missing.
  std::vector<std::size_t> slots;
  double step_mm = 0;                 ///< between slots, > 0; 0 for a single slice
  std::vector<std::string> warnings;  ///< tilt, gaps, uneven steps, repeated positions
};

/// Orders slices by the projection of their positions (LPS mm) on the unit `normal`. A gap that is a multiple
/// of the median step leaves missing slots; repeated positions keep the first given.
SliceOrder order_slices(const std::vector<std::array<double, 3>>& positions_mm,
                        const std::array<double, 3>& normal);

}  // namespace voxlume
