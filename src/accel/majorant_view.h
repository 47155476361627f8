#pragma once
#include <cstdint>
#include <limits>

#include "accel/segment.h"
#include "base/box.h"

namespace voxlume {

/// Piecewise-constant majorants over macrocells. Cell (i,j,k) covers p_index [i*c, (i+1)*c] per axis, the
/// outermost cells reach to the end of the domain.
struct MajorantView {
  const float* mu_maj = nullptr;  ///< 1/mm, i fastest; 0 where nothing is visible
  const float* mu_min = nullptr;  ///< 1/mm, i fastest: greatest lower bounds; nullptr: none are kept
  std::int32_t cells[3] = {0, 0, 0};
  float cell_voxels = 1;
  Box3f domain;  ///< index space
};

/// Walks the cells that a ray crosses (3-D DDA). Crossing distances are computed from the planes themselves,
/// so that rounding does not accumulate; axes the ray does not move along never cross.
class MacrocellWalk {
 public:
  /// origin_index + t * direction_index, t in mm from t_near to t_far, which lie inside the domain.
  MacrocellWalk(const MajorantView& view, Vec3f origin_index, Vec3f direction_index, float t_near,
                float t_far) noexcept
      : view_(view), origin_(origin_index), t_(t_near), t_end_(t_far) {
    for (int a = 0; a < 3; ++a) {
      const float d = direction_index[a];
      // 1 / d must be finite, so that no crossing is 0 * infinity.
      constexpr float kStill = std::numeric_limits<float>::min();
      step_[a] = d > kStill ? 1 : d < -kStill ? -1 : 0;
      inverse_[a] = step_[a] ? 1.0f / d : 0.0f;
      const float p = (origin_index[a] + t_near * d) / view.cell_voxels;
      const float last = static_cast<float>(view.cells[a] - 1);
      cell_[a] = static_cast<std::int32_t>(p > 0 ? (p < last ? p : last) : 0);  // NaN: 0
      // A ray that starts on the lower face of its cell and moves down belongs to the cell below.
      if (step_[a] < 0 && cell_[a] > 0 && p == static_cast<float>(cell_[a])) --cell_[a];
      set_crossing(a);
    }
  }

  /// Fills `segment` with the next run; false at the end. Runs tile the interval; they may be empty
  /// (t_near == t_far), never reversed.
  bool next(MajorantSegment& segment) noexcept {
    if (!(t_ < t_end_)) return false;
    const int axis = crossing_[0] < crossing_[1] ? (crossing_[0] < crossing_[2] ? 0 : 2)
                                                 : (crossing_[1] < crossing_[2] ? 1 : 2);
    const float t_far = crossing_[axis] < t_end_ ? crossing_[axis] : t_end_;
    segment.t_near = t_;
    segment.t_far = t_far > t_ ? t_far : t_;
    const std::int64_t index =
        (static_cast<std::int64_t>(cell_[2]) * view_.cells[1] + cell_[1]) * view_.cells[0] + cell_[0];
    segment.mu_maj = view_.mu_maj[index];
    segment.mu_min = view_.mu_min ? view_.mu_min[index] : 0.0f;
    for (int a = 0; a < 3; ++a) {
      segment.cell.lower[a] = face(a, cell_[a]);
      segment.cell.upper[a] = face(a, cell_[a] + 1);
    }
    t_ = segment.t_far;
    const std::int32_t ahead = cell_[axis] + step_[axis];
    if (ahead < 0 || ahead >= view_.cells[axis]) {
      crossing_[axis] = std::numeric_limits<float>::infinity();  // rounding at the domain's border
    } else {
      cell_[axis] = ahead;
      set_crossing(axis);
    }
    return true;
  }

 private:
  /// Index-space position of the plane below cell `i` of an axis.
  float face(int axis, std::int32_t i) const noexcept {
    if (i <= 0) return view_.domain.lower[axis];
    if (i >= view_.cells[axis]) return view_.domain.upper[axis];
    return static_cast<float>(i) * view_.cell_voxels;
  }
  void set_crossing(int axis) noexcept {
    crossing_[axis] = step_[axis] == 0
                          ? std::numeric_limits<float>::infinity()
                          : (face(axis, cell_[axis] + (step_[axis] > 0)) - origin_[axis]) * inverse_[axis];
  }

  const MajorantView& view_;
  Vec3f origin_, inverse_;
  float t_, t_end_;
  float crossing_[3];
  std::int32_t cell_[3], step_[3];
};

}  // namespace voxlume
