#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/decoupled.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/decoupled_blend-inl.h"
#include "denoise/decoupled_spatial-inl.h"

#if HWY_ONCE
#include <utility>

#include "base/parallel.h"
#include "voxlume/error.h"

namespace voxlume {

HWY_EXPORT(luminance_row);
HWY_EXPORT(variance_row);
HWY_EXPORT(filter_fx_row);
HWY_EXPORT(filter_light_row);
HWY_EXPORT(blend_row);
HWY_EXPORT(filter_light_again_row);
HWY_EXPORT(compose_row);
HWY_EXPORT(restore_row);
HWY_EXPORT(blend_mean_row);

namespace {

/// Depths that differ by this share of the scene's size belong to different things. xu2024 has 2 dm for heads
/// of about 5 dm across.
constexpr float kDepthSigma = 0.4f;
constexpr std::int64_t kRowsAtOnce = 8;

void resize_history(DecoupledHistory& history, int width, int height) {
  for (SampleClass& c : history.classes) {
    c.count = Plane(width, height);
    for (Planes3* planes : {&c.fx_diffuse, &c.fx_specular, &c.fl_diffuse, &c.fl_specular, &c.later})
      *planes = make_planes3(width, height);
  }
  history.alpha = history.depth_mm = history.luminance = Plane(width, height);
}

/// 1 / mean luminance of the light of all samples that scattered, so that nothing depends on its unit.
float inverse_light(const DenoiseFrame& frame, std::vector<double>& row_sums) {
  row_sums.assign(static_cast<std::size_t>(frame.height) * 2, 0);
  parallel_for(frame.height, kRowsAtOnce, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    double light = 0, samples = 0;
    for (const SampleClass& c : *frame.classes) {
      for (int x = 0; x < frame.width; ++x) {
        const float count = c.count.at(x, y);
        if (!(count > 0)) continue;
        const Vec3f l(c.fl_diffuse[0].at(x, y) + c.later[0].at(x, y),
                      c.fl_diffuse[1].at(x, y) + c.later[1].at(x, y),
                      c.fl_diffuse[2].at(x, y) + c.later[2].at(x, y));
        light += count * luminance(l);
        samples += count;
      }
    }
    row_sums[2 * row] = light;
    row_sums[2 * row + 1] = samples;
  });
  double light = 0, samples = 0;
  for (std::size_t i = 0; i < row_sums.size(); i += 2) light += row_sums[i], samples += row_sums[i + 1];
  return light > 0 ? static_cast<float>(samples / light) : 1.0f;
}

}  // namespace

void DecoupledDenoiser::resize(int width, int height) {
  if (now_.alpha.width() == width && now_.alpha.height() == height) return;
  for (std::array<Planes3, 2>* both :
       {&stages_.fx_diffuse, &stages_.fx_specular, &stages_.fl_diffuse, &stages_.fl_specular, &stages_.later})
    for (Planes3& planes : *both) planes = make_planes3(width, height);
  stages_.matter = stages_.residual = make_planes3(width, height);
  stages_.scattered = stages_.variance = stages_.error = Plane(width, height);
  resize_history(now_, width, height);
  resize_history(before_, width, height);
  has_history_ = false;
}

void DecoupledDenoiser::denoise(const DenoiseFrame& frame, DenoisedFrame& out) {
  if (!frame.classes) {
    throw Error(ErrorCode::kBadParameter, "", "the decoupled denoiser needs the classes of samples");
  }
  resize(frame.width, frame.height);
  out.resize(frame.width, frame.height);
  stages_.inverse_depth_sigma = 1 / (kDepthSigma * frame.size_mm);
  stages_.inverse_light = inverse_light(frame, row_sums_);
  const Reprojection* moved =
      has_history_ ? &reproject_(frame.camera, frame.depth_mm, camera_before_) : nullptr;
  const auto for_rows = [&](const auto& body) {
    parallel_for(frame.height, kRowsAtOnce, [&](std::int64_t y) { body(static_cast<int>(y)); });
  };
  make_guides(frame, stages_.guides);
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(luminance_row)(frame, y, stages_.error); });
  local_mean_(stages_.error, stages_.error);
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(variance_row)(frame, stages_.error, y, stages_.variance); });
  local_mean_(stages_.variance, stages_.variance);
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(filter_fx_row)(frame, y, stages_); });
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(filter_light_row)(frame, y, stages_); });
  for_rows([&](int y) {
    HWY_DYNAMIC_DISPATCH(filter_light_again_row)(frame, moved, before_.luminance, y, stages_, now_);
  });
  if (moved != nullptr) local_mean_(stages_.error, stages_.error);
  for_rows([&](int y) { HWY_DYNAMIC_DISPATCH(blend_row)(frame, moved, before_, y, stages_, now_); });
  for_rows([&](int y) {
    HWY_DYNAMIC_DISPATCH(compose_row)(frame, stages_, now_, y, out, stages_.residual, now_.luminance);
  });
  for (Plane& plane : stages_.residual) local_mean_(plane, plane);
  for_rows([&](int y) {
    HWY_DYNAMIC_DISPATCH(restore_row)(frame, stages_.variance, stages_.residual, y, out, stages_.error);
  });
  local_mean_(stages_.error, stages_.error);
  for_rows([&](int y) {
    HWY_DYNAMIC_DISPATCH(blend_mean_row)(frame, stages_.variance, stages_.error, y, out);
  });
  std::swap(now_, before_);
  camera_before_ = frame.camera;
  has_history_ = true;
}

}  // namespace voxlume
#endif  // HWY_ONCE
