#include "grid/slice.h"

#include <algorithm>
#include <cmath>

#include "grid/grid_view.h"
#include "grid/sample.h"

namespace voxlume {
namespace {

constexpr double kMostSteps = 65534;  // of u16, one of which is taken

/// The axes along which columns and rows lie.
std::array<int, 2> plane_axes(int axis) { return {axis == 0 ? 1 : 0, axis == 2 ? 1 : 2}; }

std::uint16_t encoded(float value, const Slice& slice) {
  if (!std::isfinite(value)) return 0;
  const double step = std::round((static_cast<double>(value) - slice.offset) / slice.scale);
  return static_cast<std::uint16_t>(1 + std::clamp(step, 0.0, kMostSteps));
}

}  // namespace

Slice resample_slice(const Volume& volume, const SliceRequest& request) {
  const GridView grid = make_grid_view(volume);
  const Box3d bounds = world_bounds(volume);
  const auto [column_axis, row_axis] = plane_axes(request.axis);
  const double width_mm = bounds.upper[column_axis] - bounds.lower[column_axis];
  const double height_mm = bounds.upper[row_axis] - bounds.lower[row_axis];

  Slice slice;
  slice.spacing_mm =
      std::max<double>(std::min({volume.spacing_mm[0], volume.spacing_mm[1], volume.spacing_mm[2]}),
                       std::max(width_mm, height_mm) / request.most_samples);
  // A whole number of voxels is not to become one more by rounding.
  const auto count = [&](double length_mm) {
    return std::clamp(static_cast<int>(std::ceil(length_mm / slice.spacing_mm - 1e-6)), 1,
                      request.most_samples);
  };
  slice.width = count(width_mm);
  slice.height = count(height_mm);
  const auto first = [&](int axis, int n) {
    return 0.5 * (bounds.lower[axis] + bounds.upper[axis]) - 0.5 * (n - 1) * slice.spacing_mm;
  };
  slice.origin_mm = {first(column_axis, slice.width), first(row_axis, slice.height)};
  const double range = request.upper - request.lower;
  slice.offset = request.lower;
  slice.scale = request.nearest && range <= kMostSteps ? 1 : range > 0 ? range / kMostSteps : 1;

  const Affined index_from_world = world_from_index(volume).inverse();
  const Box3f inside = grid.index_box();
  slice.samples.resize(static_cast<std::size_t>(slice.width) * slice.height);
  for (int y = 0; y < slice.height; ++y) {
    for (int x = 0; x < slice.width; ++x) {
      Vec3d p_world;
      p_world[request.axis] = request.place_mm;
      p_world[column_axis] = slice.origin_mm[0] + x * slice.spacing_mm;
      p_world[row_axis] = slice.origin_mm[1] + y * slice.spacing_mm;
      const Vec3f p_index(index_from_world.point(p_world));
      if (!inside.contains(p_index)) continue;
      const float value = request.nearest ? sample_nearest(grid, p_index) : sample_trilinear(grid, p_index);
      slice.samples[static_cast<std::size_t>(y) * slice.width + x] = encoded(value, slice);
    }
  }
  return slice;
}

}  // namespace voxlume
