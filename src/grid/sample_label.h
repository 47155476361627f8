#pragma once
#include "grid/sample.h"

namespace voxlume {

/// How far sample_smooth_label reads from the nearest voxel.
inline constexpr int kSmoothLabelReach = 1;

/// The label that most of the 27 voxels around p_index have, weighted by a quadratic B-spline: labels without
/// the stairs of their voxels. Never a label that none of them has; what is thinner than about a voxel is
/// lost. Of labels with the same weight, the first in memory. NaN where the nearest voxel is.
inline float sample_smooth_label(const GridView& grid, Vec3f p_index) noexcept {
  const std::int64_t stride[3] = {1, grid.stride_j, grid.stride_k};
  std::int64_t offset[3][3];
  float weight[3][3];
  for (int a = 0; a < 3; ++a) {
    const auto last = static_cast<float>(grid.size[a] - 1);
    const float p = std::clamp(p_index[a], 0.0f, last);
    const auto nearest = static_cast<std::int32_t>(p + 0.5f);
    const float t = p - static_cast<float>(nearest);
    weight[a][0] = 0.5f * (0.5f - t) * (0.5f - t);
    weight[a][1] = 0.75f - t * t;
    weight[a][2] = 0.5f * (0.5f + t) * (0.5f + t);
    for (int n = 0; n < 3; ++n) offset[a][n] = std::clamp(nearest + n - 1, 0, grid.size[a] - 1) * stride[a];
  }
  return with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    const auto own = voxels[offset[0][1] + offset[1][1] + offset[2][1]];
    // Within a label all are alike.
    bool alike = true;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j) {
        const auto* row = voxels + offset[2][k] + offset[1][j];
        alike &= (row[offset[0][0]] == own) & (row[offset[0][1]] == own) & (row[offset[0][2]] == own);
      }
    if (alike || own != own) return static_cast<float>(own);
    float labels[27], shares[27];
    int count = 0;
    for (int k = 0; k < 3; ++k)
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < 3; ++i) {
          const auto label = static_cast<float>(voxels[offset[2][k] + offset[1][j] + offset[0][i]]);
          int at = 0;
          while (at < count && labels[at] != label) ++at;
          if (at == count) {
            labels[count] = label;
            shares[count++] = 0;
          }
          shares[at] += weight[2][k] * weight[1][j] * weight[0][i];
        }
    int most = 0;
    for (int n = 1; n < count; ++n)
      if (shares[n] > shares[most]) most = n;
    return labels[most];
  });
}

}  // namespace voxlume
