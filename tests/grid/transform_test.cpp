#include <gtest/gtest.h>

#include "grid/grid_view.h"
#include "support/volumes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::Placement;
using test::placements;

Volume placed(const Placement& placement) {
  return make_volume<std::uint8_t>(
      {3, 5, 7}, [](auto, auto, auto) { return 1; }, placement);
}

/// origin + direction * (spacing * index), from the matrix as it stands in the header of a file.
Vec3d world_of(const Volume& v, Vec3d p_index) {
  Vec3d out;
  for (int row = 0; row < 3; ++row) {
    out[row] = v.origin_mm[row];
    for (int a = 0; a < 3; ++a) out[row] += v.direction[3 * row + a] * v.spacing_mm[a] * p_index[a];
  }
  return out;
}

void expect_near(Vec3d a, Vec3d b, double tolerance) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b[axis], tolerance) << "axis " << axis;
}

TEST(Transform, WorldFollowsTheHeader) {
  for (const Placement& placement : placements()) {
    const Volume volume = placed(placement);
    const GridView grid = make_grid_view(volume);
    const Affined world = world_from_index(volume);
    Rng rng(1, 0, 0, 0);
    for (int n = 0; n < 1000; ++n) {
      const Vec3f p = test::random_point(volume, rng);
      const Vec3d expected = world_of(volume, Vec3d(p));
      expect_near(world.point(Vec3d(p)), expected, 1e-11);
      // Coordinates of up to 500 mm in floats.
      expect_near(Vec3d(grid.world_from_index.point(p)), expected, 500 * 4 * 1.2e-7);
      expect_near(Vec3d(grid.index_from_world.point(Vec3f(expected))), Vec3d(p), 1250 * 4 * 1.2e-7);
    }
  }
}

TEST(Transform, FirstVoxelLiesAtTheOrigin) {
  for (const Placement& placement : placements()) {
    const Volume volume = placed(placement);
    const Vec3f first = make_grid_view(volume).world_from_index.point(Vec3f(0));
    for (int a = 0; a < 3; ++a) EXPECT_EQ(first[a], static_cast<float>(placement.origin_mm[a]));
  }
}

TEST(Transform, SizesStridesAndSteps) {
  const Volume volume = placed({{1.5, 0.5, 2.0}, {}, {1, 0, 0, 0, 1, 0, 0, 0, 1}});
  const GridView grid = make_grid_view(volume);
  EXPECT_EQ(grid.size[0], 3);
  EXPECT_EQ(grid.size[1], 5);
  EXPECT_EQ(grid.size[2], 7);
  EXPECT_EQ(grid.stride_j, 3);
  EXPECT_EQ(grid.stride_k, 15);
  EXPECT_EQ(grid.step_mm, 0.5f);
  EXPECT_FLOAT_EQ(grid.step_index.x, 1.0f / 3);
  EXPECT_EQ(grid.step_index.y, 1.0f);
  EXPECT_EQ(grid.step_index.z, 0.25f);
  EXPECT_EQ(grid.index_box().lower, Vec3f(-0.5f));
  EXPECT_EQ(grid.index_box().upper, Vec3f(2.5f, 4.5f, 6.5f));
}

TEST(Transform, WorldBoundsAreTight) {
  for (const Placement& placement : placements()) {
    const Volume volume = placed(placement);
    const Box3d box = world_bounds(volume);
    Vec3d lower(1e9), upper(-1e9);
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3d p =
          world_of(volume, {corner & 1 ? 2.5 : -0.5, corner & 2 ? 4.5 : -0.5, corner & 4 ? 6.5 : -0.5});
      lower = min(lower, p);
      upper = max(upper, p);
    }
    expect_near(box.lower, lower, 1e-10);
    expect_near(box.upper, upper, 1e-10);
  }
}

}  // namespace
}  // namespace voxlume
