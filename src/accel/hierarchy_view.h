#pragma once
#include <algorithm>
#include <bit>
#include <cstdint>

#include "accel/segment.h"
#include "base/box.h"

namespace voxlume {

/// Majorants of aligned blocks of cells. Cell (i,j,k), each index from -1 to count inclusive, covers p_index
/// [i*c, (i+1)*c] per axis; the cells outside [0, count) continue their neighbours, so that a ray in the
/// domain [-1/2, n-1/2] never leaves the table. One word tells a cell's majorant [1/mm], and in its three
/// lowest bits the level l of the block of 2^l cells a side, aligned to 2^l, that the cell is part of and
/// that has this majorant as a whole.
struct HierarchyView {
  const std::uint32_t* words = nullptr;  ///< of cell (0,0,0); i fastest
  std::int32_t stride_j = 0, stride_k = 0;
  std::int32_t count[3] = {0, 0, 0};
  float cell_voxels = 1, cells_per_voxel = 1;
  Box3f domain;  ///< index space
};

inline constexpr std::uint32_t kLevelMask = 7;

/// The smallest |direction| [index units per mm] that crosses cells; below it a ray stays in its slab.
inline constexpr float kStillDirection = 1e-20f;

/// A ray from inside the domain, as the hierarchy is walked.
struct HierarchyRay {
  Vec3f origin;     ///< index space, inside the domain
  Vec3f direction;  ///< index units per mm
  Vec3f inverse;    ///< 1 / direction, or a large number where the ray stands still
  float length_mm;
  bool upward[3];
};

/// Prepares `origin + t * direction`, 0 <= t <= length_mm. The origin is moved into the domain and the length
/// cut to it, both by no more than the rounding of whoever clipped the ray.
inline HierarchyRay make_hierarchy_ray(const HierarchyView& view, Vec3f origin, Vec3f direction,
                                       float length_mm) noexcept {
  HierarchyRay ray{min(max(origin, view.domain.lower), view.domain.upper), direction, {}, length_mm, {}};
  for (int a = 0; a < 3; ++a) {
    const float d = direction[a];
    ray.upward[a] = !(d < -kStillDirection);
    ray.inverse[a] = d > kStillDirection || d < -kStillDirection ? 1.0f / d : 1.0f / kStillDirection;
    const float exit = (ray.upward[a] ? view.domain.upper[a] : view.domain.lower[a]) - ray.origin[a];
    ray.length_mm = std::min(ray.length_mm, exit * ray.inverse[a]);
  }
  return ray;
}

/// Walks the blocks that a ray crosses. The vector tracker does the same arithmetic in the same order.
class HierarchyWalk {
 public:
  HierarchyWalk(const HierarchyView& view, const HierarchyRay& ray) noexcept : view_(view), ray_(ray) {
    for (int a = 0; a < 3; ++a)
      cell_[a] = std::clamp(cell_of(ray.origin[a]), std::int32_t{-1}, view.count[a]);
  }

  /// Fills `segment` with the next run; false at the end. Runs tile [0, length_mm]; they may be empty
  /// (t_near == t_far), never reversed.
  bool next(MajorantSegment& segment) noexcept {
    if (!(t_ < ray_.length_mm)) return false;
    const std::uint32_t word = view_.words[cell_[2] * std::int64_t{view_.stride_k} +
                                           cell_[1] * std::int64_t{view_.stride_j} + cell_[0]];
    const std::int32_t size = std::int32_t{1} << (word & kLevelMask);
    segment.mu_maj = std::bit_cast<float>(word & ~kLevelMask);
    std::int32_t first[3];
    float crossing[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = cell_[a] & -size;
      segment.cell.lower[a] = static_cast<float>(first[a]) * view_.cell_voxels;
      segment.cell.upper[a] = static_cast<float>(first[a] + size) * view_.cell_voxels;
      const float plane = ray_.upward[a] ? segment.cell.upper[a] : segment.cell.lower[a];
      crossing[a] = (plane - ray_.origin[a]) * ray_.inverse[a];
    }
    const int axis =
        crossing[0] < crossing[1] ? (crossing[0] < crossing[2] ? 0 : 2) : (crossing[1] < crossing[2] ? 1 : 2);
    segment.t_near = t_;
    t_ = std::max(t_, std::min(crossing[axis], ray_.length_mm));
    segment.t_far = t_;
    for (int a = 0; a < 3; ++a) {
      const std::int32_t at = cell_of(ray_.origin[a] + ray_.direction[a] * t_);
      cell_[a] = std::min(std::max(at, first[a]), first[a] + size - 1);
    }
    cell_[axis] = ray_.upward[axis] ? first[axis] + size : first[axis] - 1;
    return true;
  }

 private:
  /// Truncates, which is the floor from -1 on.
  std::int32_t cell_of(float p) const noexcept {
    return static_cast<std::int32_t>(p * view_.cells_per_voxel + 1.0f) - 1;
  }

  const HierarchyView& view_;
  const HierarchyRay& ray_;
  float t_ = 0;
  std::int32_t cell_[3];
};

}  // namespace voxlume
