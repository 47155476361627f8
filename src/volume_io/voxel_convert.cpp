#include "volume_io/voxel_convert.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "base/fail.h"

namespace voxlume {
namespace {

template <typename T>
T load(const void* from, std::uint64_t i) {
  T value;
  std::memcpy(&value, static_cast<const unsigned char*>(from) + i * sizeof(T), sizeof(T));
  return value;
}

template <typename T>
void store(void* to, std::uint64_t i, T value) {
  std::memcpy(static_cast<unsigned char*>(to) + i * sizeof(T), &value, sizeof(T));
}

template <typename T>
T rounded(double value) {
  if constexpr (std::is_floating_point_v<T>) {
    return static_cast<T>(value);
  } else {
    if (std::isnan(value)) return T{0};
    return static_cast<T>(std::clamp(std::nearbyint(value),
                                     static_cast<double>(std::numeric_limits<T>::lowest()),
                                     static_cast<double>(std::numeric_limits<T>::max())));
  }
}

template <typename Wide>
void narrow(const std::filesystem::path& path, void* voxels, std::uint64_t count) {
  for (std::uint64_t i = 0; i < count; ++i) {
    const Wide value = load<Wide>(voxels, i);
    if (!std::in_range<std::int32_t>(value)) {
      fail(ErrorCode::kUnsupported, path,
           fmt::format(
               "64-bit integers beyond the 32-bit range (voxel {} is {}); convert to 32-bit integers or "
               "floating point first",
               i, value));
    }
    store(voxels, i, static_cast<std::int32_t>(value));
  }
}

}  // namespace

void rescale_voxels(const void* in, VoxelType in_type, void* out, VoxelType out_type, std::uint64_t count,
                    double slope, double intercept) {
  with_voxel_type(in_type, [&](auto in_zero) {
    with_voxel_type(out_type, [&](auto out_zero) {
      using In = decltype(in_zero);
      using Out = decltype(out_zero);
      for (std::uint64_t i = 0; i < count; ++i) {
        store(out, i, rounded<Out>(static_cast<double>(load<In>(in, i)) * slope + intercept));
      }
    });
  });
}

void narrow_wide_integers(const std::filesystem::path& path, WideInteger from, void* voxels,
                          std::uint64_t count) {
  if (from == WideInteger::kI64) narrow<std::int64_t>(path, voxels, count);
  if (from == WideInteger::kU64) narrow<std::uint64_t>(path, voxels, count);
}

}  // namespace voxlume
