#include "grid/phantom.h"

#include <gtest/gtest.h>

#include <cstring>

#include "base/parallel.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

const Volume& phantom() {
  static const Volume volume = make_head_phantom();
  return volume;
}

TEST(Phantom, IsACtOfTheDocumentedSize) {
  const Volume& volume = phantom();
  EXPECT_EQ(volume.size, (test::Size3{192, 192, 192}));
  EXPECT_EQ(volume.type, VoxelType::kI16);
  EXPECT_EQ(volume.modality, "CT");
  for (int a = 0; a < 3; ++a) {
    EXPECT_EQ(volume.spacing_mm[a], 1.2);
    EXPECT_NEAR(volume.origin_mm[a] + 191 * 0.5 * 1.2, 0, 1e-9);  // centred
  }
}

TEST(Phantom, HoldsAirTissueAndBone) {
  const auto* v = static_cast<const std::int16_t*>(phantom().voxels.get());
  const std::size_t count = phantom().voxel_count();
  const auto share = [&](int lower, int upper) {
    return static_cast<double>(std::count_if(v, v + count, [&](int x) { return x >= lower && x <= upper; })) /
           static_cast<double>(count);
  };
  EXPECT_EQ(share(-1000, 2300), 1.0);
  EXPECT_EQ(*std::min_element(v, v + count), -1000);
  EXPECT_GT(*std::max_element(v, v + count), 1500);  // teeth
  EXPECT_GT(share(-1000, -990), 0.3);
  EXPECT_GT(share(-100, 100), 0.15);
  EXPECT_GT(share(400, 1200), 0.01);
  EXPECT_LT(share(400, 2300), 0.2);
}

TEST(Phantom, IsSurroundedByAir) {
  const Volume& volume = phantom();
  for (std::int64_t a = 0; a < 192; ++a)
    for (std::int64_t b = 0; b < 192; ++b) {
      for (const std::int64_t side : {std::int64_t{0}, std::int64_t{191}}) {
        EXPECT_EQ(test::voxel_at<std::int16_t>(volume, side, a, b), -1000.0f);
        EXPECT_EQ(test::voxel_at<std::int16_t>(volume, a, side, b), -1000.0f);
      }
      EXPECT_EQ(test::voxel_at<std::int16_t>(volume, a, b, 191), -1000.0f);
    }
}

TEST(Phantom, LeftMirrorsRight) {
  const Volume& volume = phantom();
  std::size_t different = 0;
  for (std::int64_t k = 0; k < 192; ++k)
    for (std::int64_t j = 0; j < 192; ++j)
      for (std::int64_t i = 0; i < 96; ++i)
        different += std::abs(test::voxel_at<std::int16_t>(volume, i, j, k) -
                              test::voxel_at<std::int16_t>(volume, 191 - i, j, k)) > 1;
  EXPECT_EQ(different, 0u);
}

TEST(Phantom, IsTheSameEveryTime) {
  const ThreadLimit limit(3);
  const Volume again = make_head_phantom();
  EXPECT_EQ(0, std::memcmp(again.voxels.get(), phantom().voxels.get(), again.byte_count()));
}

}  // namespace
}  // namespace voxlume
