#include "material/surface_share.h"

#include <gtest/gtest.h>

#include <cmath>

namespace voxlume {
namespace {

constexpr SurfaceShareForm kForms[] = {SurfaceShareForm::kHybrid, SurfaceShareForm::kExponential,
                                       SurfaceShareForm::kModulation, SurfaceShareForm::kThreshold};

TEST(SurfaceShare, IsZeroWithoutGradientAndNeverFalls) {
  for (SurfaceShareForm form : kForms)
    for (bool modulated : {false, true}) {
      EXPECT_EQ(surface_share(form, 0.5f, modulated, 1.0f, 0.0f), 0.0f);
      float last = 0.0f;
      for (float gradient = 0.0f; gradient < 3.0f; gradient += 0.01f) {
        const float share = surface_share(form, 0.5f, modulated, 0.8f, gradient);
        EXPECT_GE(share, last);
        EXPECT_LE(share, 1.0f);
        last = share;
      }
    }
}

TEST(SurfaceShare, HybridKnownValues) {
  // 25 * 0.5^3 = 3.125
  EXPECT_NEAR(surface_share(SurfaceShareForm::kHybrid, 0.5f, false, 0.2f, 1.0f), 1 - std::exp(-3.125f),
              1e-6f);
  EXPECT_NEAR(surface_share(SurfaceShareForm::kHybrid, 0.5f, true, 0.2f, 1.0f),
              0.2f * (1 - std::exp(-3.125f)), 1e-6f);
  EXPECT_EQ(surface_share(SurfaceShareForm::kHybrid, 0.5f, true, 0.0f, 1.0f), 0.0f);
  EXPECT_EQ(surface_share(SurfaceShareForm::kHybrid, 0.0f, false, 1.0f, 1.0f), 0.0f);
}

TEST(SurfaceShare, OtherKnownValues) {
  EXPECT_NEAR(surface_share(SurfaceShareForm::kExponential, 4.0f, true, 0.1f, 0.5f), 1 - std::exp(-2.0f),
              1e-6f);
  EXPECT_NEAR(surface_share(SurfaceShareForm::kModulation, 0.5f, true, 0.1f, 0.5f), 0.75f, 1e-6f);
  EXPECT_EQ(surface_share(SurfaceShareForm::kModulation, 0.5f, true, 0.1f, 2.0f), 1.0f);
  EXPECT_EQ(surface_share(SurfaceShareForm::kThreshold, 0.5f, true, 0.1f, 0.5f), 0.0f);
  EXPECT_EQ(surface_share(SurfaceShareForm::kThreshold, 0.5f, true, 0.1f, 0.51f), 1.0f);
}

TEST(SurfaceShare, ReachesOne) {
  EXPECT_EQ(surface_share(SurfaceShareForm::kHybrid, 3.0f, true, 1.0f, 1.0f), 1.0f);
  EXPECT_EQ(surface_share(SurfaceShareForm::kExponential, 100.0f, true, 1.0f, 1.0f), 1.0f);
}

}  // namespace
}  // namespace voxlume
