#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>
#include <utility>
#include <vector>

#include "base/affine.h"
#include "sampling/rng.h"
#include "voxlume/volume.h"

namespace voxlume::test {

template <class T>
constexpr VoxelType voxel_type_of() {
  if constexpr (std::is_same_v<T, std::uint8_t>) return VoxelType::kU8;
  if constexpr (std::is_same_v<T, std::int8_t>) return VoxelType::kI8;
  if constexpr (std::is_same_v<T, std::uint16_t>) return VoxelType::kU16;
  if constexpr (std::is_same_v<T, std::int16_t>) return VoxelType::kI16;
  if constexpr (std::is_same_v<T, std::uint32_t>) return VoxelType::kU32;
  if constexpr (std::is_same_v<T, std::int32_t>) return VoxelType::kI32;
  if constexpr (std::is_same_v<T, float>) return VoxelType::kF32;
  if constexpr (std::is_same_v<T, double>) return VoxelType::kF64;
}

using Size3 = std::array<std::int64_t, 3>;

/// Where a volume lies in LPS space.
struct Placement {
  std::array<double, 3> spacing_mm{1, 1, 1}, origin_mm{0, 0, 0};
  std::array<double, 9> direction{1, 0, 0, 0, 1, 0, 0, 0, 1};
};

/// Directions as scanners give them: upright, mirrored, axes exchanged, and a tilted left-handed one.
inline std::vector<Placement> placements() {
  const double c0 = std::cos(0.4), s0 = std::sin(0.4), c1 = std::cos(-1.1), s1 = std::sin(-1.1);
  const std::array<double, 9> tilted{c0, -s0 * c1, -s0 * s1, s0, c0 * c1, c0 * s1, 0, s1, -c1};
  return {{},
          {{0.7, 0.7, 2.5}, {-120, 40, 300}, {1, 0, 0, 0, -1, 0, 0, 0, 1}},
          {{1.5, 0.4, 0.9}, {10, -20, 30}, {0, 0, 1, -1, 0, 0, 0, 1, 0}},
          {{0.957, 1.2, 3.1}, {-80.5, 121.25, -410}, tilted}};
}

/// A volume whose voxel (i,j,k) is value(i,j,k).
template <class T, class Value>
Volume make_volume(Size3 size, Value&& value, const Placement& placement = {}) {
  auto voxels = std::make_shared<std::vector<T>>();
  voxels->reserve(static_cast<std::size_t>(size[0] * size[1] * size[2]));
  for (std::int64_t k = 0; k < size[2]; ++k)
    for (std::int64_t j = 0; j < size[1]; ++j)
      for (std::int64_t i = 0; i < size[0]; ++i) voxels->push_back(static_cast<T>(value(i, j, k)));
  Volume volume;
  volume.size = size;
  volume.type = voxel_type_of<T>();
  volume.spacing_mm = placement.spacing_mm;
  volume.origin_mm = placement.origin_mm;
  volume.direction = placement.direction;
  volume.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  return volume;
}

/// Independent uniform voxels over [lower, upper].
template <class T>
Volume noise_volume(Size3 size, double lower, double upper, std::uint64_t seed,
                    const Placement& placement = {}) {
  Rng rng(seed, 0, 0, 0);
  return make_volume<T>(
      size, [&](auto, auto, auto) { return lower + (upper - lower) * static_cast<double>(rng.next()); },
      placement);
}

/// Noise over much of what T can hold, or over [-1000, 1000] for floating point.
template <class T>
Volume noise_volume(Size3 size, std::uint64_t seed, const Placement& placement = {}) {
  if constexpr (std::is_floating_point_v<T>) return noise_volume<T>(size, -1000, 1000, seed, placement);
  return noise_volume<T>(size, static_cast<double>(std::numeric_limits<T>::min()),
                         static_cast<double>(std::numeric_limits<T>::max()), seed, placement);
}

/// A voxel as the float that the library promises to interpolate, read without the library.
template <class T>
float voxel_at(const Volume& volume, std::int64_t i, std::int64_t j, std::int64_t k) {
  const auto* voxels = static_cast<const T*>(volume.voxels.get());
  return static_cast<float>(voxels[(k * volume.size[1] + j) * volume.size[0] + i]);
}

/// Trilinear interpolation in double precision as a weighted sum over the eight voxels; clamped at the
/// borders.
template <class T>
double reference_trilinear(const Volume& volume, Vec3d p_index) {
  std::int64_t low[3];
  double weight[3];
  for (int a = 0; a < 3; ++a) {
    const double p = std::min(std::max(p_index[a], 0.0), static_cast<double>(volume.size[a] - 1));
    low[a] = static_cast<std::int64_t>(std::floor(p));
    weight[a] = p - std::floor(p);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    std::int64_t at[3];
    double w = 1;
    for (int a = 0; a < 3; ++a) {
      const bool upper = corner >> a & 1;
      at[a] = std::min(low[a] + upper, volume.size[a] - 1);
      w *= upper ? weight[a] : 1 - weight[a];
    }
    if (w > 0) sum += w * static_cast<double>(voxel_at<T>(volume, at[0], at[1], at[2]));
  }
  return sum;
}

/// A point anywhere in the domain [-1/2, n-1/2].
inline Vec3f random_point(const Volume& volume, Rng& rng) {
  Vec3f p;
  for (int a = 0; a < 3; ++a) p[a] = rng.next() * static_cast<float>(volume.size[a]) - 0.5f;
  return p;
}

}  // namespace voxlume::test
