#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/opacities_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sampling/vector_math-inl.h"
#include "transfer/opacities.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void opacities(const float* mu_t, int count, float length_mm, float* opacity) {
  const hn::ScalableTag<float> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto length = hn::Set(d, length_mm);
  int n = 0;
  for (; n + lanes <= count; n += lanes)
    hn::StoreU(vector_one_minus_exp(hn::Mul(hn::LoadU(d, mu_t + n), length)), d, opacity + n);
  for (; n < count; ++n) opacity[n] = one_minus_exp(mu_t[n] * length_mm);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(opacities);

void simd::find_opacities(const float* mu_t, int count, float length_mm, float* opacity) noexcept {
  HWY_DYNAMIC_DISPATCH(opacities)(mu_t, count, length_mm, opacity);
}

}  // namespace voxlume
#endif
