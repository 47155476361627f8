#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/vec.h"
#include "sampling/warp.h"

namespace voxlume {

/// All directions in bins of equal solid angle: rows of equal height along z, cut at equal azimuths.
struct DirectionBins {
  static constexpr int kRows = 12, kColumns = 24, kCount = kRows * kColumns;
  /// 1/sr, of a direction that is uniform within a bin.
  static constexpr float kPdf = kCount * kUniformSpherePdf;

  /// Where a unit direction is: in [0, kRows] x [0, kColumns].
  struct Place {
    float row, column;
  };
  static Place place_of(Vec3f direction) noexcept {
    const float turn = std::atan2(direction.y, direction.x) * (0.5f * std::numbers::inv_pi_v<float>);
    return {0.5f * (1.0f - direction.z) * kRows, (turn < 0 ? turn + 1.0f : turn) * kColumns};
  }
  /// Rows end at the poles, columns go round.
  static int bin_at(float row, float column) noexcept {
    const int r = std::clamp(static_cast<int>(std::floor(row)), 0, kRows - 1);
    const int c = static_cast<int>(std::floor(column)) % kColumns;
    return r * kColumns + (c < 0 ? c + kColumns : c);
  }
  static int bin_of(Vec3f direction) noexcept {
    const Place place = place_of(direction);
    return bin_at(place.row, place.column);
  }
  /// The direction at a place of a bin, u0 and u1 in [0, 1); uniform where those are.
  static Vec3f direction_in(int bin, float u0, float u1) noexcept {
    const float row = static_cast<float>(bin / kColumns) + u0,
                column = static_cast<float>(bin % kColumns) + u1;
    return direction_from_versine(2.0f * row / kRows, std::min(column / kColumns, 0x1.fffffep-1f));
  }
};

}  // namespace voxlume
