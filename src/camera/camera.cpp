#include "camera/camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr double kRadiansPerDegree = std::numbers::pi / 180.0;
constexpr double kMaxLength_mm = 1e9;
/// Of target and eye from the volume, so that no sum of two such lengths is beyond the other limit.
constexpr double kMostAway_mm = 5e8;

void require(bool holds, const char* name, const std::string& found, const std::string& expected) {
  if (!holds)
    throw Error(ErrorCode::kBadParameter, std::string("/camera/") + name,
                "found " + found + ", expected " + expected);
}

void require_between(double x, double low, double high, const char* name) {
  require(x >= low && x <= high, name, fmt::to_string(x),
          "a number in [" + fmt::to_string(low) + ", " + fmt::to_string(high) + "]");
}

void require_positive(double x, const char* name) {
  require(x > 0 && x <= kMaxLength_mm, name, fmt::to_string(x), "a number in (0, 1e9]");
}

Vec3d checked_place(const Double3& v, const char* name) {
  for (double x : v)
    require(std::abs(x) <= kMostAway_mm, name, fmt::format("a place {:.4g} mm from the volume", std::abs(x)),
            "one within 5e8 mm");
  return {v[0], v[1], v[2]};
}

Vec3d checked_direction(const Double3& v, const char* name) {
  for (double x : v) require(std::isfinite(x), name, fmt::to_string(x), "three finite numbers");
  const Vec3d out(v[0], v[1], v[2]);
  const double size = max_component(max(out, -out));
  require(size > 0, name, "a zero vector", "a direction");
  return out / size;
}

/// Distance at which the eye sees the sphere of fit_radius_mm at its zoom. Where that is out of reach, the
/// field is refused that contributes most; radius_mm is that of what there is to see.
double checked_fit_distance(const CameraDescription& d, double fit_radius_mm, double radius_mm,
                            double tan_half_smaller) {
  const double distance = fit_radius_mm / (std::sin(std::atan(tan_half_smaller)) * d.zoom);
  if (distance <= kMostAway_mm) return distance;
  const double by_zoom = 1 / d.zoom, by_angle = 15 / d.vertical_fov_deg,
               by_radius = fit_radius_mm / radius_mm;
  const double most = std::max({by_zoom, by_angle, by_radius});
  const auto refuse = [&](const char* name, double found) {
    require(false, name, fmt::to_string(found),
            fmt::format("one that puts the eye within 5e8 mm of the target, not at {:.2g} mm", distance));
  };
  if (most == by_zoom) refuse("zoom", d.zoom);
  if (most == by_angle) refuse("vertical_fov_deg", d.vertical_fov_deg);
  refuse("fit_radius_mm", fit_radius_mm);
  return distance;
}

void validate(const CameraDescription& d) {
  require(std::isfinite(d.azimuth_deg), "azimuth_deg", fmt::to_string(d.azimuth_deg), "a finite angle");
  require(std::isfinite(d.roll_deg), "roll_deg", fmt::to_string(d.roll_deg), "a finite angle");
  require_between(d.elevation_deg, -90, 90, "elevation_deg");
  require_positive(d.zoom, "zoom");
  require(d.vertical_fov_deg > 0 && d.vertical_fov_deg <= 170, "vertical_fov_deg",
          fmt::to_string(d.vertical_fov_deg), "a number in (0, 170]");
  require_between(d.aperture_radius_mm, 0, kMaxLength_mm, "aperture_radius_mm");
  if (d.height_mm) require_positive(*d.height_mm, "height_mm");
  if (d.focus_mm) require_positive(*d.focus_mm, "focus_mm");
  if (d.fit_radius_mm) require_positive(*d.fit_radius_mm, "fit_radius_mm");
  require_between(d.background_blur_deg, 0, 45, "background_blur_deg");
}

struct Pose {
  Vec3d eye, target, up, forward;  // up is not yet perpendicular when it comes from the description
};

/// The eye at azimuth and elevation, `distance` from the target. The up vector is the derivative of the
/// direction by the elevation, so that it is defined at the poles too.
Pose orbit(const CameraDescription& d, Vec3d target, double distance) {
  const double az = d.azimuth_deg * kRadiansPerDegree, el = d.elevation_deg * kRadiansPerDegree;
  const Vec3d toward_eye(std::cos(el) * std::sin(az), -std::cos(el) * std::cos(az), std::sin(el));
  const Vec3d up(-std::sin(el) * std::sin(az), std::sin(el) * std::cos(az), std::cos(el));
  return {target + toward_eye * distance, target, up, -toward_eye};
}

Pose place_at_eye(const CameraDescription& d, Vec3d target) {
  const Vec3d eye = checked_place(*d.eye_mm, "eye_mm");
  const Vec3d to_target = target - eye;
  require(length(to_target) > 1e-9, "eye_mm", "the target itself", "another point");
  const Vec3d forward = normalize(to_target);
  Vec3d up = d.up ? checked_direction(*d.up, "up") : Vec3d(0, 0, 1);
  if (length(cross(forward, up)) <= 1e-6 * length(up)) {
    require(!d.up, "up", "the viewing direction", "a vector across the viewing direction");
    up = Vec3d(0, forward.z < 0 ? 1 : -1, 0);  // the limit of azimuth 0, elevation +-90
  }
  return {eye, target, up, forward};
}

}  // namespace

CameraView compile_camera(const CameraDescription& d, Vec3f center_mm, float radius_mm, int width,
                          int height) {
  validate(d);
  if (!(radius_mm > 0) || !std::isfinite(radius_mm) || !is_finite(center_mm) || width < 1 || height < 1)
    throw Error(ErrorCode::kInternal, "",
                "the camera needs a finite sphere of positive radius and a picture size >= 1");
  const bool orthographic = d.projection == Projection::kOrthographic;
  const double smaller = std::min(1.0, static_cast<double>(width) / height);  // smaller image side / height
  const double tan_half = std::tan(0.5 * d.vertical_fov_deg * kRadiansPerDegree);
  const Vec3d center(center_mm);
  const Vec3d target = d.target_mm ? checked_place(*d.target_mm, "target_mm") : center;

  const double fit_radius = d.fit_radius_mm.value_or(radius_mm);
  const bool fits = !d.eye_mm && !orthographic;
  const double fit_distance = fits ? checked_fit_distance(d, fit_radius, radius_mm, tan_half * smaller) : 0.0;
  const double outside = 2.0 * radius_mm + length(target - center);
  const Pose pose =
      d.eye_mm ? place_at_eye(d, target) : orbit(d, target, orthographic ? outside : fit_distance);

  const Vec3d right_level = normalize(cross(pose.forward, pose.up));
  const Vec3d up_level = cross(right_level, pose.forward);
  const double roll = d.roll_deg * kRadiansPerDegree;
  const double half_height_mm = 0.5 * (d.height_mm ? *d.height_mm : 2.0 * fit_radius / smaller / d.zoom);
  const double half_height = orthographic ? half_height_mm : tan_half;

  CameraView out;
  out.eye_mm = Vec3f(pose.eye);
  out.target_mm = Vec3f(target);
  out.right = Vec3f(right_level * std::cos(roll) - up_level * std::sin(roll));
  out.up = Vec3f(up_level * std::cos(roll) + right_level * std::sin(roll));
  out.forward = Vec3f(pose.forward);
  out.orthographic = orthographic;
  out.half_width = static_cast<float>(half_height * width / height);
  out.half_height = static_cast<float>(half_height);
  out.width_px = static_cast<float>(width);
  out.height_px = static_cast<float>(height);
  out.aperture_radius_mm = static_cast<float>(d.aperture_radius_mm);
  out.focus_mm = static_cast<float>(d.focus_mm ? *d.focus_mm : length(pose.target - pose.eye));
  const double half_blur = 0.5 * d.background_blur_deg * kRadiansPerDegree;
  out.background_versine = static_cast<float>(2.0 * std::sin(half_blur) * std::sin(half_blur));
  return out;
}

ViewFrame view_frame(const CameraView& camera) {
  return {camera.right, camera.up, -camera.forward, camera.target_mm};
}

PixelPosition project(const CameraView& camera, Vec3f p_world) noexcept {
  const Vec3f from_eye = p_world - camera.eye_mm;
  const float depth_mm = dot(from_eye, camera.forward);
  const float scale = camera.orthographic ? 1.0f : 1.0f / depth_mm;
  const float x = dot(from_eye, camera.right) * scale / camera.half_width;
  const float y = dot(from_eye, camera.up) * scale / camera.half_height;
  return {0.5f * (x + 1.0f) * camera.width_px, 0.5f * (1.0f - y) * camera.height_px, depth_mm};
}

}  // namespace voxlume
