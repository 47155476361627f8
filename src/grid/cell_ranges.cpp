#include "grid/cell_ranges.h"

#include <algorithm>
#include <type_traits>

#include "grid/cells_in_proxy.h"

namespace voxlume {
namespace {

bool same_grid(const GridView& a, const GridView& b) {
  const auto same = [](const Affinef& m, const Affinef& n) {
    return m.column_x == n.column_x && m.column_y == n.column_y && m.column_z == n.column_z &&
           m.translation == n.translation;
  };
  return std::equal(a.size, a.size + 3, b.size) && same(a.world_from_index, b.world_from_index) &&
         same(a.index_from_world, b.index_from_world);
}

/// The range of the voxels of a box, kLanes columns at once; the grid is at least that wide. Columns beside
/// the box may be read, and are left out in the end. Bounds are kept in the voxels' type: converting to float
/// keeps the order (f64 is converted first).
template <int kLanes, class T>
ValueRange range_of(const T* voxels, const GridView& grid, const VoxelBox& box) {
  using Bound = std::conditional_t<std::is_same_v<T, double>, float, T>;
  using Limits = std::numeric_limits<Bound>;
  Bound least = Limits::max(), greatest = Limits::lowest();
  for (std::int32_t i = box.first[0]; i <= box.last[0]; i += kLanes) {
    const std::int32_t first = std::min(i, grid.size[0] - kLanes);
    Bound lower[kLanes], upper[kLanes];
    std::fill_n(lower, kLanes, Limits::max());
    std::fill_n(upper, kLanes, Limits::lowest());
    for (std::int32_t k = box.first[2]; k <= box.last[2]; ++k) {
      const T* row = voxels + k * grid.stride_k + box.first[1] * grid.stride_j + first;
      for (std::int32_t j = box.first[1]; j <= box.last[1]; ++j, row += grid.stride_j)
        for (int x = 0; x < kLanes; ++x) {
          const auto v = static_cast<Bound>(row[x]);
          // A NaN changes neither bound.
          lower[x] = v < lower[x] ? v : lower[x];
          upper[x] = v > upper[x] ? v : upper[x];
        }
    }
    const int end = std::min(kLanes, box.last[0] + 1 - first);
    for (int x = i - first; x < end; ++x) {
      least = std::min(least, lower[x]);
      greatest = std::max(greatest, upper[x]);
    }
  }
  return {static_cast<float>(least), static_cast<float>(greatest)};
}

/// The ranges of the voxels that box_of(i, j, k) says are a cell's, each made what `of_range` makes of it.
template <class BoxOf, class OfRange>
std::vector<ValueRange> ranges_of_boxes(const CellLayout& layout, const GridView& proxy, BoxOf&& box_of,
                                        OfRange&& of_range) {
  constexpr int kLanes = 8;
  std::vector<ValueRange> ranges(static_cast<std::size_t>(layout.place_count()), kNoValues);
  with_voxels(proxy.type, proxy.voxels, [&](const auto* voxels) {
    layout.each_run(
        [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t count, std::int64_t place) {
          for (std::int32_t x = 0; x < count; ++x) {
            const VoxelBox box = box_of(i + x, j, k);
            if (box.empty()) continue;
            ranges[place + x] = of_range(proxy.size[0] < kLanes ? range_of<1>(voxels, proxy, box)
                                                                : range_of<kLanes>(voxels, proxy, box));
          }
        });
  });
  return ranges;
}

}  // namespace

std::vector<ValueRange> value_ranges_over(const GridView& main, int cell_voxels, CellOrder order,
                                          const GridView& proxy) {
  if (same_grid(main, proxy)) return build_value_ranges(proxy, cell_voxels, order).ranges;
  const CellLayout layout(main, cell_voxels, order);
  const CellsInProxy cells(main, layout, proxy);
  return ranges_of_boxes(
      layout, proxy,
      [&](std::int32_t i, std::int32_t j, std::int32_t k) { return cells.interpolated(i, j, k); }, widened);
}

std::vector<ValueRange> label_ranges_over(const GridView& main, int cell_voxels, CellOrder order,
                                          const GridView& labels, Outline outline) {
  const CellLayout layout(main, cell_voxels, order);
  const CellsInProxy cells(main, layout, labels);
  return ranges_of_boxes(
      layout, labels,
      [&](std::int32_t i, std::int32_t j, std::int32_t k) {
        return outline == Outline::kSmooth ? cells.voted(i, j, k) : cells.nearest(i, j, k);
      },
      [](ValueRange range) { return range; });
}

std::vector<std::uint8_t> cells_beyond(const GridView& main, int cell_voxels, CellOrder order,
                                       const GridView& proxy) {
  const CellLayout layout(main, cell_voxels, order);
  const CellsInProxy cells(main, layout, proxy);
  std::vector<std::uint8_t> beyond(static_cast<std::size_t>(layout.place_count()), 1);
  layout.each_run(
      [&](std::int32_t i, std::int32_t j, std::int32_t k, std::int32_t count, std::int64_t place) {
        for (std::int32_t x = 0; x < count; ++x) beyond[place + x] = cells.inside(i + x, j, k) ? 0 : 1;
      });
  return beyond;
}

}  // namespace voxlume
