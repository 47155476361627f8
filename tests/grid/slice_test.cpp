#include "grid/slice.h"

#include <gtest/gtest.h>

#include <cmath>

#include "grid/grid_view.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::Placement;

double value_of(const Slice& slice, int x, int y) {
  return slice.offset + slice.scale * (slice.samples[static_cast<std::size_t>(y) * slice.width + x] - 1);
}

/// The LPS point of a sample.
Vec3d place_of(const Slice& slice, const SliceRequest& request, int x, int y) {
  const double column = slice.origin_mm[0] + x * slice.spacing_mm,
               row = slice.origin_mm[1] + y * slice.spacing_mm;
  if (request.axis == 0) return {request.place_mm, column, row};
  if (request.axis == 1) return {column, request.place_mm, row};
  return {column, row, request.place_mm};
}

/// Columns of a rotation about all three axes.
std::array<double, 9> turned() {
  const double a = 0.4, b = -0.7, c = 1.1;
  const double ca = std::cos(a), sa = std::sin(a), cb = std::cos(b), sb = std::sin(b), cc = std::cos(c),
               sc = std::sin(c);
  return {ca * cb,
          ca * sb * sc - sa * cc,
          ca * sb * cc + sa * sc,
          sa * cb,
          sa * sb * sc + ca * cc,
          sa * sb * cc - ca * sc,
          -sb,
          cb * sc,
          cb * cc};
}

TEST(Slice, OfAVolumeAlongTheAxesShowsItsVoxels) {
  const Volume volume = make_volume<std::int16_t>(
      {5, 4, 3}, [](auto i, auto j, auto k) { return i + 10 * j + 100 * k; },
      Placement{.spacing_mm = {1, 1, 1}, .origin_mm = {10, 20, 30}});
  const SliceRequest z{.axis = 2, .place_mm = 31, .lower = 0, .upper = 234};
  const Slice slice = resample_slice(volume, z);
  ASSERT_EQ(slice.width, 5);
  ASSERT_EQ(slice.height, 4);
  EXPECT_DOUBLE_EQ(slice.origin_mm[0], 10);
  EXPECT_DOUBLE_EQ(slice.origin_mm[1], 20);
  EXPECT_DOUBLE_EQ(slice.spacing_mm, 1);
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 5; ++x) EXPECT_NEAR(value_of(slice, x, y), x + 10 * y + 100, 0.01);

  const Slice across_x = resample_slice(volume, {.axis = 0, .place_mm = 12, .lower = 0, .upper = 234});
  ASSERT_EQ(across_x.width, 4);   // +y
  ASSERT_EQ(across_x.height, 3);  // +z
  EXPECT_NEAR(value_of(across_x, 3, 2), 2 + 30 + 200, 0.01);
  const Slice across_y = resample_slice(volume, {.axis = 1, .place_mm = 21, .lower = 0, .upper = 234});
  ASSERT_EQ(across_y.width, 5);   // +x
  ASSERT_EQ(across_y.height, 3);  // +z
  EXPECT_NEAR(value_of(across_y, 4, 1), 4 + 10 + 100, 0.01);
}

TEST(Slice, OfATurnedVolumeShowsTheFieldAtItsPlaces) {
  const auto field = [](Vec3d p) { return 3 * p.x - 2 * p.y + p.z; };  // trilinear look-up is exact
  Placement placement{.spacing_mm = {1, 1.5, 2}, .origin_mm = {-7, 5, 100}, .direction = turned()};
  Volume volume = make_volume<float>(
      {12, 10, 8}, [](auto, auto, auto) { return 0; }, placement);
  const Affined world = world_from_index(volume);
  volume = make_volume<float>(
      {12, 10, 8},
      [&](auto i, auto j, auto k) { return field(world.point(Vec3d(double(i), double(j), double(k)))); },
      placement);
  const Vec3d middle = world.point({5.5, 4.5, 3.5});
  for (int axis = 0; axis < 3; ++axis) {
    const SliceRequest request{.axis = axis, .place_mm = middle[axis], .lower = -1000, .upper = 1000};
    const Slice slice = resample_slice(volume, request);
    int seen = 0;
    for (int y = 0; y < slice.height; ++y) {
      for (int x = 0; x < slice.width; ++x) {
        const Vec3d p = place_of(slice, request, x, y);
        const Vec3d p_index = world.inverse().point(p);
        bool centred = true, outside = false;  // between the outermost voxel centres; outside the domain
        for (int a = 0; a < 3; ++a) {
          centred = centred && p_index[a] > 0 && p_index[a] < volume.size[a] - 1;
          outside = outside || p_index[a] < -0.501 || p_index[a] > volume.size[a] - 0.499;
        }
        const bool is_set = slice.samples[static_cast<std::size_t>(y) * slice.width + x] > 0;
        EXPECT_FALSE(outside && is_set);
        if (!centred) continue;
        ++seen;
        ASSERT_TRUE(is_set);
        EXPECT_NEAR(value_of(slice, x, y), field(p), 0.02);
      }
    }
    EXPECT_GT(seen, 20);
  }
}

TEST(Slice, OfLabelsIsExact) {
  const Volume volume =
      make_volume<std::uint16_t>({6, 6, 6}, [](auto i, auto j, auto) { return (i * 7 + j * 131) % 500; });
  const Slice slice =
      resample_slice(volume, {.axis = 2, .place_mm = 3.4, .nearest = true, .lower = 0, .upper = 499});
  EXPECT_EQ(slice.scale, 1);
  for (int y = 0; y < 6; ++y)
    for (int x = 0; x < 6; ++x) EXPECT_EQ(value_of(slice, x, y), (x * 7 + y * 131) % 500);
}

TEST(Slice, OutsideIsEmptyAndSoIsWhatIsNotFinite) {
  const Volume volume = make_volume<float>({4, 4, 4}, [](auto i, auto, auto) { return i == 0 ? NAN : 1.0; });
  const Slice beside = resample_slice(volume, {.axis = 2, .place_mm = 50, .lower = 1, .upper = 1});
  for (const auto u : beside.samples) EXPECT_EQ(u, 0);
  const Slice through = resample_slice(volume, {.axis = 2, .place_mm = 1, .lower = 1, .upper = 1});
  EXPECT_EQ(through.samples[0], 0);
  EXPECT_EQ(value_of(through, 3, 0), 1);
}

TEST(Slice, OfLargeVolumesIsCoarser) {
  const Volume volume = make_volume<std::uint8_t>({300, 20, 2}, [](auto, auto, auto) { return 5; });
  const Slice slice =
      resample_slice(volume, {.axis = 2, .place_mm = 0, .lower = 5, .upper = 5, .most_samples = 100});
  EXPECT_EQ(slice.width, 100);
  EXPECT_EQ(slice.height, 7);
  EXPECT_DOUBLE_EQ(slice.spacing_mm, 3);
  EXPECT_EQ(value_of(slice, 50, 3), 5);
}

}  // namespace
}  // namespace voxlume
