// Weights between pixels by Guides; included once for every target (no include guard of the usual kind).
#if defined(VOXLUME_DENOISE_GUIDES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_DENOISE_GUIDES_INL_H_
#undef VOXLUME_DENOISE_GUIDES_INL_H_
#else
#define VOXLUME_DENOISE_GUIDES_INL_H_
#endif

#include <array>
#include <cmath>

#include "denoise/guides.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// A neighbour of a pixel.
struct Tap {
  std::ptrdiff_t offset;   ///< from the pixel, in values of a plane
  float log_kernel;        ///< of the weight that the neighbour has by its place alone
  float inverse_distance;  ///< [1/pixels]; 0 for the pixel itself
};

/// (2 kRadius + 1)^2 taps, `step` pixels apart. `kernel` has the weight for a distance of 0..kRadius taps
/// along one axis.
template <int kRadius>
std::array<Tap, (2 * kRadius + 1) * (2 * kRadius + 1)> make_taps(
    int stride, int step, const std::array<float, kRadius + 1>& kernel) {
  std::array<Tap, (2 * kRadius + 1) * (2 * kRadius + 1)> taps;
  Tap* tap = taps.data();
  for (int dy = -kRadius; dy <= kRadius; ++dy) {
    for (int dx = -kRadius; dx <= kRadius; ++dx) {
      const float distance = static_cast<float>(step) * std::sqrt(static_cast<float>(dx * dx + dy * dy));
      *tap++ = {static_cast<std::ptrdiff_t>(dy * step) * stride + dx * step,
                std::log(kernel[std::abs(dx)] * kernel[std::abs(dy)]), distance > 0 ? 1 / distance : 0};
    }
  }
  return taps;
}

/// Where a row's colours or vectors begin.
struct Rows3 {
  const float *x, *y, *z;
  Rows3(const Planes3& planes, int row)
      : x(planes[0].row(row)), y(planes[1].row(row)), z(planes[2].row(row)) {}
  HWY_INLINE F3 at(std::ptrdiff_t i) const {
    return {hn::LoadU(kD, x + i), hn::LoadU(kD, y + i), hn::LoadU(kD, z + i)};
  }
};

struct GuideRows {
  const float *depth, *depth_rate, *feature_rate;
  Rows3 normal, albedo;
  GuideRows(const Guides& guides, int row)
      : depth(guides.depth_mm.row(row)),
        depth_rate(guides.depth_rate.row(row)),
        feature_rate(guides.feature_rate.row(row)),
        normal(guides.normal, row),
        albedo(guides.albedo, row) {}
};

/// The pixels that neighbours are weighted for.
struct GuideCentre {
  F depth, depth_rate, feature_rate;
  F3 normal, albedo;
};

HWY_INLINE GuideCentre guide_centre(const GuideRows& rows, int x) {
  return {hn::LoadU(kD, rows.depth + x), hn::LoadU(kD, rows.depth_rate + x),
          hn::LoadU(kD, rows.feature_rate + x), rows.normal.at(x), rows.albedo.at(x)};
}

/// Logarithm of a neighbour's weight; <= 0.
HWY_INLINE F log_weight(const GuideCentre& centre, const GuideRows& rows, int x, const Tap& tap) {
  const std::ptrdiff_t i = x + tap.offset;
  const F depth = hn::AbsDiff(centre.depth, hn::LoadU(kD, rows.depth + i));
  const F3 normal = sub(centre.normal, rows.normal.at(i)), albedo = sub(centre.albedo, rows.albedo.at(i));
  const F features =
      hn::MulAdd(normal.x, normal.x,
                 hn::MulAdd(normal.y, normal.y, hn::MulAdd(normal.z, normal.z, dot(albedo, albedo))));
  const F at_distance = hn::Mul(centre.depth_rate, hn::Set(kD, tap.inverse_distance));
  return hn::NegMulAdd(depth, at_distance,
                       hn::NegMulAdd(features, centre.feature_rate, hn::Set(kD, tap.log_kernel)));
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
