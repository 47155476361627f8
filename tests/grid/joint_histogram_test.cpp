#include "grid/joint_histogram.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::Placement;

std::uint64_t sum(const JointHistogram& histogram) {
  return std::accumulate(histogram.counts.begin(), histogram.counts.end(), std::uint64_t{0});
}
std::uint32_t count(const JointHistogram& histogram, int column, int row) {
  return histogram.counts[static_cast<std::size_t>(row) * histogram.x.bins + column];
}

TEST(JointHistogram, CountsEveryVoxelWhereItsTwoValuesAre) {
  const Volume a = make_volume<std::int16_t>({8, 6, 4}, [](auto i, auto, auto) { return 100 * i; });
  const Volume b = make_volume<float>({8, 6, 4}, [](auto, auto j, auto) { return 0.5 * j; });
  const JointHistogram histogram = joint_histogram(a, {a, false, 0, 700}, {b, false, 0, 2.5});
  EXPECT_EQ(sum(histogram), 8u * 6 * 4);
  EXPECT_EQ(histogram.x.lower, 0);
  EXPECT_EQ(histogram.x.upper, 700);
  ASSERT_EQ(histogram.counts.size(), static_cast<std::size_t>(histogram.x.bins) * histogram.y.bins);
  const auto bin = [](double share, int bins) { return std::min(static_cast<int>(share * bins), bins - 1); };
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 6; ++j)
      EXPECT_EQ(count(histogram, bin(i / 7.0, histogram.x.bins), bin(j / 5.0, histogram.y.bins)), 4u);
}

TEST(JointHistogram, LabelsHaveABinEach) {
  const Volume data = make_volume<std::uint8_t>({9, 4, 4}, [](auto i, auto, auto) { return 10 * i; });
  const Volume labels =
      make_volume<std::uint8_t>({9, 4, 4}, [](auto i, auto, auto) { return i < 3 ? 2 : 5; });
  const JointHistogram histogram = joint_histogram(data, {data, false, 0, 80}, {labels, true, 2, 5});
  ASSERT_EQ(histogram.y.bins, 4);
  EXPECT_EQ(histogram.y.lower, 1.5);
  EXPECT_EQ(histogram.y.upper, 5.5);
  std::uint64_t rows[4] = {};
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < histogram.x.bins; ++column) rows[row] += count(histogram, column, row);
  EXPECT_EQ(rows[0], 3u * 16);
  EXPECT_EQ(rows[1] + rows[2], 0u);
  EXPECT_EQ(rows[3], 6u * 16);
}

TEST(JointHistogram, LeavesOutWhatIsOutsideOrNotFinite) {
  const Volume whole =
      make_volume<float>({10, 4, 4}, [](auto i, auto j, auto) { return j == 0 && i == 9 ? NAN : i; });
  // Covers the upper half of x alone, on a grid twice as fine.
  const Volume half = make_volume<std::uint8_t>(
      {10, 8, 8}, [](auto, auto, auto) { return 7; },
      Placement{.spacing_mm = {0.5, 0.5, 0.5}, .origin_mm = {4.75, -0.25, -0.25}});
  const JointHistogram histogram = joint_histogram(whole, {whole, false, 0, 9}, {half, false, 7, 7});
  EXPECT_EQ(histogram.y.bins, 1);
  // The field is not finite at the voxels beside either, which interpolation comes upon.
  EXPECT_EQ(sum(histogram), 5u * 16 - 2 * 4);
}

TEST(JointHistogram, OfTurnedVolumesIsThatOfTheirPlaces) {
  for (const Placement& placement : test::placements()) {
    const Volume a = make_volume<std::int16_t>(
        {7, 6, 5}, [](auto i, auto, auto) { return i; }, placement);
    const Volume b = make_volume<std::int16_t>(
        {7, 6, 5}, [](auto i, auto, auto) { return 6 - i; }, placement);
    const JointHistogram histogram = joint_histogram(a, {a, true, 0, 6}, {b, true, 0, 6});
    for (int i = 0; i < 7; ++i)
      for (int j = 0; j < 7; ++j) EXPECT_EQ(count(histogram, i, j), i + j == 6 ? 30u : 0u) << i << " " << j;
  }
}

TEST(JointHistogram, OfLargeVolumesIsASample) {
  const Volume volume = test::noise_volume<std::uint8_t>({64, 32, 1}, 3);
  const JointHistogram all = joint_histogram(volume, {volume, false, 0, 255}, {volume, false, 0, 255});
  EXPECT_EQ(sum(all), 64u * 32);
  const JointHistogram some = joint_histogram(volume, {volume, false, 0, 255}, {volume, false, 0, 255}, 600);
  EXPECT_EQ(sum(some), 32u * 16);
  for (int x = 0; x < all.x.bins; ++x)
    for (int y = 0; y < all.y.bins; ++y) {
      EXPECT_LE(count(some, x, y), count(all, x, y));
      if (x != y) {
        EXPECT_EQ(count(all, x, y), 0u);
      }
    }
}

}  // namespace
}  // namespace voxlume
