// The peer scene (bench/scenes/peer.json) has known means on the lit forehead: an independent brute-force
// Monte Carlo gave 0.3512 +- 0.0005 with single scattering and 0.777 +- 0.001 with up to 100.
#include <gtest/gtest.h>

#include <filesystem>

#include "scene/open_volume.h"
#include "scene/scene_file.h"
#include "test_scene.h"

namespace voxlume::test {
namespace {

Moments forehead(int max_scatter, int spp) {
  const std::filesystem::path folder = VOXLUME_SOURCE_DIR;
  SceneDescription description = read_scene(folder / "bench/scenes/peer.json");
  description.render.max_scatter = max_scatter;
  const Volume volume = open_volume(description.volume);
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const CompiledScene scene(resolve(as_tested(description), volume, statistics), volume, statistics);
  std::vector<Moments> rows(130);
  parallel_for(130, 1, [&](std::int64_t row) {
    TraceCounters counters;
    for (const double l : row_luminances(scene.view(), 240, 370, static_cast<int>(130 + row), spp, counters))
      rows[row].add(l);
  });
  Moments total;
  for (const Moments& row : rows) total += row;
  return total;
}

class PeerScene : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(std::filesystem::path(VOXLUME_SOURCE_DIR) / "data/head-ct.nrrd"))
      GTEST_SKIP() << "no sample data; ./vx samples makes it";
  }
};

TEST_F(PeerScene, SingleScattering) {
  const Moments mean = forehead(1, 32);
  EXPECT_LT(mean.standard_error(), 0.001);
  EXPECT_NEAR(mean.mean(), 0.3512, 0.01 * 0.3512);
}

TEST_F(PeerScene, UpTo100Scatterings) {
  const Moments mean = forehead(100, 4);
  EXPECT_LT(mean.standard_error(), 0.004);
  EXPECT_NEAR(mean.mean(), 0.777, 0.01 * 0.777);
}

}  // namespace
}  // namespace voxlume::test
