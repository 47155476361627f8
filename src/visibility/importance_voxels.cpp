#include "visibility/importance_voxels.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr std::int64_t kRowsAtOnce = 16;

}  // namespace

std::vector<std::uint16_t> importance_of_voxels(const ImportanceView& view) {
  const GridView& grid = view.volumes[0].grid;
  const std::int64_t width = grid.size[0], rows = std::int64_t{grid.size[1]} * grid.size[2];
  std::vector<std::uint16_t> out(static_cast<std::size_t>(width * rows));
  parallel_for(rows, kRowsAtOnce, [&](std::int64_t row) {
    const auto j = static_cast<float>(row % grid.size[1]), k = static_cast<float>(row / grid.size[1]);
    for (std::int64_t i = 0; i < width; ++i)
      out[static_cast<std::size_t>(row * width + i)] = static_cast<std::uint16_t>(
          std::lround(importance_at(view, {static_cast<float>(i), j, k}) / kImportanceStep));
  });
  return out;
}

std::vector<std::uint16_t> mean_of_neighbours(const std::vector<std::uint16_t>& voxels,
                                              const std::int32_t (&size)[3]) {
  const std::int64_t width = size[0], height = size[1], depth = size[2];
  std::vector<std::uint16_t> out(voxels.size());
  parallel_for(height * depth, kRowsAtOnce, [&](std::int64_t row) {
    // Columns of 3 x 3, with the outermost once more at either end.
    std::vector<std::uint32_t> columns(static_cast<std::size_t>(width) + 2, 0);
    for (std::int64_t dk = -1; dk <= 1; ++dk)
      for (std::int64_t dj = -1; dj <= 1; ++dj) {
        const std::int64_t j = std::clamp<std::int64_t>(row % height + dj, 0, height - 1);
        const std::int64_t k = std::clamp<std::int64_t>(row / height + dk, 0, depth - 1);
        const std::uint16_t* from = voxels.data() + (k * height + j) * width;
        for (std::int64_t i = 0; i < width; ++i) columns[static_cast<std::size_t>(i) + 1] += from[i];
      }
    columns.front() = columns[1];
    columns.back() = columns[static_cast<std::size_t>(width)];
    std::uint16_t* to = out.data() + row * width;
    for (std::int64_t i = 0; i < width; ++i) {
      const std::uint32_t* around = columns.data() + i;
      to[i] = static_cast<std::uint16_t>((around[0] + around[1] + around[2] + 13) / 27);
    }
  });
  return out;
}

}  // namespace voxlume
