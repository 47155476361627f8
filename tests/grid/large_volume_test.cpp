#include <gtest/gtest.h>
#include <sys/mman.h>

#include <cstring>

#include "grid/sample.h"
#include "grid/value_range.h"
#include "grid/volume_statistics.h"
#include "support/volumes.h"
#include "volume_io/child_limits.h"

namespace voxlume {
namespace {

/// A volume of zeros that takes memory only where it is written to; reading finds the system's page of zeros.
template <class T>
class SparseVolume {
 public:
  explicit SparseVolume(test::Size3 size) {
    volume_.size = size;
    volume_.type = test::voxel_type_of<T>();
    const std::size_t bytes = volume_.byte_count();
    void* start =
        mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (start == MAP_FAILED) return;
    volume_.voxels = {start, [bytes](const void* p) { munmap(const_cast<void*>(p), bytes); }};
    voxels_ = static_cast<T*>(start);
  }
  explicit operator bool() const { return voxels_ != nullptr; }
  void set(std::int64_t i, std::int64_t j, std::int64_t k, T value) {
    voxels_[(k * volume_.size[1] + j) * volume_.size[0] + i] = value;
  }
  GridView view() const { return make_grid_view(volume_); }
  std::size_t voxel_count() const { return volume_.voxel_count(); }

 private:
  Volume volume_;
  T* voxels_ = nullptr;
};

ValueRange range_of_cell(const ValueRangeGrid& grid, std::int64_t i, std::int64_t j, std::int64_t k) {
  return grid.ranges[static_cast<std::size_t>((k * grid.cells[1] + j) * grid.cells[0] + i)];
}

TEST(LargeVolume, LookUpsReachBeyondTwoToThe32Voxels) {
  SparseVolume<std::uint8_t> volume({1700, 1700, 1700});
  ASSERT_TRUE(volume);
  ASSERT_GT(volume.voxel_count(), 1ull << 32);
  volume.set(1699, 1699, 1699, 200);
  volume.set(1000, 3, 1600, 100);  // 4.6e9 voxels in
  volume.set(1000, 3, 800, 50);    // 2.3e9
  const GridView grid = volume.view();
  EXPECT_EQ(sample_trilinear(grid, {1699, 1699, 1699}), 200.0f);
  EXPECT_EQ(sample_trilinear(grid, {1699.5f, 1699.5f, 1699.5f}), 200.0f);
  EXPECT_EQ(sample_trilinear(grid, {1698.5f, 1699, 1699}), 100.0f);
  EXPECT_EQ(sample_nearest(grid, {1000.25f, 3, 1600}), 100.0f);
  EXPECT_EQ(sample_trilinear(grid, {1000, 3, 1600.5f}), 50.0f);
  EXPECT_EQ(sample_trilinear(grid, {1000, 3, 800}), 50.0f);
  EXPECT_EQ(sample_gradient(grid, {1000, 3, 1599}).z, 50.0f);
  EXPECT_EQ(sample_nearest(grid, {999, 3, 1600}), 0.0f);
}

TEST(LargeVolume, StatisticsAndRangesCountBeyondTwoToThe31Voxels) {
  if (has_sanitizer()) GTEST_SKIP() << "takes minutes under a sanitizer";
  SparseVolume<std::uint8_t> volume({1300, 1300, 1300});
  ASSERT_TRUE(volume);
  ASSERT_GT(volume.voxel_count(), 1ull << 31);
  volume.set(1299, 1299, 1299, 200);
  volume.set(600, 640, 1280, 100);  // 2.16e9 voxels in
  volume.set(0, 0, 640, 50);
  const VolumeStatistics statistics = compute_statistics(volume.view());
  const std::vector<std::pair<float, std::uint64_t>> expected = {
      {0, volume.voxel_count() - 3}, {50, 1}, {100, 1}, {200, 1}};
  EXPECT_EQ(statistics.histogram, expected);
  EXPECT_EQ(statistics.upper, 200.0f);
  // The steepest of the few gradients: half of the last voxel towards each side, of which there is one only.
  EXPECT_NEAR(statistics.gradient_p999 / (100 * std::sqrt(3.0f)), 1, 1.0 / 256 + 1e-5);

  const ValueRangeGrid ranges = build_value_ranges(volume.view(), 8);
  std::size_t filled = 0;
  for (const ValueRange& range : ranges.ranges) filled += range.upper > 0;
  EXPECT_EQ(filled, 1u + 8u + 2u);
  EXPECT_GE(range_of_cell(ranges, 162, 162, 162).upper, 200.0f);
  EXPECT_GE(range_of_cell(ranges, 75, 80, 160).upper, 100.0f);
  EXPECT_GE(range_of_cell(ranges, 74, 79, 159).upper, 100.0f);
  EXPECT_GE(range_of_cell(ranges, 0, 0, 79).upper, 50.0f);
}

TEST(LargeVolume, StatisticsAndRangesReachBeyondTwoToThe32Bytes) {
  if (has_sanitizer()) GTEST_SKIP() << "takes minutes under a sanitizer";
  SparseVolume<double> volume({1024, 1024, 520});
  ASSERT_TRUE(volume);
  volume.set(1023, 1023, 519, -2.5);
  volume.set(512, 512, 515, 7.5);  // byte 4.3e9
  const VolumeStatistics statistics = compute_statistics(volume.view());
  EXPECT_EQ(statistics.lower, -2.5f);
  EXPECT_EQ(statistics.upper, 7.5f);
  std::uint64_t total = 0;
  for (const auto& bin : statistics.histogram) total += bin.second;
  EXPECT_EQ(total, volume.voxel_count());
  const ValueRangeGrid ranges = build_value_ranges(volume.view(), 8);
  EXPECT_LE(range_of_cell(ranges, 127, 127, 64).lower, -2.5f);
  EXPECT_GE(range_of_cell(ranges, 64, 64, 64).upper, 7.5f);
}

}  // namespace
}  // namespace voxlume
