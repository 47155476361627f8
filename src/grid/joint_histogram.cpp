#include "grid/joint_histogram.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "grid/grid_view.h"
#include "grid/sample.h"

namespace voxlume {
namespace {

constexpr int kBins = 128;
constexpr double kMostLabelBins = 256;

JointHistogram::Axis axis_of(const JointVolume& volume) {
  const double lower = volume.lower, upper = volume.upper, labels = upper - lower + 1;
  if (volume.nearest && labels <= kMostLabelBins)
    return {lower - 0.5, upper + 0.5, static_cast<int>(std::lround(labels))};
  if (!(upper > lower)) return {lower - 0.5, lower + 0.5, 1};
  return {lower, upper, kBins};
}

/// Finds the bin of a volume's value at a place.
class BinLookup {
 public:
  BinLookup(const JointVolume& volume, const JointHistogram::Axis& axis, const Affined& world_from_over)
      : grid_(make_grid_view(volume.volume)),
        inside_(grid_.index_box()),
        nearest_(volume.nearest),
        axis_(axis) {
    const Affined index_from_world = world_from_index(volume.volume).inverse();
    const auto through = [&](Vec3d v) { return index_from_world.vector(world_from_over.vector(v)); };
    index_from_over_ = Affined(through({1, 0, 0}), through({0, 1, 0}), through({0, 0, 1}),
                               index_from_world.point(world_from_over.translation));
  }

  std::optional<int> at(Vec3d p_over) const {
    const Vec3f p_index(index_from_over_.point(p_over));
    if (!inside_.contains(p_index)) return std::nullopt;
    const double value = nearest_ ? sample_nearest(grid_, p_index) : sample_trilinear(grid_, p_index);
    if (!std::isfinite(value)) return std::nullopt;
    const double share = (value - axis_.lower) / (axis_.upper - axis_.lower);
    return static_cast<int>(std::clamp(share * axis_.bins, 0.0, axis_.bins - 1.0));
  }

 private:
  const GridView grid_;
  const Box3f inside_;
  const bool nearest_;
  const JointHistogram::Axis axis_;
  Affined index_from_over_;
};

/// Every how manieth voxel along each axis is looked at.
std::int64_t stride_of(const Volume& volume, std::int64_t most_samples) {
  std::int64_t stride = 1;
  const auto count = [&] {
    std::int64_t n = 1;
    for (const std::int64_t size : volume.size) n *= (size + stride - 1) / stride;
    return n;
  };
  while (count() > most_samples) ++stride;
  return stride;
}

}  // namespace

JointHistogram joint_histogram(const Volume& over, const JointVolume& x, const JointVolume& y,
                               std::int64_t most_samples) {
  JointHistogram out{axis_of(x), axis_of(y), {}};
  out.counts.assign(static_cast<std::size_t>(out.x.bins) * out.y.bins, 0);
  const Affined world_from_over = world_from_index(over);
  const BinLookup x_bin(x, out.x, world_from_over), y_bin(y, out.y, world_from_over);
  const std::int64_t stride = stride_of(over, most_samples);
  std::array<std::int64_t, 3> first;
  for (std::size_t a = 0; a < 3; ++a) first[a] = std::min(stride / 2, over.size[a] - 1);
  for (std::int64_t k = first[2]; k < over.size[2]; k += stride) {
    for (std::int64_t j = first[1]; j < over.size[1]; j += stride) {
      for (std::int64_t i = first[0]; i < over.size[0]; i += stride) {
        const Vec3d p(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k));
        const auto column = x_bin.at(p), row = y_bin.at(p);
        if (column && row) ++out.counts[static_cast<std::size_t>(*row) * out.x.bins + *column];
      }
    }
  }
  return out;
}

}  // namespace voxlume
