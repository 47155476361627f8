#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/reprojection.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/parallel.h"
#include "denoise/reprojection.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// Larger than any depth.
constexpr float kFar = 1e30f;

/// The least positive depth of five in a row; kFar without one.
void least_of_row(const Plane& depth_mm, int y, Plane& out) {
  const F far = hn::Set(kD, kFar);
  const float* in = depth_mm.row(y);
  for_row(depth_mm.width(), [&](int x, std::size_t lanes) {
    F least = far;
    for (int dx = -2; dx <= 2; ++dx) {
      const F depth = hn::LoadU(kD, in + x + dx);
      least = hn::IfThenElse(hn::Gt(depth, hn::Zero(kD)), hn::Min(least, depth), least);
    }
    store(least, out, x, y, lanes);
  });
}

/// The pixel's own depth, or the least around it; 0 without one.
void near_depth_of_row(const Plane& depth_mm, const Plane& row_minimum, int y, Plane& out) {
  for_row(depth_mm.width(), [&](int x, std::size_t lanes) {
    F least = hn::Set(kD, kFar);
    for (int row = std::max(0, y - 2); row <= std::min(depth_mm.height() - 1, y + 2); ++row)
      least = hn::Min(least, load(row_minimum, x, row));
    const F own = load(depth_mm, x, y);
    const F around = hn::IfThenElseZero(hn::Lt(least, hn::Set(kD, kFar)), least);
    store(hn::IfThenElse(hn::Gt(own, hn::Zero(kD)), own, around), out, x, y, lanes);
  });
}

/// camera_ray through the pixels' centres, and project.
void reproject_row(const CameraView& now, const Plane& depth_mm, const CameraView& before, int y,
                   Reprojection& out) {
  const F one = hn::Set(kD, 1.0f), half = hn::Set(kD, 0.5f), zero = hn::Zero(kD);
  const F3 right = set(now.right * now.half_width), forward = set(now.forward);
  const float up = (1.0f - 2.0f * (static_cast<float>(y) + 0.5f) / now.height_px) * now.half_height;
  const F3 row_offset = set(now.up * up), eye = set(now.eye_mm), eye_before = set(before.eye_mm);
  const F3 right_before = set(before.right * (1 / before.half_width)),
           up_before = set(before.up * (1 / before.half_height)), forward_before = set(before.forward);
  const F width = hn::Set(kD, before.width_px), height = hn::Set(kD, before.height_px);
  for_row(depth_mm.width(), [&](int x, std::size_t lanes) {
    const F column = hn::Add(hn::Iota(kD, static_cast<float>(x)), half);
    const F across = hn::Sub(hn::Mul(column, hn::Set(kD, 2.0f / now.width_px)), one);
    const F3 offset = add_scaled(row_offset, right, across);
    const F depth = load(depth_mm, x, y);
    const F3 ahead = add_scaled(offset, forward, one);
    const F3 p = now.orthographic ? add_scaled(add_scaled(eye, offset, one), forward, depth)
                                  : add_scaled(eye, ahead, hn::Div(depth, hn::Sqrt(dot(ahead, ahead))));
    const F3 from_eye = add_scaled(p, eye_before, hn::Set(kD, -1.0f));
    const F axial = dot(from_eye, forward_before);
    const F scale = before.orthographic ? one : hn::Div(one, axial);
    const F u = hn::Mul(dot(from_eye, right_before), scale), v = hn::Mul(dot(from_eye, up_before), scale);
    const F px = hn::Mul(hn::Mul(half, hn::Add(u, one)), width);
    const F py = hn::Mul(hn::Mul(half, hn::Sub(one, v)), height);
    auto seen = hn::And(hn::Gt(depth, zero), hn::And(hn::Ge(px, zero), hn::Lt(px, width)));
    seen = hn::And(seen, hn::And(hn::Ge(py, zero), hn::Lt(py, height)));
    if (!before.orthographic) seen = hn::And(seen, hn::Gt(axial, zero));
    const F nowhere = hn::Set(kD, Reprojection::kNowhere);
    store(hn::IfThenElse(seen, px, nowhere), out.x, x, y, lanes);
    store(hn::IfThenElse(seen, py, nowhere), out.y, x, y, lanes);
    const F distance = before.orthographic ? axial : hn::Sqrt(dot(from_eye, from_eye));
    store(hn::IfThenElseZero(seen, distance), out.depth_mm, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(least_of_row);
HWY_EXPORT(near_depth_of_row);
HWY_EXPORT(reproject_row);

const Reprojection& Reprojector::operator()(const CameraView& now, const Plane& depth_mm,
                                            const CameraView& before) {
  const int width = depth_mm.width(), height = depth_mm.height();
  if (near_depth_mm_.width() != width || near_depth_mm_.height() != height) {
    for (Plane* plane : {&row_minimum_, &near_depth_mm_, &result_.x, &result_.y, &result_.depth_mm})
      *plane = Plane(width, height);
  }
  const auto for_rows = [&](const auto& body) {
    parallel_for(height, 16, [&](std::int64_t y) { body(static_cast<int>(y)); });
  };
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(least_of_row)(depth_mm, y, row_minimum_); });
  for_rows([&](int y) {
    HWY_DYNAMIC_DISPATCH(near_depth_of_row)(depth_mm, row_minimum_, y, near_depth_mm_);
    HWY_DYNAMIC_DISPATCH(reproject_row)(now, near_depth_mm_, before, y, result_);
  });
  return result_;
}

}  // namespace voxlume
#endif  // HWY_ONCE
