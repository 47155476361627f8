// Importance that is interpolated between voxels.
#include "visibility/importance_voxels.h"

#include <gtest/gtest.h>

#include "support/rule_volumes.h"
#include "visibility/importance_field.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::RuleVolumeSet;

constexpr test::Size3 kSize{17, 13, 11};

ImportanceRule values(float lower, float upper, float importance = 1) {
  ImportanceRule rule{};
  rule.importance = importance;
  rule.volume = 0;
  rule.lower[0] = lower;
  rule.upper[0] = upper;
  rule.box = {};
  return rule;
}

Volume noise() { return test::noise_volume<std::int16_t>(kSize, 0, 100, 3); }

float stored(const RuleVolumeSet& volumes, std::int64_t i, std::int64_t j, std::int64_t k) {
  const auto inside = [&](std::int64_t at, int a) {
    return std::clamp<std::int64_t>(at, 0, kSize[static_cast<std::size_t>(a)] - 1);
  };
  const float v = test::voxel_at<std::int16_t>(volumes.voxels(0), inside(i, 0), inside(j, 1), inside(k, 2));
  return v >= 40 ? v >= 80 ? 1.0f : 0.75f : 0.0f;
}

const std::vector<ImportanceRule> kTwo{values(40, 1000, 0.75f), values(80, 1000)};

TEST(ImportanceOfVoxels, IsTheRulesAtCentresAndLinearBetween) {
  const RuleVolumeSet volumes(noise());
  const ImportanceField field(kTwo, volumes.all(), ImportanceLookup::kPerVoxel);
  const ImportanceView view = field.view();
  for (int k = 0; k < kSize[2]; ++k)
    for (int j = 0; j < kSize[1]; ++j)
      for (int i = 0; i < kSize[0]; ++i)
        ASSERT_EQ(importance_at(view, {static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)}),
                  stored(volumes, i, j, k));
  Rng rng(4, 0, 0, 0);
  for (int n = 0; n < 2000; ++n) {
    const Vec3f p = test::random_point(volumes.voxels(0), rng);
    double expected = 0;
    for (int corner = 0; corner < 8; ++corner) {
      double weight = 1;
      std::int64_t at[3];
      for (int a = 0; a < 3; ++a) {
        const double low = std::floor(double{p[a]}), share = p[a] - low;
        weight *= corner >> a & 1 ? share : 1 - share;
        at[a] = static_cast<std::int64_t>(low) + (corner >> a & 1);
      }
      expected += weight * stored(volumes, at[0], at[1], at[2]);
    }
    EXPECT_NEAR(importance_at(view, p), expected, 1e-5);
  }
}

TEST(ImportanceOfVoxels, SmoothedIsTheMeanOf27) {
  const RuleVolumeSet volumes(noise());
  const ImportanceField field(kTwo, volumes.all(), ImportanceLookup::kSmoothed);
  for (int k = 0; k < kSize[2]; ++k)
    for (int j = 0; j < kSize[1]; ++j)
      for (int i = 0; i < kSize[0]; ++i) {
        double sum = 0;
        for (int dk = -1; dk <= 1; ++dk)
          for (int dj = -1; dj <= 1; ++dj)
            for (int di = -1; di <= 1; ++di) sum += stored(volumes, i + di, j + dj, k + dk);
        ASSERT_NEAR(importance_at(field.view(),
                                  {static_cast<float>(i), static_cast<float>(j), static_cast<float>(k)}),
                    sum / 27, kImportanceStep);
      }
}

/// Where everything around is of one importance, so is what is interpolated, exactly.
TEST(ImportanceOfVoxels, ConstantsStay) {
  const RuleVolumeSet volumes(noise());
  for (const float importance : {0.0f, 0.3f, 1.0f})
    for (const ImportanceLookup lookup : {ImportanceLookup::kPerVoxel, ImportanceLookup::kSmoothed}) {
      const ImportanceField field({values(-1, 1000, importance)}, volumes.all(), lookup);
      Rng rng(5, 0, 0, 0);
      for (int n = 0; n < 100; ++n) {
        const Vec3f p = test::random_point(volumes.voxels(0), rng);
        EXPECT_NEAR(importance_at(field.view(), p), importance, kImportanceStep);
        EXPECT_EQ(importance_at(field.view(), p), look_up_importance(field.view(), p));
        EXPECT_NE(field.view().cells.level_at(p), ImportanceCellsView::kMixed);
      }
    }
}

/// A shell between two values that no voxel has: found where values are interpolated first, lost where voxels
/// are looked at. One that only single voxels have: kept at full strength only if interpolated first, and
/// smeared over its neighbours by the mean (lerzer2025 fig. 11).
TEST(ImportanceOfVoxels, LosesOrSmearsThinShells) {
  const auto steep = [](auto i, auto, auto) { return i < 8 ? 0 : 100; };
  const RuleVolumeSet volumes(make_volume<std::int16_t>(kSize, steep));
  const auto at = [](float i) { return Vec3f(i, 6, 5); };
  const std::vector<ImportanceRule> between{values(40, 60)};
  const ImportanceField kept(between, volumes.all(), ImportanceLookup::kInterpolated);
  const ImportanceField lost(between, volumes.all(), ImportanceLookup::kPerVoxel);
  EXPECT_EQ(importance_at(kept.view(), at(7.5f)), 1);
  EXPECT_EQ(importance_at(kept.view(), at(7.3f)), 0);
  for (float i = 0; i < 16; i += 0.1f) EXPECT_EQ(importance_at(lost.view(), at(i)), 0);

  const auto sheet = [](auto i, auto, auto) { return i == 8 ? 100 : 0; };
  const RuleVolumeSet sheets(make_volume<std::int16_t>(kSize, sheet));
  const std::vector<ImportanceRule> high{values(50, 1000)};
  const ImportanceField sharp(high, sheets.all(), ImportanceLookup::kInterpolated);
  const ImportanceField voxels(high, sheets.all(), ImportanceLookup::kPerVoxel);
  const ImportanceField mean(high, sheets.all(), ImportanceLookup::kSmoothed);
  EXPECT_EQ(importance_at(sharp.view(), at(8.4f)), 1);
  EXPECT_EQ(importance_at(sharp.view(), at(8.6f)), 0);
  EXPECT_NEAR(importance_at(voxels.view(), at(8.4f)), 0.6f, 1e-5);
  EXPECT_NEAR(importance_at(voxels.view(), at(8.6f)), 0.4f, 1e-5);
  EXPECT_NEAR(importance_at(mean.view(), at(8)), 1.0f / 3, kImportanceStep);
  EXPECT_NEAR(importance_at(mean.view(), at(9)), 1.0f / 3, kImportanceStep);
  EXPECT_EQ(importance_at(mean.view(), at(10)), 0);
}

}  // namespace
}  // namespace voxlume
