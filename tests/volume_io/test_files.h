#pragma once
#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/voxel_type.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume::test {

namespace fs = std::filesystem;

/// The bytes of values one after another, little-endian.
template <typename T>
std::string bytes_of(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)};
}

inline double value_at(const Volume& volume, std::size_t i) {
  double value = 0;
  with_voxel_type(volume.type, [&](auto zero) {
    value = static_cast<double>(static_cast<const decltype(zero)*>(volume.voxels.get())[i]);
  });
  return value;
}

/// A volume filled from value(i, j, k), cast to `type`.
inline Volume make_volume(VoxelType type, std::array<std::int64_t, 3> size,
                          const std::function<double(std::int64_t, std::int64_t, std::int64_t)>& value) {
  Volume volume;
  volume.size = size;
  volume.type = type;
  std::shared_ptr<char[]> voxels(new char[volume.byte_count()]);
  with_voxel_type(type, [&](auto zero) {
    auto* out = reinterpret_cast<decltype(zero)*>(voxels.get());
    for (std::int64_t k = 0; k < size[2]; ++k) {
      for (std::int64_t j = 0; j < size[1]; ++j) {
        for (std::int64_t i = 0; i < size[0]; ++i) *out++ = static_cast<decltype(zero)>(value(i, j, k));
      }
    }
  });
  volume.voxels = voxels;
  return volume;
}

/// Values that reach both ends of the type and repeat nowhere near.
inline Volume make_test_volume(VoxelType type, std::array<std::int64_t, 3> size = {7, 5, 4}) {
  return make_volume(type, size, [&](std::int64_t i, std::int64_t j, std::int64_t k) -> double {
    const auto n = static_cast<double>(i + 7 * j + 35 * k);
    double value = 0;
    with_voxel_type(type, [&](auto zero) {
      using T = decltype(zero);
      if constexpr (std::is_floating_point_v<T>) {
        value = n * 0.37 - 11.3;
      } else {
        const auto low = static_cast<double>(std::numeric_limits<T>::lowest());
        const auto high = static_cast<double>(std::numeric_limits<T>::max());
        value = low + std::floor((high - low) * n / 150);
      }
    });
    return value;
  });
}

/// A rotation by `radians` about a unit axis, row-major.
inline std::array<double, 9> rotation(std::array<double, 3> u, double radians) {
  const double c = std::cos(radians);
  const double s = std::sin(radians);
  const double t = 1 - c;
  return {t * u[0] * u[0] + c,        t * u[0] * u[1] - s * u[2], t * u[0] * u[2] + s * u[1],
          t * u[0] * u[1] + s * u[2], t * u[1] * u[1] + c,        t * u[1] * u[2] - s * u[0],
          t * u[0] * u[2] - s * u[1], t * u[1] * u[2] + s * u[0], t * u[2] * u[2] + c};
}

inline std::array<double, 3> p_world_of(const Volume& v, std::array<double, 3> p_index) {
  std::array<double, 3> p = v.origin_mm;
  for (int r = 0; r < 3; ++r) {
    for (int a = 0; a < 3; ++a) p[r] += v.direction[3 * r + a] * v.spacing_mm[a] * p_index[a];
  }
  return p;
}

inline std::array<double, 3> p_index_of(const Volume& v, std::array<double, 3> p_world) {
  std::array<double, 3> p{};
  for (int a = 0; a < 3; ++a) {
    for (int r = 0; r < 3; ++r)
      p[a] += v.direction[3 * r + a] * (p_world[r] - v.origin_mm[r]) / v.spacing_mm[a];
  }
  return p;
}

/// Trilinear value; p_index must lie inside.
inline double interpolate(const Volume& v, std::array<double, 3> p_index) {
  std::array<std::int64_t, 3> base{};
  std::array<double, 3> f{};
  for (int a = 0; a < 3; ++a) {
    base[a] = std::min<std::int64_t>(static_cast<std::int64_t>(std::floor(p_index[a])), v.size[a] - 2);
    f[a] = p_index[a] - static_cast<double>(base[a]);
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    std::int64_t at[3];
    for (int a = 0; a < 3; ++a) {
      const int bit = (corner >> a) & 1;
      weight *= bit ? f[a] : 1 - f[a];
      at[a] = base[a] + bit;
    }
    sum += weight * value_at(v, static_cast<std::size_t>((at[2] * v.size[1] + at[1]) * v.size[0] + at[0]));
  }
  return sum;
}

inline void expect_same_voxels(const Volume& a, const Volume& b) {
  ASSERT_EQ(a.size, b.size);
  ASSERT_EQ(voxel_type_name(a.type), voxel_type_name(b.type));
  ASSERT_TRUE(b.voxels);
  EXPECT_EQ(std::memcmp(a.voxels.get(), b.voxels.get(), a.byte_count()), 0);
}

inline void expect_same_geometry(const Volume& a, const Volume& b, double tolerance = 1e-5) {
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(a.spacing_mm[i], b.spacing_mm[i], tolerance);
    EXPECT_NEAR(a.origin_mm[i], b.origin_mm[i], tolerance);
  }
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(a.direction[i], b.direction[i], tolerance) << "direction " << i;
}

/// True when one of the warnings contains `text`.
inline bool warns(const Volume& volume, std::string_view text) {
  for (const std::string& warning : volume.warnings) {
    if (warning.find(text) != std::string::npos) return true;
  }
  return false;
}

/// Expects an Error of the code with `text` in it, in one line.
inline void expect_error(ErrorCode code, std::string_view text, const std::function<void()>& act) {
  try {
    act();
    ADD_FAILURE() << "expected an error with \"" << text << "\"";
  } catch (const Error& error) {
    const std::string what = error.what();
    EXPECT_EQ(static_cast<int>(error.code()), static_cast<int>(code)) << what;
    EXPECT_NE(what.find(text), std::string::npos) << what;
    EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  }
}

}  // namespace voxlume::test
