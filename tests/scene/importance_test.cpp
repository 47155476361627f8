#include <gtest/gtest.h>

#include "scene/compile.h"
#include "scene/resolve.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

ImportanceDescription values(double lower, double importance) {
  ImportanceDescription out;
  out.range = {lower, 1000};
  out.importance = importance;
  return out;
}

TEST(Importance, TheSameValuesTwiceAreOneRuleOfTheGreaterImportance) {
  const Volume volume = test::noise_volume<std::int16_t>({8, 7, 6}, -1000, 1000, 1);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  SceneDescription scene;
  scene.image.width = scene.image.height = 8;
  scene.visibility.emplace();
  scene.visibility->important = {values(300, 0.25), values(500, 0.5), values(300, 0.75), values(300, 0.5)};
  const CompiledScene compiled(resolve(scene, volume, statistics), volume, statistics);
  const ImportanceView& view = compiled.view().visibility.importance;
  ASSERT_EQ(view.rule_count, 2);
  EXPECT_EQ(view.rules[0].lower[0], 300);
  EXPECT_EQ(view.rules[0].importance, 0.75f);
  EXPECT_EQ(view.rules[1].importance, 0.5f);
}

}  // namespace
}  // namespace voxlume
