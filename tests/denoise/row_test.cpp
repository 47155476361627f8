#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/row_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <vector>

#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// values.size() is a multiple of any vector's length.
void exp_of_all(std::vector<float>& values) {
  for (std::size_t i = 0; i < values.size(); i += hn::Lanes(kD))
    hn::StoreU(exp_approx(hn::LoadU(kD, values.data() + i)), kD, values.data() + i);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <gtest/gtest.h>

#include <cmath>

#include "support/every_target.h"

namespace voxlume {
namespace {

using test::for_every_target;

HWY_EXPORT(exp_of_all);

TEST(ExpApprox, IsWithinItsBound) {
  for_every_target([] {
    std::vector<float> arguments(1 << 16);
    for (std::size_t i = 0; i < arguments.size(); ++i)
      arguments[i] = -87.0f * static_cast<float>(i) / static_cast<float>(arguments.size());
    std::vector<float> values = arguments;
    HWY_DYNAMIC_DISPATCH(exp_of_all)(values);
    double worst = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      worst = std::max(worst, std::abs(values[i] / std::exp(static_cast<double>(arguments[i])) - 1));
    EXPECT_LT(worst, 1.1e-4);
    EXPECT_EQ(values[0], 1);
  });
}

TEST(ExpApprox, StaysSmallAndPositiveFarBelow) {
  for_every_target([] {
    std::vector<float> values(16, -88);
    values[1] = -1e30f;
    values[2] = -std::numeric_limits<float>::infinity();
    HWY_DYNAMIC_DISPATCH(exp_of_all)(values);
    for (const float value : values) {
      EXPECT_GT(value, 0);
      EXPECT_LT(value, 1e-37f);
    }
  });
}

}  // namespace
}  // namespace voxlume
#endif  // HWY_ONCE
