#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/matter.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/matter.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

void compose_row(const Matter& matter, int y, DenoisedFrame& out) {
  for_row(out.alpha.width(), [&](int x, std::size_t lanes) {
    const F zero = hn::Zero(kD), alpha = load(out.alpha, x, y);
    const auto lacking = hn::And(hn::Eq(load(matter.samples, x, y), zero), hn::Gt(alpha, zero));
    F3 radiance = load(matter.radiance, x, y);
    if (!hn::AllFalse(kD, lacking)) {
      F weights = hn::Set(kD, 1e-20f);
      F3 sum = zero3();
      for (int dy = -2; dy <= 2; ++dy) {
        for (int dx = -2; dx <= 2; ++dx) {
          const F weight = load(matter.samples, x + dx, y + dy);
          weights = hn::Add(weights, weight);
          sum = add_scaled(sum, load(matter.radiance, x + dx, y + dy), weight);
        }
      }
      radiance = choose(lacking, scale(sum, hn::Div(hn::Set(kD, 1.0f), weights)), radiance);
    }
    store(scale(radiance, alpha), out.radiance, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "base/parallel.h"

namespace voxlume {

HWY_EXPORT(compose_row);

void Matter::resize(int width, int height) {
  if (samples.width() == width && samples.height() == height) return;
  radiance = make_planes3(width, height);
  samples = Plane(width, height);
}

void compose(const Matter& matter, DenoisedFrame& out) {
  parallel_for(out.alpha.height(), 8, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(compose_row)(matter, static_cast<int>(y), out);
  });
}

}  // namespace voxlume
#endif  // HWY_ONCE
