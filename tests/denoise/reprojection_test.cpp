#include "denoise/reprojection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "base/parallel.h"

namespace voxlume {
namespace {

constexpr int kWidth = 101, kHeight = 67;
constexpr float kRadius_mm = 150;

CameraView camera(double azimuth_deg, Projection projection = Projection::kPerspective) {
  CameraDescription description;
  description.azimuth_deg = azimuth_deg;
  description.elevation_deg = 12;
  description.roll_deg = 7;
  description.projection = projection;
  return compile_camera(description, Vec3f(3, -5, 8), kRadius_mm, kWidth, kHeight);
}

/// Depths of the plane through the target that faces azimuth 0.
Plane plane_depths(const CameraView& view) {
  Plane depth(kWidth, kHeight);
  const Vec3f normal = camera(0).forward;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const CameraRay ray =
          camera_ray(view, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 0);
      depth.at(x, y) = dot(view.target_mm - ray.origin, normal) / dot(ray.direction, normal);
    }
  }
  return depth;
}

class EveryProjection : public testing::TestWithParam<Projection> {};

TEST_P(EveryProjection, FollowsAPlaneWhenTheCameraTurns) {
  const CameraView now = camera(20, GetParam()), before = camera(14, GetParam());
  const Plane depth = plane_depths(now);
  Reprojector reproject;
  const Reprojection& moved = reproject(now, depth, before);
  int seen = 0;
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const CameraRay ray = camera_ray(now, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0, 0);
      const Vec3f p = ray.origin + ray.direction * depth.at(x, y);
      const PixelPosition expected = project(before, p);
      const bool inside = expected.px >= 0.01f && expected.py >= 0.01f && expected.px < kWidth - 0.01f &&
                          expected.py < kHeight - 0.01f;
      if (!inside) continue;
      ++seen;
      ASSERT_NEAR(moved.x.at(x, y), expected.px, 0.01f) << x << ' ' << y;
      ASSERT_NEAR(moved.y.at(x, y), expected.py, 0.01f) << x << ' ' << y;
      const float distance =
          GetParam() == Projection::kPerspective ? length(p - before.eye_mm) : expected.depth_mm;
      ASSERT_NEAR(moved.depth_mm.at(x, y), distance, 1e-3f * distance);
    }
  }
  EXPECT_GT(seen, kWidth * kHeight / 2);
}

INSTANTIATE_TEST_SUITE_P(Projections, EveryProjection,
                         testing::Values(Projection::kPerspective, Projection::kOrthographic));

TEST(Reprojector, StaysWhereNothingMoves) {
  const CameraView view = camera(33);
  const Plane depth = plane_depths(view);
  Reprojector reproject;
  const Reprojection& moved = reproject(view, depth, view);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      ASSERT_NEAR(moved.x.at(x, y), static_cast<float>(x) + 0.5f, 0.005f);
      ASSERT_NEAR(moved.y.at(x, y), static_cast<float>(y) + 0.5f, 0.005f);
    }
  }
}

TEST(Reprojector, EmptyPixelsTakeTheNearestDepthAround) {
  const CameraView view = camera(0);
  Plane depth(kWidth, kHeight);
  depth.at(50, 30) = 400;
  depth.at(52, 30) = 300;
  Reprojector reproject;
  const Reprojection& moved = reproject(view, depth, view);
  EXPECT_NEAR(moved.depth_mm.at(50, 30), 400, 0.05f) << "its own depth";
  EXPECT_NEAR(moved.depth_mm.at(51, 31), 300, 0.05f) << "the least around";
  EXPECT_NEAR(moved.depth_mm.at(48, 30), 400, 0.05f) << "the other is out of reach";
  EXPECT_EQ(moved.x.at(50, 33), Reprojection::kNowhere);
  EXPECT_EQ(moved.depth_mm.at(50, 33), 0);
}

TEST(Reprojector, WhatWasBehindTheEyeIsNowhere) {
  CameraView now = camera(0), before = now;
  before.eye_mm = now.eye_mm + now.forward * 1000.0f;
  Plane depth(kWidth, kHeight);
  depth.fill(500);
  Reprojector reproject;
  const Reprojection& moved = reproject(now, depth, before);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) ASSERT_EQ(moved.x.at(x, y), Reprojection::kNowhere);
  }
}

}  // namespace
}  // namespace voxlume
