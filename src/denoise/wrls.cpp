#include "denoise/wrls.h"

#include <cmath>

#include "base/assert.h"
#include "base/parallel.h"

namespace voxlume {
namespace {

/// A frame so many times brighter or darker than the one before has nothing to do with it.
constexpr float kLargestStep = 256;
constexpr float kLeastScale = 1e-12f, kGreatestScale = 1e12f;

[[maybe_unused]] bool is_finite(const Plane& plane) {
  for (int y = 0; y < plane.height(); ++y) {
    for (int x = 0; x < plane.width(); ++x) {
      if (!std::isfinite(plane.at(x, y))) return false;
    }
  }
  return true;
}

[[maybe_unused]] bool is_finite(const DenoiseFrame& frame) {
  return is_finite(frame.radiance[0]) && is_finite(frame.radiance[1]) && is_finite(frame.radiance[2]) &&
         is_finite(frame.alpha) && is_finite(frame.depth_mm) && is_finite(frame.variance);
}

template <class Body>
void for_rows(int height, const Body& body) {
  parallel_for(height, 8, [&](std::int64_t y) { body(static_cast<int>(y)); });
}

}  // namespace

void Wrls::denoise(const DenoiseFrame& frame, DenoisedFrame& out) {
  VOXLUME_ASSERT(is_finite(frame));
  if (guide_.inside.width() != frame.width || guide_.inside.height() != frame.height)
    resize(frame.width, frame.height);
  out.resize(frame.width, frame.height);
  measure_scale(frame);
  const Reprojection& moved =
      reproject_(frame.camera, frame.depth_mm, camera_before_ ? *camera_before_ : frame.camera);
  const WrlsUpdate update{.frame = frame,
                          .moved = moved,
                          .scale = scale_ > 0 ? scale_ : 1,
                          .weighted = options_.weighted,
                          .frame_number = frame_number_++,
                          .before = models_[now_],
                          .after = models_[1 - now_],
                          .guide = guide_};
  for_rows(frame.height, [&](int y) { update_models_row(update, y); });
  for_rows(frame.height, [&](int y) { predict_row(update.after, guide_, y, out); });
  now_ = 1 - now_;
  camera_before_ = frame.camera;
}

void Wrls::forget() {
  models_[now_].depth_mm.fill(0);
  camera_before_.reset();
  scale_ = 0;
  frame_number_ = 0;
}

void Wrls::resize(int width, int height) {
  const Plane plane(width, height);
  const Planes3 planes{plane, plane, plane};
  const int predictors = options_.feature ? 4 : 1;
  models_[0] = {.p = std::vector<Plane>(predictors * (predictors + 1) / 2, plane),
                .beta = std::vector<Plane>(3 * predictors, plane),
                .z = planes,
                .z_alpha = plane,
                .spread = plane,
                .depth_mm = plane};
  models_[1] = models_[0];
  guide_ = {.colour = planes, .sharpness = plane, .inside = plane};
  guide_.inside.fill(1);
  rows_.resize(height);
  forget();
}

void Wrls::measure_scale(const DenoiseFrame& frame) {
  for_rows(frame.height, [&](int y) { measure_brightness_row(frame, y, rows_[y]); });
  WrlsBrightness sum;
  for (const WrlsBrightness& row : rows_) {
    sum.log2_sum += row.log2_sum;
    sum.count += row.count;
  }
  if (sum.count == 0) return;
  const float scale =
      std::clamp(static_cast<float>(std::exp2(sum.log2_sum / sum.count)), kLeastScale, kGreatestScale);
  if (scale > scale_ * kLargestStep || scale * kLargestStep < scale_) forget();
  scale_ = scale;
}

}  // namespace voxlume
