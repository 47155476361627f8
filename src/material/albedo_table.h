#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>

#include "material/glass.h"
#include "material/surface.h"

namespace voxlume {

// Directional albedos: the integrals over wi of what GGX surfaces scatter once, which is less than 1 for what
// is masked and not scattered again. Scattering functions divided by theirs integrate to 1.

/// One directional albedo, and a mean over what it consists of (which one: see the tables).
struct AlbedoEntry {
  float albedo, mean;
};

/// Directional albedos by the cosine of wo and GGX's width, interpolated by cubic polynomials.
class AlbedoTable {
 public:
  static constexpr int kCosines = 40;
  static constexpr int kWidths = 16;

  /// Cosine in [0,1]; widths below kMinAlpha count as kMinAlpha.
  AlbedoEntry at(float cosine, float alpha) const noexcept {
    const float a = std::clamp(alpha, kMinAlpha, 1.0f);
    const Stencil column(place_of(cosine, a), kCosines);
    const Stencil row((std::sqrt(a) - kLeastRoot) * (1.0f / (1.0f - kLeastRoot)), kWidths);
    AlbedoEntry out{0.0f, 0.0f};
    for (int j = 0; j < 4; ++j) {
      const AlbedoEntry* e = &entries_[static_cast<std::size_t>((row.first + j) * kCosines + column.first)];
      float albedo = 0.0f, mean = 0.0f;
      for (int i = 0; i < 4; ++i) {
        albedo += column.weight[i] * e[i].albedo;
        mean += column.weight[i] * e[i].mean;
      }
      out.albedo += row.weight[j] * albedo;
      out.mean += row.weight[j] * mean;
    }
    return {std::clamp(out.albedo, 1e-4f, 1.0f), std::clamp(out.mean, 0.0f, 1.0f)};
  }

  /// Sets one row to entry(cosine, alpha), which takes doubles.
  template <class Entry>
  void fill_row(int row, const Entry& entry) {
    const double root = kLeastRoot + (1.0 - kLeastRoot) * row / (kWidths - 1);
    const double alpha = root * root;
    for (int i = 0; i < kCosines; ++i)
      entries_[static_cast<std::size_t>(row * kCosines + i)] =
          entry(cosine_at(static_cast<double>(i) / (kCosines - 1), alpha), alpha);
  }

 private:
  static constexpr float kLeastRoot = 0.0316227766f;  // of kMinAlpha

  /// The polynomials through four neighbours, at a place in [0,1] of `count` of them.
  struct Stencil {
    int first;
    float weight[4];

    Stencil(float place, int count) noexcept {
      const float x = place * static_cast<float>(count - 1);
      first = std::clamp(static_cast<int>(x) - 1, 0, count - 4);
      const float t = x - static_cast<float>(first), a = t - 1.0f, b = t - 2.0f, c = t - 3.0f;
      weight[0] = a * b * c * (-1.0f / 6.0f);
      weight[1] = t * b * c * 0.5f;
      weight[2] = t * a * c * -0.5f;
      weight[3] = t * a * b * (1.0f / 6.0f);
    }
  };

  /// Where a cosine is among the columns. Masking sets in where the cosine is near alpha, and fastest at 0.
  template <class T>
  static T place_of(T cosine, T alpha) noexcept {
    return T(kLinear) * cosine +
           T(1 - kLinear) * std::sqrt(cosine * (T(1) + T(kLayer) * alpha) / (cosine + T(kLayer) * alpha));
  }
  /// The inverse.
  static double cosine_at(double place, double alpha) noexcept {
    double low = 0.0, high = 1.0;
    for (int i = 0; i < 60 && place < 1.0; ++i) {
      const double middle = 0.5 * (low + high);
      (place_of(middle, alpha) < place ? low : high) = middle;
    }
    return place > 0.0 ? high : 0.0;
  }
  static constexpr float kLinear = 0.4f, kLayer = 2.0f;

  std::array<AlbedoEntry, static_cast<std::size_t>(kCosines) * kWidths> entries_{};
};

/// Of a surface that reflects all, D G2 / (4 cos_o). The mean is that of (1 - wo.h)^5 over what is reflected:
/// Schlick's reflectance averages to f0 + (1 - f0) mean. Relative error of the albedo below 5e-4, of the mean
/// 8e-3 (absolute). Computed at the first call, in tens of milliseconds; thread-safe.
const AlbedoTable& ggx_albedo() noexcept;

/// Of rough glass, seen from either side. The mean is the part of the albedo that is reflected. Relative
/// error of the albedo below 2e-3 for an ior from 1.3 to 3 and 4e-3 for 1.1; toward 1 it reaches 1e-2 at
/// grazing angles, where from inside nearly nothing gets anywhere. The mean is blurred about the critical
/// angle for small alpha.
class GlassAlbedo {
 public:
  /// Takes tens of milliseconds. `ior` is the index inside over outside. Nothing is tabulated below kMinIor,
  /// where light passes straight.
  explicit GlassAlbedo(float ior);

  float ior() const noexcept { return ior_; }
  /// `outside`: wo is on the side the normal points to. Cosine in [0,1]. Not for ior() < kMinIor.
  AlbedoEntry at(bool outside, float cosine, float alpha) const noexcept {
    return (*sides_)[outside ? 0 : 1].at(cosine, alpha);
  }

 private:
  float ior_;
  std::unique_ptr<std::array<AlbedoTable, 2>> sides_;
};

}  // namespace voxlume
