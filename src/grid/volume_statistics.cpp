#include "grid/volume_statistics.h"

#include <bit>
#include <limits>
#include <mutex>
#include <type_traits>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr int kBins = 1 << 16;
constexpr int kNoBin = kBins;  // what is not counted
using Counts = std::vector<std::uint64_t>;

/// Counts of bins. Neighbours take turns between two tables: where equal values stand side by side, each
/// would wait for the sum of the one before.
class Tally {
 public:
  Tally() : counts_(2 * kTable, 0) {}
  /// Adds one to bin bin_of(i), in [0, kNoBin], for each i in [0, n).
  template <class BinOf>
  void add_row(std::int64_t n, const BinOf& bin_of) {
    std::uint64_t* even = counts_.data();
    std::uint64_t* odd = even + kTable;
    std::int64_t i = 0;
    for (; i + 1 < n; i += 2) {
      ++even[bin_of(i)];
      ++odd[bin_of(i + 1)];
    }
    if (i < n) ++even[bin_of(i)];
  }
  void add_to(Counts& total) const {
    for (int b = 0; b < kBins; ++b) total[b] += counts_[b] + counts_[kTable + b];
  }

 private:
  static constexpr int kTable = kBins + 1;
  Counts counts_;
};

struct Extent {
  double lower = std::numeric_limits<double>::max(), upper = std::numeric_limits<double>::lowest();
  std::uint64_t nonfinite = 0;
};

template <class T>
Extent find_extent(const T* voxels, const GridView& grid, ProgressCounter& slices_done) {
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
    slices_done.add();
  });
  return total;
}

/// b - a, rounded to a float.
template <class T>
float difference(T a, T b) {
  if constexpr (sizeof(T) <= 2) return static_cast<float>(int{b} - int{a});
  if constexpr (std::is_same_v<T, float>) return b - a;
  return static_cast<float>(static_cast<double>(b) - static_cast<double>(a));
}

// A positive float's bits grow with its value: its upper 16 bits are a logarithmic bin, 1/128 wide.
int magnitude_bin(float magnitude) {
  constexpr int kInfinity = 0x7f80;
  const auto bin = static_cast<int>((std::bit_cast<std::uint32_t>(magnitude) >> 16) & 0x7fffu);
  return bin < kInfinity ? bin : kNoBin;
}
float magnitude_of_bin(int bin) {
  return std::bit_cast<float>((static_cast<std::uint32_t>(bin) << 16) | 0x8000u);
}

/// Voxel i of a row of n voxels has its neighbours at row[i-1], row[i+1], front[i], back[i], below[i] and
/// above[i]; where there is none, the voxel itself stands for it.
template <class T>
struct RowNeighbours {
  const T *row, *front, *back, *below, *above;
  std::int64_t n;
};

/// Magnitudes of the central differences times `per_mm`, for every voxel of a row.
template <class T>
void row_magnitudes(const RowNeighbours<T>& at, Vec3f per_mm, float* magnitudes) {
  const auto magnitude = [&](std::int64_t i, std::int64_t left, std::int64_t right) {
    return length(per_mm * Vec3f(difference(at.row[left], at.row[right]), difference(at.front[i], at.back[i]),
                                 difference(at.below[i], at.above[i])));
  };
  for (std::int64_t i = 1; i < at.n - 1; ++i) magnitudes[i] = magnitude(i, i - 1, i + 1);
  magnitudes[0] = magnitude(0, 0, std::min<std::int64_t>(1, at.n - 1));
  magnitudes[at.n - 1] = magnitude(at.n - 1, std::max<std::int64_t>(at.n - 2, 0), at.n - 1);
}

struct Histograms {
  Counts values = Counts(kBins, 0), gradients = Counts(kBins, 0);
};

/// Counts values by bin_of(value) and gradients by their magnitude, row by row, so that every slice comes
/// from memory once. Addition of counts does not depend on the order.
template <class T, class BinOf>
Histograms count_voxels(const T* voxels, const GridView& grid, const BinOf& bin_of,
                        ProgressCounter& slices_done) {
  Vec3f per_mm;  // one over twice the spacing of each axis
  for (int a = 0; a < 3; ++a) per_mm[a] = 0.5f * grid.step_index[a] / grid.step_mm;
  Histograms total;
  std::mutex mutex;
  const std::int64_t slices = grid.size[2];
  const std::int64_t grain = std::max<std::int64_t>(1, slices / (4 * thread_count()));
  parallel_for((slices + grain - 1) / grain, 1, [&](std::int64_t run) {
    Tally values, gradients;
    std::vector<float> magnitudes(grid.size[0]);
    for (std::int64_t k = run * grain; k < std::min(slices, (run + 1) * grain); ++k) {
      const std::int64_t below = k > 0 ? -grid.stride_k : 0, above = k + 1 < slices ? grid.stride_k : 0;
      for (std::int64_t j = 0; j < grid.size[1]; ++j) {
        const T* row = voxels + k * grid.stride_k + j * grid.stride_j;
        const T* front = j > 0 ? row - grid.stride_j : row;
        const T* back = j + 1 < grid.size[1] ? row + grid.stride_j : row;
        values.add_row(grid.size[0], [&](std::int64_t i) { return bin_of(row[i]); });
        row_magnitudes<T>({row, front, back, row + below, row + above, grid.size[0]}, per_mm,
                          magnitudes.data());
        gradients.add_row(grid.size[0], [&](std::int64_t i) { return magnitude_bin(magnitudes[i]); });
      }
      slices_done.add();
    }
    const std::lock_guard lock(mutex);
    values.add_to(total.values);
    gradients.add_to(total.gradients);
  });
  return total;
}

float gradient_percentile(const Counts& counts, double fraction) {
  std::uint64_t total = 0, seen = 0;
  for (int b = 1; b < kBins; ++b) total += counts[b];  // bin 0: no gradient
  const auto wanted = static_cast<std::uint64_t>(std::ceil(fraction * static_cast<double>(total)));
  for (int b = 1; b < kBins; ++b) {
    seen += counts[b];
    if (counts[b] && seen >= wanted) return std::max(magnitude_of_bin(b), std::numeric_limits<float>::min());
  }
  return 1;
}

/// Integers of up to 16 bits: a bin per value.
template <class T>
VolumeStatistics statistics_of_short(const T* voxels, const GridView& grid, const Progress& progress) {
  constexpr int kLowest = std::numeric_limits<T>::lowest();
  ProgressCounter slices_done(grid.size[2], progress);
  const Histograms counts = count_voxels(
      voxels, grid, [](T v) { return int{v} - kLowest; }, slices_done);
  VolumeStatistics out;
  for (int b = 0; b < kBins; ++b)
    if (counts.values[b]) out.histogram.emplace_back(static_cast<float>(b + kLowest), counts.values[b]);
  out.lower = out.histogram.front().first;
  out.upper = out.histogram.back().first;
  out.gradient_p999 = gradient_percentile(counts.gradients, 0.999);
  return out;
}

/// Other types: bins that divide the range, which is found first.
template <class T>
VolumeStatistics statistics_of_wide(const T* voxels, const GridView& grid, const Progress& progress) {
  VolumeStatistics out;
  ProgressCounter slices_done(2 * grid.size[2], progress);
  const Extent extent = find_extent(voxels, grid, slices_done);
  out.nonfinite_voxels = extent.nonfinite;
  if (extent.lower > extent.upper) return out;
  out.lower = static_cast<float>(extent.lower);
  out.upper = static_cast<float>(extent.upper);
  const double width = extent.upper - extent.lower;
  // A width too small or too large for a double has one bin.
  const double ideal = width > 0 ? (kBins - 1) / width : 0;
  const double bins_per_unit = std::isfinite(ideal) ? ideal : 0;
  const auto bin_of = [&](T voxel) {
    const auto v = static_cast<double>(voxel);
    if (!std::isfinite(v)) return kNoBin;
    return bins_per_unit > 0 ? static_cast<int>((v - extent.lower) * bins_per_unit) : 0;
  };
  const Histograms counts = count_voxels(voxels, grid, bin_of, slices_done);
  for (int b = 0; b < kBins; ++b) {
    if (!counts.values[b]) continue;
    const double value = bins_per_unit > 0 ? extent.lower + b / bins_per_unit : extent.lower;
    out.histogram.emplace_back(static_cast<float>(value), counts.values[b]);
  }
  out.gradient_p999 = gradient_percentile(counts.gradients, 0.999);
  return out;
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

VolumeStatistics compute_statistics(const GridView& grid, const Progress& progress) {
  return with_voxels(grid.type, grid.voxels, [&](const auto* voxels) {
    if constexpr (sizeof(*voxels) <= 2) return statistics_of_short(voxels, grid, progress);
    return statistics_of_wide(voxels, grid, progress);
  });
}

}  // namespace voxlume
