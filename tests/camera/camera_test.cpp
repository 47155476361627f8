#include "camera/camera.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <limits>

#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/random_direction.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

const Vec3f kCenter(10, -20, 30);
constexpr float kRadius = 100;

CameraView compile(const CameraDescription& d, int width = 200, int height = 100) {
  return compile_camera(d, kCenter, kRadius, width, height);
}

void expect_vec_near(Vec3f a, Vec3f b, float tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

CameraDescription at(double azimuth, double elevation) {
  CameraDescription d;
  d.azimuth_deg = azimuth;
  d.elevation_deg = elevation;
  return d;
}

TEST(Camera, FrontViewIsTheConvention) {
  const CameraView camera = compile(at(0, 0));
  const Vec3f to_eye = normalize(camera.eye_mm - kCenter);
  expect_vec_near(to_eye, {0, -1, 0}, 1e-6f);
  expect_vec_near(camera.up, {0, 0, 1}, 1e-6f);
  expect_vec_near(camera.right, {1, 0, 0}, 1e-6f);
  // The patient's left is on the image's right, the head is at its top.
  EXPECT_GT(project(camera, kCenter + Vec3f(10, 0, 0)).px, 100.0f);
  EXPECT_LT(project(camera, kCenter + Vec3f(0, 0, 10)).py, 50.0f);
  const PixelPosition centre = project(camera, kCenter);
  EXPECT_NEAR(centre.px, 100.0f, 1e-3f);
  EXPECT_NEAR(centre.py, 50.0f, 1e-3f);
}

TEST(Camera, AzimuthAndElevation) {
  const auto to_eye = [](double azimuth, double elevation) {
    return normalize(compile(at(azimuth, elevation)).eye_mm - kCenter);
  };
  expect_vec_near(to_eye(90, 0), {1, 0, 0}, 1e-6f);
  expect_vec_near(to_eye(180, 0), {0, 1, 0}, 1e-6f);
  expect_vec_near(to_eye(-90, 0), {-1, 0, 0}, 1e-6f);
  expect_vec_near(to_eye(0, 90), {0, 0, 1}, 1e-6f);
  expect_vec_near(to_eye(0, -90), {0, 0, -1}, 1e-6f);
  // At the poles up is the limit of what it is nearby.
  for (double azimuth : {0.0, 30.0, 200.0})
    for (double pole : {90.0, -90.0}) {
      const CameraView limit = compile(at(azimuth, pole)), near = compile(at(azimuth, pole * 0.99999));
      expect_vec_near(limit.up, near.up, 1e-4f);
      expect_vec_near(limit.right, near.right, 1e-4f);
    }
}

TEST(Camera, AxesAreARightHandedBasis) {
  Rng rng(1, 0, 0, 0);
  for (int i = 0; i < 500; ++i) {
    CameraDescription d = at(720.0 * rng.next() - 360, 180.0 * rng.next() - 90);
    d.roll_deg = 360.0 * rng.next();
    if (i % 2) d.eye_mm = Double3{500.0 * rng.next(), 400.0, -300.0 * rng.next()};
    const CameraView camera = compile(d);
    EXPECT_NEAR(length(camera.up), 1.0f, 1e-6f);
    EXPECT_NEAR(dot(camera.up, camera.forward), 0.0f, 1e-6f);
    expect_vec_near(cross(camera.forward, camera.up), camera.right, 1e-6f);
    const ViewFrame frame = view_frame(camera);
    expect_vec_near(cross(frame.right, frame.up), frame.toward_eye, 1e-6f);
    EXPECT_EQ(frame.target_mm, kCenter);
  }
}

TEST(Camera, RollTurnsTheCameraClockwise) {
  CameraDescription d = at(0, 0);
  d.roll_deg = 90;
  const CameraView camera = compile(d);
  expect_vec_near(camera.up, {1, 0, 0}, 1e-6f);
  expect_vec_near(camera.right, {0, 0, -1}, 1e-6f);
}

/// At zoom 1 the sphere's outline touches the borders of the smaller side and stays inside the picture.
TEST(Camera, SphereFitsTheSmallerSide) {
  struct Size {
    int width, height;
  };
  for (Projection projection : {Projection::kPerspective, Projection::kOrthographic})
    for (Size size : {Size{200, 100}, Size{100, 300}, Size{64, 64}})
      for (double fov : {5.0, 30.0, 120.0}) {
        CameraDescription d = at(40, 25);
        d.projection = projection;
        d.vertical_fov_deg = fov;
        const CameraView camera = compile(d, size.width, size.height);
        float x_low = 1e9f, x_high = -1e9f, y_low = 1e9f, y_high = -1e9f;
        Rng rng(2, 0, 0, 0);
        for (int i = 0; i < 200000; ++i) {
          const PixelPosition p = project(camera, kCenter + test::random_direction(rng) * kRadius);
          ASSERT_GT(p.depth_mm, 0.0f);
          x_low = std::min(x_low, p.px), x_high = std::max(x_high, p.px);
          y_low = std::min(y_low, p.py), y_high = std::max(y_high, p.py);
        }
        const float smaller = static_cast<float>(std::min(size.width, size.height));
        const float x_margin = 0.5f * (static_cast<float>(size.width) - smaller);
        const float y_margin = 0.5f * (static_cast<float>(size.height) - smaller);
        // Below the border by what random points miss of the outline, above it by rounding.
        const float slack = 0.002f * smaller, rounding = 1e-4f * smaller;
        for (float low : {x_low - x_margin, y_low - y_margin}) {
          EXPECT_LT(low, slack);
          EXPECT_GT(low, -rounding);
        }
        for (float high : {x_high - x_margin, y_high - y_margin}) {
          EXPECT_GT(high, smaller - slack);
          EXPECT_LT(high, smaller + rounding);
        }
      }
}

TEST(Camera, ZoomMagnifiesAtTheTarget) {
  for (Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    CameraDescription d = at(0, 0);
    d.projection = projection;
    const float once = project(compile(d), kCenter + Vec3f(1, 0, 0)).px - 100;
    d.zoom = 2;
    EXPECT_NEAR(project(compile(d), kCenter + Vec3f(1, 0, 0)).px - 100, 2 * once, 1e-3f * once);
  }
}

TEST(Camera, ProjectionInvertsTheRay) {
  Rng rng(3, 0, 0, 0);
  for (Projection projection : {Projection::kPerspective, Projection::kOrthographic})
    for (int i = 0; i < 1000; ++i) {
      CameraDescription d = at(70, -30);
      d.projection = projection;
      const CameraView camera = compile(d);
      const float px = 200 * rng.next(), py = 100 * rng.next(), t = 100 + 400 * rng.next();
      const CameraRay ray = camera_ray(camera, px, py, 0.3f, 0.7f);
      EXPECT_NEAR(length(ray.direction), 1.0f, 1e-6f);
      const PixelPosition p = project(camera, ray.origin + ray.direction * t);
      EXPECT_NEAR(p.px, px, 1e-2f);
      EXPECT_NEAR(p.py, py, 1e-2f);
      EXPECT_NEAR(p.depth_mm, t * dot(ray.direction, camera.forward), 1e-2f);
    }
}

TEST(Camera, CornersOfTheImage) {
  const CameraView camera = compile(at(0, 0));
  const Vec3f top_left = camera_ray(camera, 0, 0, 0, 0).direction;
  const Vec3f bottom_right = camera_ray(camera, 200, 100, 0, 0).direction;
  const float tan_half = std::tan(15.0f * std::numbers::pi_v<float> / 180);
  expect_vec_near(top_left * (1 / top_left.y), {-2 * tan_half, 1, tan_half}, 1e-5f);
  expect_vec_near(bottom_right * (1 / bottom_right.y), {2 * tan_half, 1, -tan_half}, 1e-5f);
}

TEST(Camera, ProjectBehindTheEye) {
  const CameraView camera = compile(at(0, 0));
  EXPECT_LE(project(camera, camera.eye_mm - camera.forward * 10.0f).depth_mm, 0.0f);
}

TEST(Camera, LensRaysMeetInTheFocusPlane) {
  Rng rng(4, 0, 0, 0);
  for (Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    CameraDescription d = at(10, 20);
    d.projection = projection;
    d.aperture_radius_mm = 5;
    d.focus_mm = 250;
    const CameraView camera = compile(d);
    d.aperture_radius_mm = 0;
    const CameraRay centre = camera_ray(compile(d), 150, 20, 0, 0);
    const Vec3f sharp = centre.origin + centre.direction * (250 / dot(centre.direction, camera.forward));
    float widest = 0;
    for (int i = 0; i < 1000; ++i) {
      const float u0 = rng.next(), u1 = rng.next();
      const CameraRay ray = camera_ray(camera, 150, 20, u0, u1);
      const Vec3f met = ray.origin + ray.direction * (250 / dot(ray.direction, camera.forward));
      EXPECT_LT(length(met - sharp), 1e-2f);
      EXPECT_NEAR(dot(ray.origin - centre.origin, camera.forward), 0.0f, 1e-3f);
      widest = std::max(widest, length(ray.origin - centre.origin));
    }
    EXPECT_LE(widest, 5.001f);
    EXPECT_GT(widest, 4.9f);
  }
}

TEST(Camera, FocusDefaultsToTheTarget) {
  const CameraView camera = compile(at(10, 20));
  EXPECT_NEAR(camera.focus_mm, length(camera.eye_mm - kCenter), 1e-3f);
}

TEST(Camera, EyeOverridesTheAngles) {
  CameraDescription d = at(50, 10);
  d.zoom = 7;
  d.eye_mm = Double3{10, -20, 530};  // straight above the default target, where the default up is of no use
  const CameraView above = compile(d), limit = compile(at(0, 90));
  EXPECT_EQ(above.eye_mm, Vec3f(10, -20, 530));
  expect_vec_near(above.forward, {0, 0, -1}, 1e-6f);
  expect_vec_near(above.up, limit.up, 1e-6f);
  d.up = Double3{2, 0, 1};
  expect_vec_near(compile(d).up, {1, 0, 0}, 1e-6f);
  d.up.reset();
  d.target_mm = Double3{10, 80, 530};
  const CameraView level = compile(d);
  expect_vec_near(level.forward, {0, 1, 0}, 1e-6f);
  expect_vec_near(level.up, {0, 0, 1}, 1e-6f);
  EXPECT_EQ(level.target_mm, Vec3f(10, 80, 530));
}

TEST(Camera, HeightOfAnOrthographicView) {
  CameraDescription d = at(0, 0);
  d.projection = Projection::kOrthographic;
  d.height_mm = 40;
  const CameraView camera = compile(d);
  EXPECT_NEAR(project(camera, kCenter + Vec3f(0, 0, 20)).py, 0.0f, 1e-3f);
  EXPECT_NEAR(project(camera, kCenter + Vec3f(40, 0, 0)).px, 200.0f, 1e-3f);
  // Nothing of the sphere is behind the eye, wherever the target is.
  d.target_mm = Double3{10, 500, 30};
  EXPECT_GT(project(compile(d), kCenter - Vec3f(0, kRadius, 0)).depth_mm, 0.0f);
}

TEST(Camera, BackgroundFillsItsConeUniformly) {
  CameraDescription d = at(30, 10);
  d.background_blur_deg = 10;
  d.aperture_radius_mm = 3;
  const CameraView camera = compile(d);
  const Vec3f axis = normalize(camera.forward + image_offset(camera, 60, 80));
  const double half = 10 * std::numbers::pi / 180;
  const double density = 1 / (2 * std::numbers::pi * (1 - std::cos(half)));
  Rng rng(5, 0, 0, 0);
  const auto draw = [&] {
    const float u0 = rng.next(), u1 = rng.next();
    return test::DirectionDraw{background_direction(camera, 60, 80, u0, u1), static_cast<float>(density)};
  };
  const auto pdf = [&](Vec3f w) { return dot(Vec3d(w), Vec3d(axis)) > std::cos(half) ? density : 0.0; };
  test::expect_directions_fit(test::SphereBins(axis, half), draw, pdf, 1);
}

TEST(Camera, SharpBackgroundFollowsThePinhole) {
  const CameraView camera = compile(at(30, 10));
  expect_vec_near(background_direction(camera, 20, 90, 0.2f, 0.9f),
                  camera_ray(camera, 20, 90, 0.2f, 0.9f).direction, 1e-6f);
}

TEST(Camera, EdgesAreFinite) {
  for (Projection projection : {Projection::kPerspective, Projection::kOrthographic})
    for (double elevation : {-90.0, 0.0, 90.0}) {
      CameraDescription d = at(0, elevation);
      d.projection = projection;
      d.aperture_radius_mm = 10;
      d.background_blur_deg = 45;
      d.vertical_fov_deg = 170;
      const CameraView camera = compile(d, 65536, 1);
      for (float u0 : test::kEdgeNumbers)
        for (float u1 : test::kEdgeNumbers)
          for (float px : {0.0f, 65536.0f}) {
            const CameraRay ray = camera_ray(camera, px, 1, u0, u1);
            ASSERT_TRUE(is_finite(ray.origin));
            ASSERT_NEAR(length(ray.direction), 1.0f, 2e-6f);
            ASSERT_NEAR(length(background_direction(camera, px, 1, u0, u1)), 1.0f, 2e-6f);
          }
    }
}

void expect_refused(const std::string& where, const std::function<void(CameraDescription&)>& spoil) {
  CameraDescription d;
  spoil(d);
  try {
    compile(d);
    FAIL() << "accepted: " << where;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
    EXPECT_EQ(error.where(), where);
    EXPECT_EQ(error.message().find('\n'), std::string::npos);
  }
}

TEST(Camera, RefusesWhatCannotBe) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  using D = CameraDescription;
  expect_refused("/camera/zoom", [](D& d) { d.zoom = 0; });
  expect_refused("/camera/zoom", [](D& d) { d.zoom = kNan; });
  expect_refused("/camera/zoom", [](D& d) { d.zoom = 1e-12; });
  expect_refused("/camera/azimuth_deg", [](D& d) { d.azimuth_deg = kNan; });
  expect_refused("/camera/roll_deg", [](D& d) { d.roll_deg = kNan; });
  expect_refused("/camera/elevation_deg", [](D& d) { d.elevation_deg = 90.1; });
  expect_refused("/camera/vertical_fov_deg", [](D& d) { d.vertical_fov_deg = 0; });
  expect_refused("/camera/vertical_fov_deg", [](D& d) { d.vertical_fov_deg = 171; });
  expect_refused("/camera/aperture_radius_mm", [](D& d) { d.aperture_radius_mm = -1; });
  expect_refused("/camera/focus_mm", [](D& d) { d.focus_mm = 0; });
  expect_refused("/camera/height_mm", [](D& d) { d.height_mm = -3; });
  expect_refused("/camera/background_blur_deg", [](D& d) { d.background_blur_deg = 46; });
  expect_refused("/camera/target_mm", [](D& d) { d.target_mm = Double3{0, kNan, 0}; });
  expect_refused("/camera/eye_mm", [](D& d) { d.eye_mm = Double3{10, -20, 30}; });
  expect_refused("/camera/up", [](D& d) { d.eye_mm = Double3{10, -20, 300}, d.up = Double3{0, 0, -1}; });
  expect_refused("/camera/up", [](D& d) { d.eye_mm = Double3{10, -20, 300}, d.up = Double3{0, 0, 0}; });
}

}  // namespace
}  // namespace voxlume
