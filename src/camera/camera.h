#pragma once
#include <cmath>

#include "base/vec.h"
#include "light/view_frame.h"
#include "sampling/warp.h"
#include "voxlume/scene.h"

namespace voxlume {

/// A compiled camera. Image right is forward x up; the image plane is at distance 1 (perspective) or the
/// plane through the eye (orthographic).
struct CameraView {
  Vec3f eye_mm, target_mm;
  Vec3f right, up, forward;  ///< orthonormal
  bool orthographic;
  float half_width, half_height;  ///< of the image: tangents (perspective) or mm (orthographic)
  float width_px, height_px;
  float aperture_radius_mm;  ///< 0: pinhole
  float focus_mm;            ///< distance of the sharp plane from the eye, along forward
  float background_versine;  ///< 1 - cos of the background's blur angle
};

/// `direction` is unit and leads away from the eye.
struct CameraRay {
  Vec3f origin, direction;
};

/// Where a point is seen. (0,0) is the top left corner of the image. depth_mm is along the viewing axis;
/// where it is not > 0 a perspective camera does not see the point and px, py mean nothing.
struct PixelPosition {
  float px, py;
  float depth_mm;
};

/// Frames the sphere (`center_mm`, `radius_mm` > 0) for an image of width x height pixels (>= 1), or one of
/// the description's fit_radius_mm. Without eye_mm a perspective eye is at radius / (sin(half the angle of
/// the smaller image side) * zoom) from the target; an orthographic one is outside the sphere given and zoom
/// divides the view's height. Roll turns
/// the camera clockwise as seen from behind it, so that the picture turns counter-clockwise. Throws
/// kBadParameter at "/camera/NAME".
CameraView compile_camera(const CameraDescription& description, Vec3f center_mm, float radius_mm, int width,
                          int height);

/// The axes that lights attached to the camera use.
ViewFrame view_frame(const CameraView& camera);

/// Where a point is seen through the centre of the lens.
PixelPosition project(const CameraView& camera, Vec3f p_world) noexcept;

/// Offset of an image point from the viewing axis, in units of half_width and half_height; y upward.
inline Vec3f image_offset(const CameraView& camera, float px, float py) noexcept {
  const float x = (2.0f * px / camera.width_px - 1.0f) * camera.half_width;
  const float y = (1.0f - 2.0f * py / camera.height_px) * camera.half_height;
  return camera.right * x + camera.up * y;
}

/// The ray through image point (px, py), in pixels from the top left corner, and the lens point u0, u1.
inline CameraRay camera_ray(const CameraView& camera, float px, float py, float u0, float u1) noexcept {
  const Vec3f offset = image_offset(camera, px, py);
  Vec3f origin = camera.eye_mm;
  Vec3f direction = camera.forward;
  if (camera.orthographic)
    origin += offset;
  else
    direction += offset;
  if (camera.aperture_radius_mm > 0.0f) {
    const DiskPoint disk = concentric_disk(u0, u1);
    const Vec3f lens = (camera.right * disk.x + camera.up * disk.y) * camera.aperture_radius_mm;
    origin += lens;
    direction = direction * camera.focus_mm - lens;
  }
  return {origin, normalize(direction)};
}

/// The direction in which image point (px, py) looks at the environment behind the volume: spread uniformly
/// in solid angle over the cone of the background's blur (xu2024 6.1), and untouched by the aperture.
inline Vec3f background_direction(const CameraView& camera, float px, float py, float u0, float u1) noexcept {
  const Vec3f axis =
      camera.orthographic ? camera.forward : normalize(camera.forward + image_offset(camera, px, py));
  if (!(camera.background_versine > 0.0f)) return axis;
  return Frame(axis).to_world(uniform_cone(camera.background_versine, u0, u1));
}

}  // namespace voxlume
