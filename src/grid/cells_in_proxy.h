#pragma once
#include "grid/cell_layout.h"
#include "grid/label_kernel.h"

namespace voxlume {

/// Voxels from `first` to `last`, both included; none when first > last on the axis i.
struct VoxelBox {
  std::int32_t first[3], last[3];
  bool empty() const { return first[0] > last[0]; }
};

/// Where the cells of one grid lie on another.
class CellsInProxy {
 public:
  CellsInProxy(const GridView& main, const CellLayout& layout, const GridView& proxy)
      : cell_voxels_(layout.cell_voxels), map_(composed(proxy.index_from_world, main.world_from_index)) {
    for (int a = 0; a < 3; ++a) {
      last_cell_[a] = layout.cells[a] - 1;
      main_end_[a] = main.size[a] - 0.5;
      proxy_size_[a] = proxy.size[a];
    }
    slack_ = rounding(main, proxy);
  }

  /// The voxels that an interpolation within the cell may touch.
  VoxelBox interpolated(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return voxels(i, j, k,
                  [](double lower, double upper, std::int32_t n, std::int32_t& first, std::int32_t& last) {
                    // At the last voxel's centre the look-up comes from the voxel before it.
                    first = std::min(static_cast<std::int32_t>(std::max(lower, 0.0)), std::max(n - 2, 0));
                    const double end = std::clamp(upper, 0.0, n - 1.0);
                    last = static_cast<std::int32_t>(end);
                    if (end > last) ++last;
                  });
  }

  /// Whether every point of the cell is inside the proxy, whatever rounding does.
  bool inside(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const Box3d box = reach(i, j, k);
    for (int a = 0; a < 3; ++a)
      if (!(box.lower[a] >= -0.5 && box.upper[a] <= proxy_size_[a] - 0.5)) return false;
    return true;
  }

  /// The voxels whose labels may win a vote (sample_outline) within the cell.
  VoxelBox voted(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return voxels(i, j, k,
                  [](double lower, double upper, std::int32_t n, std::int32_t& first, std::int32_t& last) {
                    first = static_cast<std::int32_t>(std::clamp(lower + kLeastVote, 0.0, n - 1.0));
                    last = static_cast<std::int32_t>(std::ceil(std::clamp(upper - kLeastVote, 0.0, n - 1.0)));
                    last = std::max(first, last);
                  });
  }

  /// The voxels that may be the nearest to a point of the cell.
  VoxelBox nearest(std::int32_t i, std::int32_t j, std::int32_t k) const {
    return voxels(i, j, k,
                  [](double lower, double upper, std::int32_t n, std::int32_t& first, std::int32_t& last) {
                    first = std::min(static_cast<std::int32_t>(std::max(lower + 0.5, 0.0)), n - 1);
                    last = std::min(static_cast<std::int32_t>(std::max(upper + 0.5, 0.0)), n - 1);
                  });
  }

 private:
  static Affined composed(const Affinef& outer, const Affinef& inner) {
    const Affined o(outer), i(inner);
    return {o.vector(i.column_x), o.vector(i.column_y), o.vector(i.column_z), o.point(i.translation)};
  }

  static Vec3d absolute(Vec3d v) { return {std::abs(v.x), std::abs(v.y), std::abs(v.z)}; }

  /// `map` with absolute values: how far it can take what is no further than a given point, and what its sums
  /// of floats are rounded by.
  static Affined absolute(const Affinef& map) {
    const Affined m(map);
    return {absolute(m.column_x), absolute(m.column_y), absolute(m.column_z), absolute(m.translation)};
  }

  /// How far a look-up in floats may be from where exact arithmetic has it [index units of the proxy]: the
  /// point may come from world_from_index, or be a point in space whose cell was found by index_from_world.
  static Vec3d rounding(const GridView& main, const GridView& proxy) {
    constexpr double kEpsilon = 4 * std::numeric_limits<float>::epsilon();
    const Affined world_from_main = absolute(main.world_from_index),
                  main_from_world = absolute(main.index_from_world),
                  proxy_from_world = absolute(proxy.index_from_world);
    const Vec3d p_world = world_from_main.point(Vec3d(main.size[0], main.size[1], main.size[2]));
    const Vec3d of_main = main_from_world.point(p_world) * kEpsilon;
    const Vec3d of_world = p_world * kEpsilon + world_from_main.vector(of_main);
    const Vec3d of_proxy = (proxy_from_world.point(p_world) + Vec3d(1)) * kEpsilon;
    return of_proxy + proxy_from_world.vector(of_world);
  }

  /// The smallest box along the proxy's axes around the cell, and what rounding makes of its points.
  Box3d reach(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const std::int32_t cell[3] = {i, j, k};
    Vec3d center, half;
    for (int a = 0; a < 3; ++a) {
      const double begin = cell[a] == 0 ? -0.5 : static_cast<double>(cell[a]) * cell_voxels_;
      const double end = cell[a] == last_cell_[a] ? main_end_[a] : (cell[a] + 1.0) * cell_voxels_;
      center[a] = 0.5 * (begin + end);
      half[a] = 0.5 * (end - begin);
    }
    const Vec3d middle = map_.point(center);
    const Vec3d half_box = absolute(map_.column_x) * half.x + absolute(map_.column_y) * half.y +
                           absolute(map_.column_z) * half.z + slack_;
    return {middle - half_box, middle + half_box};
  }

  template <class Touched>
  VoxelBox voxels(std::int32_t i, std::int32_t j, std::int32_t k, Touched&& touched) const {
    const Box3d around = reach(i, j, k);
    VoxelBox box;
    for (int a = 0; a < 3; ++a) {
      const double lower = std::max(around.lower[a], -0.5);
      const double upper = std::min(around.upper[a], proxy_size_[a] - 0.5);
      if (!(lower <= upper)) return {{0, 0, 0}, {-1, -1, -1}};
      touched(lower, upper, proxy_size_[a], box.first[a], box.last[a]);
    }
    return box;
  }

  std::int32_t cell_voxels_;
  std::int32_t last_cell_[3], proxy_size_[3];
  double main_end_[3];
  Affined map_;  ///< p_index of the proxy from p_index of the main grid
  Vec3d slack_;
};

}  // namespace voxlume
