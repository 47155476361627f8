#pragma once
#include <memory>
#include <vector>

#include "base/parallel.h"
#include "grid/sample.h"
#include "voxlume/volume.h"

namespace voxlume {

/// The volume stretched to edge^3 voxels.
inline Volume stretched(const Volume& from, std::int64_t edge) {
  const GridView grid = make_grid_view(from);
  const auto count = static_cast<std::size_t>(edge * edge * edge);
  auto voxels = std::make_shared<std::vector<std::int16_t>>(count);
  parallel_for(edge, 1, [&](std::int64_t k) {
    for (std::int64_t j = 0; j < edge; ++j)
      for (std::int64_t i = 0; i < edge; ++i) {
        const std::int64_t at[3] = {i, j, k};
        Vec3f p;
        for (int a = 0; a < 3; ++a)
          p[a] =
              static_cast<float>(at[a]) * static_cast<float>(grid.size[a] - 1) / static_cast<float>(edge - 1);
        (*voxels)[static_cast<std::size_t>((k * edge + j) * edge + i)] =
            static_cast<std::int16_t>(sample_trilinear(grid, p));
      }
  });
  Volume out;
  out.size = {edge, edge, edge};
  out.type = VoxelType::kI16;
  for (int a = 0; a < 3; ++a)
    out.spacing_mm[a] = from.spacing_mm[a] * static_cast<double>(from.size[a]) / static_cast<double>(edge);
  out.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  return out;
}

}  // namespace voxlume
