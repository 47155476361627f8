#include "grid/label_surface.h"

#include <cmath>
#include <type_traits>

#include "grid/label_kernel.h"

namespace voxlume {
namespace {

/// The kernel's integral over reach times its peak.
constexpr float kArea = 32.0f / 35.0f;

/// Weights of the voxels around a coordinate, and their derivatives by it. The weights add up to 1 wherever
/// the voxels lie, and so the derivatives to 0.
struct Taps {
  int count;
  float weight[kMostLabelTaps], slope[kMostLabelTaps];
  std::int64_t offset[kMostLabelTaps];  ///< of the voxel, in memory

  Taps(float p, float reach, std::int32_t size, std::int64_t stride) {
    const auto first = static_cast<std::int32_t>(std::ceil(p - reach));
    count = static_cast<std::int32_t>(std::floor(p + reach)) - first + 1;
    float sum = 0, slope_sum = 0;
    for (int n = 0; n < count; ++n) {
      const float t = (static_cast<float>(first + n) - p) / reach;
      const float rest = std::max(1 - t * t, 0.0f);
      weight[n] = rest * rest * rest;
      slope[n] = 6 / reach * t * rest * rest;
      sum += weight[n];
      slope_sum += slope[n];
      offset[n] = std::clamp(first + n, 0, size - 1) * stride;
    }
    for (int n = 0; n < count; ++n) {
      slope[n] = (slope[n] - weight[n] * slope_sum / sum) / sum;
      weight[n] /= sum;
    }
  }
};

/// Gradient, by index, of the smoothed share of labels other than `own`.
template <class T>
Vec3f share_gradient(const T* voxels, const Taps (&taps)[3], T own) noexcept {
  Vec3f gradient;
  for (int k = 0; k < taps[2].count; ++k) {
    float weight = 0, slope_i = 0, slope_j = 0;  // of this slice
    for (int j = 0; j < taps[1].count; ++j) {
      const T* row = voxels + taps[2].offset[k] + taps[1].offset[j];
      float row_weight = 0, row_slope = 0;
      for (int i = 0; i < taps[0].count; ++i) {
        const float other = row[taps[0].offset[i]] == own ? 0.0f : 1.0f;
        row_weight += other * taps[0].weight[i];
        row_slope += other * taps[0].slope[i];
      }
      weight += taps[1].weight[j] * row_weight;
      slope_i += taps[1].weight[j] * row_slope;
      slope_j += taps[1].slope[j] * row_weight;
    }
    gradient += Vec3f(taps[2].weight[k] * slope_i, taps[2].weight[k] * slope_j, taps[2].slope[k] * weight);
  }
  return gradient;
}

}  // namespace

Vec3f label_normal(const GridView& labels, Vec3f p_index, float label) noexcept {
  if (!(label == label)) return Vec3f(0);
  const Box3f box = labels.index_box();
  const Vec3f p = min(max(p_index, box.lower), box.upper);
  const std::int64_t stride[3] = {1, labels.stride_j, labels.stride_k};
  const Vec3f reach = label_kernel_reach(labels);
  const Taps taps[3] = {{p.x, reach.x, labels.size[0], stride[0]},
                        {p.y, reach.y, labels.size[1], stride[1]},
                        {p.z, reach.z, labels.size[2], stride[2]}};
  const Vec3f gradient = with_voxels(labels.type, labels.voxels, [&](const auto* voxels) {
    return share_gradient(voxels, taps, static_cast<std::remove_cvref_t<decltype(*voxels)>>(label));
  });
  // Smoothed, a straight boundary is as steep as the kernel is narrow along its normal.
  const float steepness = length(gradient * reach) * kArea;
  // Without other labels about, what is left is the rounding of sums that are 0.
  if (!(steepness > 1e-6f)) return Vec3f(0);
  // A gradient is a row: it goes to space by the transpose of the map from space.
  const Affinef& map = labels.index_from_world;
  const Vec3f outward(dot(gradient, map.column_x), dot(gradient, map.column_y), dot(gradient, map.column_z));
  return outward * (std::min(steepness, 1.0f) / length(outward));
}

}  // namespace voxlume
