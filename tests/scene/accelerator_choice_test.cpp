#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/phantom.h"
#include "scene/compile.h"
#include "scene/resolve.h"
#include "scene/tracking_choice.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

AcceleratorChoice choice(const std::string& accelerator, const std::string& rule = "cost") {
  RenderDescription render;
  render.accelerator = accelerator;
  render.hierarchy_rule = rule;
  render.macrocell_voxels = 3;
  render.lookup_cost = 7;
  render.hierarchy_thresholds = {0.25, 2};
  GridView grid;
  grid.size[0] = 10;
  grid.size[1] = 40;
  grid.size[2] = 20;
  SceneDescription scene;
  scene.render = render;
  return accelerator_choice(scene, grid);
}

TEST(AcceleratorChoice, FollowsTheScene) {
  using Kind = AcceleratorKind;
  EXPECT_EQ(choice("auto").kind, Kind::kHierarchy);
  EXPECT_EQ(choice("hierarchy").kind, Kind::kHierarchy);
  EXPECT_EQ(choice("hierarchy", "thresholds").kind, Kind::kThresholdOctree);
  EXPECT_EQ(choice("macrocell").kind, Kind::kMacrocell);
  EXPECT_EQ(choice("octree").kind, Kind::kSkippingOctree);
  EXPECT_EQ(choice("residency").kind, Kind::kResidency);
  EXPECT_EQ(choice("none").kind, Kind::kMacrocell);
  EXPECT_EQ(choice("none").cell_voxels, 40);
  const AcceleratorChoice hierarchy = choice("auto");
  EXPECT_EQ(hierarchy.cell_voxels, 3);
  EXPECT_EQ(hierarchy.costs.lookup, 7.0f);
  EXPECT_EQ(hierarchy.thresholds.climb, 0.25f);
  EXPECT_EQ(hierarchy.thresholds.descend, 2.0f);
}

TEST(AcceleratorChoice, RefusesWordsItDoesNotKnow) {
  EXPECT_THROW(choice("bvh"), Error);
  EXPECT_THROW(choice("hierarchy", "luck"), Error);
}

TEST(AcceleratorChoice, IsWhatTheKernelsGet) {
  const Volume phantom = make_head_phantom();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(phantom));
  for (const char* rule : {"cost", "thresholds"}) {
    SceneDescription scene = resolve({}, phantom, statistics);
    scene.render.hierarchy_rule = rule;
    const CompiledScene compiled(scene, phantom, statistics);
    EXPECT_EQ(compiled.view().medium.accelerator.kind, choice("auto", rule).kind);
  }
}

}  // namespace
}  // namespace voxlume
