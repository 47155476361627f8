#include "grid/volume_statistics.h"

#include <bit>
#include <limits>
#include <mutex>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr int kBins = 1 << 16;
using Counts = std::vector<std::uint64_t>;

// Sums one histogram per slice; addition of counts does not depend on the order.
template <class Fill>
Counts count_slices(const GridView& grid, const Fill& fill) {
  Counts total(kBins, 0);
  std::mutex mutex;
  const std::int64_t slices = grid.size[2];
  const std::int64_t grain = std::max<std::int64_t>(1, slices / (4 * thread_count()));
  parallel_for((slices + grain - 1) / grain, 1, [&](std::int64_t run) {
    Counts counts(kBins, 0);
    for (std::int64_t k = run * grain; k < std::min(slices, (run + 1) * grain); ++k) fill(k, counts);
    const std::lock_guard lock(mutex);
    for (int b = 0; b < kBins; ++b) total[b] += counts[b];
  });
  return total;
}

struct Extent {
  double lower = std::numeric_limits<double>::max(), upper = std::numeric_limits<double>::lowest();
  std::uint64_t nonfinite = 0;
};

template <class T>
Extent find_extent(const T* voxels, const GridView& grid) {
  Extent total;
  std::mutex mutex;
  parallel_for(grid.size[2], 4, [&](std::int64_t k) {
    Extent extent;
    const T* slice = voxels + k * grid.stride_k;
    for (std::int64_t i = 0; i < grid.stride_k; ++i) {
      const double v = static_cast<double>(slice[i]);
      if (!std::isfinite(v)) {
        ++extent.nonfinite;
        continue;
      }
      extent.lower = std::min(extent.lower, v);
      extent.upper = std::max(extent.upper, v);
    }
    const std::lock_guard lock(mutex);
    total.lower = std::min(total.lower, extent.lower);
    total.upper = std::max(total.upper, extent.upper);
    total.nonfinite += extent.nonfinite;
  });
  return total;
}

// A positive float's bits grow with its value: its upper 16 bits are a logarithmic bin, 1/128 wide.
int magnitude_bin(float magnitude) { return static_cast<int>(std::bit_cast<std::uint32_t>(magnitude) >> 16); }
float magnitude_of_bin(int bin) {
  return std::bit_cast<float>((static_cast<std::uint32_t>(bin) << 16) | 0x8000u);
}

template <class T>
float gradient_percentile(const T* voxels, const GridView& grid, double fraction) {
  Vec3f per_mm;  // one over twice the spacing of each axis
  for (int a = 0; a < 3; ++a) per_mm[a] = 0.5f * grid.step_index[a] / grid.step_mm;
  const Counts counts = count_slices(grid, [&](std::int64_t k, Counts& bins) {
    const std::int64_t below = k > 0 ? -grid.stride_k : 0, above = k + 1 < grid.size[2] ? grid.stride_k : 0;
    for (std::int64_t j = 0; j < grid.size[1]; ++j) {
      const std::int64_t front = j > 0 ? -grid.stride_j : 0, back = j + 1 < grid.size[1] ? grid.stride_j : 0;
      const T* row = voxels + k * grid.stride_k + j * grid.stride_j;
      for (std::int64_t i = 0; i < grid.size[0]; ++i) {
        const T* v = row + i;
        const auto difference = [&](std::int64_t lower, std::int64_t upper) {
          return static_cast<float>(static_cast<double>(v[upper]) - static_cast<double>(v[lower]));
        };
        const Vec3f gradient = per_mm * Vec3f(difference(i > 0 ? -1 : 0, i + 1 < grid.size[0] ? 1 : 0),
                                              difference(front, back), difference(below, above));
        const float magnitude = length(gradient);
        if (std::isfinite(magnitude)) ++bins[magnitude_bin(magnitude)];
      }
    }
  });
  std::uint64_t total = 0, seen = 0;
  for (int b = 1; b < kBins; ++b) total += counts[b];  // bin 0: no gradient
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(total)));
  for (int b = 1; b < kBins; ++b) {
    seen += counts[b];
    if (counts[b] && seen >= wanted) return std::max(magnitude_of_bin(b), std::numeric_limits<float>::min());
  }
  return 1;
}

}  // namespace

float VolumeStatistics::percentile(double fraction) const {
  std::uint64_t total = 0, seen = 0;
  for (const auto& [value, count] : histogram) total += count;
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(total)));
  for (const auto& [value, count] : histogram) {
    seen += count;
    if (seen >= wanted) return value;
  }
  return upper;
}

VolumeStatistics compute_statistics(const GridView& grid) {
  return with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    VolumeStatistics out;
    const Extent extent = find_extent(voxels, grid);
    out.nonfinite_voxels = extent.nonfinite;
    if (extent.lower > extent.upper) return out;
    out.lower = static_cast<float>(extent.lower);
    out.upper = static_cast<float>(extent.upper);
    const double width = extent.upper - extent.lower;
    // Integers of up to 16 bits get a bin per value. A width too small or too large for a double has one bin.
    const double ideal = sizeof(*voxels) <= 2 ? 1.0 : width > 0 ? (kBins - 1) / width : 0;
    const double bins_per_unit = std::isfinite(ideal) ? ideal : 0;
    const Counts counts = count_slices(grid, [&](std::int64_t k, Counts& bins) {
      const auto* slice = voxels + k * grid.stride_k;
      for (std::int64_t i = 0; i < grid.stride_k; ++i) {
        const double v = static_cast<double>(slice[i]);
        if (std::isfinite(v))
          ++bins[bins_per_unit > 0 ? static_cast<int>((v - extent.lower) * bins_per_unit) : 0];
      }
    });
    for (int b = 0; b < kBins; ++b) {
      if (!counts[b]) continue;
      const double value = bins_per_unit > 0 ? extent.lower + b / bins_per_unit : extent.lower;
      out.histogram.emplace_back(static_cast<float>(value), counts[b]);
    }
    out.gradient_p999 = gradient_percentile(voxels, grid, 0.999);
    return out;
  });
}

}  // namespace voxlume
