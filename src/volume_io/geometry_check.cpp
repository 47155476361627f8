#include "volume_io/geometry_check.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/fail.h"

namespace voxlume {
namespace {

using Matrix = std::array<double, 9>;

double determinant(const Matrix& m) {
  return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) +
         m[2] * (m[3] * m[7] - m[4] * m[6]);
}

Matrix inverse_transpose(const Matrix& m) {
  const double scale = 1 / determinant(m);
  return {(m[4] * m[8] - m[5] * m[7]) * scale, (m[5] * m[6] - m[3] * m[8]) * scale,
          (m[3] * m[7] - m[4] * m[6]) * scale, (m[2] * m[7] - m[1] * m[8]) * scale,
          (m[0] * m[8] - m[2] * m[6]) * scale, (m[1] * m[6] - m[0] * m[7]) * scale,
          (m[1] * m[5] - m[2] * m[4]) * scale, (m[2] * m[3] - m[0] * m[5]) * scale,
          (m[0] * m[4] - m[1] * m[3]) * scale};
}

/// Largest difference of the columns' dot products from those of an orthonormal matrix.
double orthonormality_error(const Matrix& m) {
  double worst = 0;
  for (int a = 0; a < 3; ++a) {
    for (int b = a; b < 3; ++b) {
      const double dot = m[a] * m[b] + m[3 + a] * m[3 + b] + m[6 + a] * m[6 + b];
      worst = std::max(worst, std::abs(dot - (a == b ? 1 : 0)));
    }
  }
  return worst;
}

/// The orthonormal factor of the polar decomposition, by Newton's iteration (Higham 1986).
Matrix nearest_orthonormal(Matrix m) {
  for (int step = 0; step < 20 && orthonormality_error(m) > 1e-15; ++step) {
    const Matrix other = inverse_transpose(m);
    for (int i = 0; i < 9; ++i) m[i] = 0.5 * (m[i] + other[i]);
  }
  return m;
}

std::string matrix_text(const Matrix& m) { return fmt::format("{:.5g}", fmt::join(m, " ")); }

void check_direction(const std::filesystem::path& path, Volume& volume) {
  // cos(89 degrees): shear or scale beyond it is not a rounding of an orthonormal matrix.
  constexpr double kMaxError = 0.0175;
  constexpr double kRoundingError = 1e-4;
  for (const double d : volume.direction) {
    if (!std::isfinite(d)) fail(ErrorCode::kBadFormat, path, "the direction matrix is not finite");
  }
  const double error = orthonormality_error(volume.direction);
  if (std::abs(determinant(volume.direction)) < 1e-6) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format("the direction matrix ({}) is singular; expected three independent axes",
                     matrix_text(volume.direction)));
  }
  if (error > kMaxError) {
    fail(ErrorCode::kBadFormat, path,
         fmt::format(
             "the direction matrix ({}) is not orthonormal; expected perpendicular axes (resample a sheared "
             "volume first)",
             matrix_text(volume.direction)));
  }
  if (error > kRoundingError) {
    volume.warnings.push_back(fmt::format(
        "the axes are not quite perpendicular (off by {:.2g}); the nearest perpendicular axes are used",
        error));
  }
  if (error > 1e-15) volume.direction = nearest_orthonormal(volume.direction);
}

}  // namespace

void check_geometry(const std::filesystem::path& path, Volume& volume) {
  double bytes = static_cast<double>(voxel_bytes(volume.type));
  for (const std::int64_t n : volume.size) {
    if (n < 1) {
      fail(ErrorCode::kBadFormat, path,
           fmt::format("size {}; expected three sizes of at least 1", fmt::join(volume.size, "x")));
    }
    if (n > kMaxAxisVoxels) {
      fail(ErrorCode::kUnsupported, path,
           fmt::format("size {}; expected at most {} along each axis", fmt::join(volume.size, "x"),
                       kMaxAxisVoxels));
    }
    bytes *= static_cast<double>(n);
  }
  if (bytes > 0x1p60) {
    fail(ErrorCode::kBadFormat, path, fmt::format("size {} is absurd", fmt::join(volume.size, "x")));
  }
  for (const double s : volume.spacing_mm) {
    if (!(std::isfinite(s) && s > 0)) {
      fail(ErrorCode::kBadFormat, path,
           fmt::format("spacing {:.6g}; expected three finite numbers above 0 (mm)",
                       fmt::join(volume.spacing_mm, " x ")));
    }
  }
  for (const double x : volume.origin_mm) {
    if (!std::isfinite(x)) fail(ErrorCode::kBadFormat, path, "the origin is not finite");
  }
  check_direction(path, volume);
}

void set_axes(Volume& volume, const std::array<double, 9>& m) {
  for (int a = 0; a < 3; ++a) {
    const double length = std::sqrt(m[a] * m[a] + m[3 + a] * m[3 + a] + m[6 + a] * m[6 + a]);
    volume.spacing_mm[a] = length;
    for (int r = 0; r < 3; ++r) volume.direction[3 * r + a] = length > 0 ? m[3 * r + a] / length : 0;
  }
}

}  // namespace voxlume
