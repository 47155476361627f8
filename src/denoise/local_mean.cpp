#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/local_mean.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/local_mean.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// The pixels of a window of 2 radius + 1 around `at` that are inside [0, size).
HWY_INLINE int window_size(int at, int size, int radius) {
  return std::min(at + radius, size - 1) - std::max(at - radius, 0) + 1;
}

/// Sums along a row; the border adds zeros.
void sum_columns(const Plane& in, int y, Plane& out) {
  for_row(in.width(), [&](int x, std::size_t lanes) {
    F sum = load(in, x - LocalMean::kRadius, y);
    for (int dx = 1 - LocalMean::kRadius; dx <= LocalMean::kRadius; ++dx)
      sum = hn::Add(sum, load(in, x + dx, y));
    store(sum, out, x, y, lanes);
  });
}

void mean_of_rows(const Plane& row_sums, int y, Plane& out) {
  constexpr int kRadius = LocalMean::kRadius;
  const int width = out.width();
  const float rows = static_cast<float>(window_size(y, out.height(), kRadius));
  const F whole = hn::Set(kD, static_cast<float>(2 * kRadius + 1));
  for_row(width, [&](int x, std::size_t lanes) {
    F sum = load(row_sums, x, y - kRadius);
    for (int dy = 1 - kRadius; dy <= kRadius; ++dy) sum = hn::Add(sum, load(row_sums, x, y + dy));
    // Columns that are missing on the left and on the right.
    const F column = hn::Iota(kD, static_cast<float>(x)), zero = hn::Zero(kD);
    const F left = hn::Max(hn::Sub(hn::Set(kD, static_cast<float>(kRadius)), column), zero);
    const F right = hn::Max(hn::Sub(column, hn::Set(kD, static_cast<float>(width - 1 - kRadius))), zero);
    const F columns = hn::Max(hn::Sub(hn::Sub(whole, left), right), hn::Set(kD, 1.0f));
    store(hn::Div(sum, hn::Mul(columns, hn::Set(kD, rows))), out, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/parallel.h"

namespace voxlume {

HWY_EXPORT(sum_columns);
HWY_EXPORT(mean_of_rows);

void LocalMean::operator()(const Plane& in, Plane& out) {
  if (row_sums_.width() != in.width() || row_sums_.height() != in.height())
    row_sums_ = Plane(in.width(), in.height());
  parallel_for(in.height(), 16, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(sum_columns)(in, static_cast<int>(y), row_sums_);
  });
  parallel_for(in.height(), 16, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(mean_of_rows)(row_sums_, static_cast<int>(y), out);
  });
}

}  // namespace voxlume
#endif  // HWY_ONCE
