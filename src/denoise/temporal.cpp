#include "denoise/temporal.h"

#include <utility>

#include "base/parallel.h"
#include "denoise/temporal_row.h"

namespace voxlume {

void TemporalMeans::resize(int width, int height) {
  if (alpha.width() == width && alpha.height() == height) return;
  alpha = first = second = frames = Plane(width, height);
}

void TemporalHistory::blend(const DenoiseFrame& frame, const Guides& guides, const Signal& colors,
                            const Plane* change, Signal& out) {
  const int width = frame.width, height = frame.height;
  if (now_.alpha.width() != width || now_.alpha.height() != height) {
    known_ = false;
    alpha_counts_ = Plane(width, height);
  }
  std::swap(now_, before_);
  now_.resize(width, height);
  out.resize(width, height);
  const Reprojection* moved = known_ ? &reproject_(frame.camera, guides.depth_mm, camera_before_) : nullptr;
  const TemporalInput input{frame, guides, guides_before_, moved, before_, colors, change};
  parallel_for(height, 8,
               [&](std::int64_t y) { blend_row(input, static_cast<int>(y), now_, alpha_counts_, out); });
  parallel_for(height, 8, [&](std::int64_t y) {
    spatial_variance_row(now_, guides, static_cast<int>(y), out.variance);
  });
}

void TemporalHistory::keep(const DenoiseFrame& frame, Guides& guides) {
  std::swap(guides, guides_before_);
  camera_before_ = frame.camera;
  known_ = true;
}

}  // namespace voxlume
