#include "grid/label_surface.h"

#include <gtest/gtest.h>

#include "grid/sample.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::noise_volume;
using test::Placement;
using test::Size3;

constexpr double kDegrees = 57.29577951308232;

/// Of the nearest voxel's label.
Vec3f normal_at(const GridView& labels, Vec3f p_index) {
  return label_normal(labels, p_index, sample_nearest(labels, p_index));
}

Vec3d random_unit(Rng& rng) {
  for (;;) {
    const Vec3d v(2 * rng.next() - 1, 2 * rng.next() - 1, 2 * rng.next() - 1);
    if (length(v) > 0.1 && length(v) <= 1) return normalize(v);
  }
}

/// Labels 2 where depth(LPS point) > 0, else 1.
template <class T, class Depth>
Volume solid(Size3 size, const Placement& place, Depth&& depth) {
  const Affined world = world_from_index(make_volume<T>(
      {1, 1, 1}, [](auto, auto, auto) { return 0; }, place));
  return make_volume<T>(
      size, [&](auto i, auto j, auto k) { return depth(world.point(Vec3d(i, j, k))) > 0 ? 2 : 1; }, place);
}

struct Errors {
  double sum = 0, most = 0, shortest = 2, longest = 0;
  int count = 0;

  double mean() const { return sum / count; }
  void add(const GridView& labels, Vec3d p_world, Vec3d outward) {
    const Vec3f p = labels.index_from_world.point(Vec3f(p_world));
    const Vec3d normal = Vec3d(normal_at(labels, p)) * (sample_nearest(labels, p) == 2 ? 1.0 : -1.0);
    const double size = length(normal);
    shortest = std::min(shortest, size);
    longest = std::max(longest, size);
    const double angle =
        size > 0 ? std::acos(std::clamp(dot(normal, outward) / size, -1.0, 1.0)) * kDegrees : 180.0;
    sum += angle;
    most = std::max(most, angle);
    ++count;
  }
};

/// Points on planes of many directions through the middle of volumes placed at `place`.
template <class T>
Errors errors_of_planes(const Placement& place, double* face_error) {
  Errors errors;
  Rng rng(3, 0, 0, 0);
  const Size3 size{27, 27, 27};
  const Affined world = world_from_index(make_volume<T>(
      {1, 1, 1}, [](auto, auto, auto) { return 0; }, place));
  const double reach_mm = 4 * std::min({place.spacing_mm[0], place.spacing_mm[1], place.spacing_mm[2]});
  *face_error = 0;
  for (int n = 0; n < 40; ++n) {
    const Vec3d outward = random_unit(rng);
    const Vec3d center = world.point(Vec3d(13 + rng.next(), 12 + rng.next(), 13 - rng.next()));
    const Volume volume = solid<T>(size, place, [&](Vec3d p) { return -dot(outward, p - center); });
    const GridView labels = make_grid_view(volume);
    for (int m = 0; m < 250; ++m) {
      const Vec3d to = random_unit(rng) * (reach_mm * rng.next());
      errors.add(labels, center + to - outward * dot(outward, to), outward);
    }
    // The voxel face that turns away least.
    double least = 180;
    for (const Vec3d& axis : {world.column_x, world.column_y, world.column_z})
      least = std::min(least, std::acos(std::min(1.0, std::abs(dot(normalize(axis), outward)))) * kDegrees);
    *face_error += least / 40;
  }
  return errors;
}

TEST(LabelNormal, OfAPlaneIsItsNormal) {
  double face_error = 0;
  const Errors errors = errors_of_planes<std::uint8_t>({}, &face_error);
  EXPECT_LT(errors.mean(), 3);
  EXPECT_LT(errors.most, 12);
  EXPECT_GT(face_error, 20);
  EXPECT_GT(errors.shortest, 0.97);
  EXPECT_LE(errors.longest, 1 + 1e-6);
}

TEST(LabelNormal, OfAPlaneInVoxelsOfAnyShape) {
  for (const Placement& place : test::placements()) {
    double face_error = 0;
    const Errors errors = errors_of_planes<std::int32_t>(place, &face_error);
    EXPECT_LT(errors.mean(), 5);
    EXPECT_GT(face_error, 20);
    EXPECT_GT(errors.shortest, 0.95);
    EXPECT_LE(errors.longest, 1 + 1e-6);
  }
}

TEST(LabelNormal, OfABallPointsAway) {
  Placement stretched;
  stretched.spacing_mm = {1, 1, 1.6};
  for (const Placement& place : {Placement{}, stretched}) {
    const Vec3d center(15.3, 14.9, 15.2);
    const double radius_mm = 9;
    const Volume volume =
        solid<float>({31, 31, 31}, place, [&](Vec3d p) { return radius_mm - length(p - center); });
    const GridView labels = make_grid_view(volume);
    Errors errors;
    Rng rng(8, 0, 0, 0);
    for (int n = 0; n < 10000; ++n) {
      const Vec3d outward = random_unit(rng);
      errors.add(labels, center + outward * radius_mm, outward);
    }
    EXPECT_LT(errors.mean(), 3);
    EXPECT_LT(errors.most, 12);
    EXPECT_GT(errors.shortest, 0.9);
    EXPECT_LE(errors.longest, 1 + 1e-6);
  }
}

TEST(LabelNormal, IsZeroWithinALabel) {
  const Volume volume = solid<std::uint16_t>({20, 8, 8}, {}, [](Vec3d p) { return 9.5 - p.x; });
  const GridView labels = make_grid_view(volume);
  Rng rng(1, 0, 0, 0);
  for (int n = 0; n < 1000; ++n) {
    const float y = 8 * rng.next() - 0.5f, z = 8 * rng.next() - 0.5f;
    ASSERT_EQ(normal_at(labels, {6.4f * rng.next() - 0.5f, y, z}), Vec3f(0));
    // All others, as far as the kernel sees: their sum is nothing but rounding.
    ASSERT_EQ(normal_at(labels, {19 - 5 * rng.next(), y, z}), Vec3f(0));
  }
  float last = 0;
  for (float x = 6; x < 9.4f; x += 0.1f) {
    const Vec3f normal = normal_at(labels, {x, 3.7f, 4.1f});
    EXPECT_GE(normal.x, last);
    EXPECT_NEAR(normal.y, 0, 1e-5);
    last = normal.x;
  }
  EXPECT_GT(last, 0.97f);
}

TEST(LabelNormal, IsContinuousButForTheLabel) {
  const Volume volume = make_volume<std::int16_t>(
      {12, 12, 12}, [rng = Rng(2, 0, 0, 0)](auto, auto, auto) mutable { return std::floor(rng.next() * 3); });
  const GridView labels = make_grid_view(volume);
  Rng rng(4, 0, 0, 0);
  int compared = 0;
  for (int line = 0; line < 50; ++line) {
    const Vec3d begin(test::random_point(volume, rng)), end(test::random_point(volume, rng));
    constexpr int kSteps = 2000;
    Vec3f last;
    float last_label = -1;
    for (int n = 0; n <= kSteps; ++n) {
      const Vec3f p(begin + (end - begin) * (static_cast<double>(n) / kSteps));
      const Vec3f normal = normal_at(labels, p);
      const float label = sample_nearest(labels, p);
      if (label == last_label) {
        ++compared;
        // Steps are 0.01 voxels at most; the direction of a short vector turns fast, the vector does not.
        ASSERT_LT(length(normal - last), 0.03);
      }
      last = normal;
      last_label = label;
    }
  }
  EXPECT_GT(compared, 50000);
}

TEST(LabelNormal, BeyondTheVolumeTheBorderGoesOn) {
  const Volume volume = make_volume<std::uint8_t>({6, 1, 2}, [](auto i, auto, auto) { return i > 2; });
  const GridView labels = make_grid_view(volume);
  for (const float y : {-0.5f, 0.0f, 0.5f}) {
    const Vec3f normal = normal_at(labels, {2.4f, y, 0.7f});
    EXPECT_GT(normal.x, 0.95f);
    EXPECT_NEAR(normal.y, 0, 1e-5);
    EXPECT_NEAR(normal.z, 0, 1e-5);
  }
  EXPECT_EQ(normal_at(labels, {-40, 0, 0}), normal_at(labels, {-0.5f, 0, 0}));
  const Volume one = noise_volume<double>({1, 1, 1}, 4);
  EXPECT_EQ(normal_at(make_grid_view(one), {0.2f, 0, 0}), Vec3f(0));
}

TEST(LabelNormal, NaNHasNoSurface) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const Volume volume = make_volume<float>({9, 9, 9}, [&](auto i, auto, auto) { return i < 4 ? nan : 3.0f; });
  const GridView labels = make_grid_view(volume);
  EXPECT_EQ(normal_at(labels, {3.2f, 4, 4}), Vec3f(0));
  EXPECT_LT(normal_at(labels, {3.6f, 4, 4}).x, -0.95f);
}

}  // namespace
}  // namespace voxlume
