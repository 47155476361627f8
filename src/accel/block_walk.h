#pragma once
#include <algorithm>
#include <cstdint>

#include "accel/segment.h"
#include "base/box.h"

namespace voxlume {

/// The smallest |direction| [index units per mm] that crosses cells; below it a ray stays in its slab.
inline constexpr float kStillDirection = 1e-20f;

/// A ray from inside the domain, as blocks of cells are walked.
struct BlockRay {
  Vec3f origin;     ///< index space, inside the domain
  Vec3f direction;  ///< index units per mm
  Vec3f inverse;    ///< 1 / direction, or a large number where the ray stands still
  float length_mm;
  bool upward[3];
};

/// Prepares `origin + t * direction`, 0 <= t <= length_mm. The origin is moved into the domain (index space)
/// and the length cut to it, both by no more than the rounding of whoever clipped the ray.
inline BlockRay make_block_ray(const Box3f& domain, Vec3f origin, Vec3f direction, float length_mm) noexcept {
  BlockRay ray{min(max(origin, domain.lower), domain.upper), direction, {}, length_mm, {}};
  for (int a = 0; a < 3; ++a) {
    const float d = direction[a];
    ray.upward[a] = !(d < -kStillDirection);
    ray.inverse[a] = d > kStillDirection || d < -kStillDirection ? 1.0f / d : 1.0f / kStillDirection;
    const float exit = (ray.upward[a] ? domain.upper[a] : domain.lower[a]) - ray.origin[a];
    ray.length_mm = std::min(ray.length_mm, exit * ray.inverse[a]);
  }
  return ray;
}

/// Cubic cells over a volume. Cell (i,j,k), each index from -1 to count inclusive, covers p_index
/// [i*c, (i+1)*c] per axis; those outside [0, count) continue their neighbours, so that a ray in the domain
/// [-1/2, n-1/2] never leaves them.
struct CellGrid {
  std::int32_t count[3] = {0, 0, 0};
  float cell_voxels = 1, cells_per_voxel = 1;
  Box3f domain;  ///< index space

  /// The cell of the grid that `cell` is or continues. The block around one outside may be taken as large as
  /// the block of the cell it continues: all that it covers beside the grid continues that block.
  void clamp_cell(const std::int32_t (&cell)[3], std::int32_t (&at)[3]) const noexcept {
    for (int a = 0; a < 3; ++a) at[a] = std::min(std::max(cell[a], 0), count[a] - 1);
  }
};

/// Walks the blocks of cells that a ray crosses. A block of level l is 2^l cells a side and aligned to that.
/// `Blocks` has count, cell_voxels and cells_per_voxel as CellGrid has, and
///   float find_block(const std::int32_t (&cell)[3], int& level) const
/// which gives the majorant and level of the block that holds a cell; it finds the level of the block before
/// in `level`.
template <class Blocks>
class BlockWalk {
 public:
  BlockWalk(const Blocks& blocks, const BlockRay& ray) noexcept : blocks_(blocks), ray_(ray) {
    for (int a = 0; a < 3; ++a)
      cell_[a] = std::clamp(cell_of(ray.origin[a]), std::int32_t{-1}, blocks.count[a]);
  }

  /// Fills `segment` with the next run; false at the end. Runs tile [0, length_mm]; they may be empty
  /// (t_near == t_far), never reversed.
  bool next(MajorantSegment& segment) noexcept {
    if (!(t_ < ray_.length_mm)) return false;
    segment.mu_maj = blocks_.find_block(cell_, level_);
    const std::int32_t size = std::int32_t{1} << level_;
    std::int32_t first[3];
    float crossing[3];
    for (int a = 0; a < 3; ++a) {
      first[a] = cell_[a] & -size;
      segment.cell.lower[a] = static_cast<float>(first[a]) * blocks_.cell_voxels;
      segment.cell.upper[a] = static_cast<float>(first[a] + size) * blocks_.cell_voxels;
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
    const auto above = static_cast<std::int32_t>(p * blocks_.cells_per_voxel + 1.0f);
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(above) - 1u);  // wraps where p is NaN
  }

  const Blocks& blocks_;
  const BlockRay& ray_;
  float t_ = 0;
  int level_ = 0;
  std::int32_t cell_[3];
};

}  // namespace voxlume
