#include <algorithm>

#include "base/parallel.h"
#include "render/film_image.h"
#include "render/live_loop.h"
#include "tonemap/tone_map.h"

namespace voxlume {
namespace {

std::vector<float> depths(const Film& film) {
  std::vector<float> depth_mm(film.pixel_count());
  for (int y = 0, i = 0; y < film.height(); ++y)
    for (int x = 0; x < film.width(); ++x, ++i)
      depth_mm[static_cast<std::size_t>(i)] = static_cast<float>(film.depth_mm(x, y));
  return depth_mm;
}

/// Columns of `from` left of `end` in place of those of `to`, of the same size.
void copy_columns(const Image& from, int end, Image& to) {
  for (int y = 0; y < to.height; ++y) std::copy_n(from.pixel(0, y), 4 * end, to.pixel(0, y));
}

CameraView camera_lps(const CompiledScene& scene) {
  CameraView camera = scene.view().camera;
  const Double3& o = scene.origin_mm();
  const Vec3f origin(Vec3d(o[0], o[1], o[2]));
  camera.eye_mm += origin;
  camera.target_mm += origin;
  return camera;
}

LiveLimit greatest(const LiveFrame& f) {
  const double most = std::max({f.compile_s, f.trace_s, f.denoise_s, f.develop_s});
  if (f.done) return LiveLimit::kNothing;
  if (f.trace_s == most) return LiveLimit::kTracing;
  if (f.denoise_s == most) return LiveLimit::kDenoising;
  return f.compile_s == most ? LiveLimit::kCompiling : LiveLimit::kDeveloping;
}

}  // namespace

/// The picture of `state`, denoised; that of last time where nothing but its development has changed.
std::shared_ptr<const Image> LiveSession::Loop::picture(const RenderState& state) {
  const CompiledScene& scene = live_.session_.compiled();
  const std::string& method = scene_->render.denoise;
  const bool still = still_ && &state == &*still_;
  if (still && denoised_) {
    auto again = std::make_shared<Image>(*denoised_);
    describe_picture(scene, {}, *again);
    return again;
  }
  if (denoiser_name_ != method) {
    moving_denoiser_.reset();
    still_denoiser_.reset();
  }
  denoiser_name_ = method;
  // Their pictures differ in size, and so do the planes that they keep.
  std::optional<PictureDenoiser>& denoiser = still ? still_denoiser_ : moving_denoiser_;
  if (!denoiser && method != "none") {
    denoiser.emplace(method);
  } else if (denoiser && (still || forgets_)) {
    // The samples of a still picture are those of its last showing and more, not another frame.
    denoiser->forget();
  }
  if (!still) {
    const std::pair size{state.film.width(), state.film.height()};
    const bool goes_on = denoiser && denoiser->remembers() && !forgets_ && size == history_size_;
    history_ = goes_on ? history_ + 1 : 1;
    history_size_ = size;
    forgets_ = false;
  }
  auto out =
      std::make_shared<const Image>(finish_picture(state, scene, {}, {}, denoiser ? &*denoiser : nullptr));
  denoised_ = still ? out : nullptr;
  return out;
}

Image8 LiveSession::Loop::develop(const RenderState& state, const Image& linear) const {
  const bool transparent = live_.session_.compiled().view().background == BackgroundKind::kTransparent;
  const ToneMap tone{scene_->image.exposure_ev, scene_->image.tone_curve, transparent, false};
  if (!split_ || scene_->render.denoise == "none") return tone_map(linear, tone);
  Image shown = linear;
  copy_columns(image_from_film(state.film, {}, transparent),
               std::clamp(static_cast<int>(*split_ * shown.width), 0, shown.width), shown);
  return tone_map(shown, tone);
}

void LiveSession::Loop::publish(const RenderState& state, Shown how) {
  const Clock::time_point begin = Clock::now();
  auto frame = std::make_shared<LiveFrame>(spent_);
  try {
    // A large picture takes its time; one in a hurry is shown whatever comes.
    std::optional<CancelScope> scope;
    if (how == Shown::kWell) scope.emplace(live_.cancel_);
    frame->denoise_s = seconds_of([&] { frame->linear = picture(state); });
    frame->develop_s = seconds_of([&] { frame->picture = develop(state, *frame->linear); });
  } catch (const Cancelled&) {
    return;
  }
  frame->moving = moving_ && &state == &*moving_;
  frame->hurried = !frame->moving && how == Shown::kQuickly;
  frame->done = !frame->moving && !frame->hurried && done_;
  frame->depth_mm = depths(state.film);
  frame->camera = camera_lps(live_.session_.compiled());
  frame->width = scene_->image.width;
  frame->height = scene_->image.height;
  frame->spp =
      static_cast<double>(state.film.total_samples()) / static_cast<double>(state.film.pixel_count());
  if (!frame->moving && frame->spp >= kNoiseFrom) frame->noise = state.film.noise();
  frame->limit = greatest(*frame);
  const bool last = frame->done;
  hand_out(std::move(frame), how);
  show_s_ = seconds(framed_ - begin);
  if (last) still_denoiser_.reset();  // its planes take more than the film
}

/// The moving picture on screen, developed as the scene says now.
void LiveSession::Loop::show_again() {
  auto frame = std::make_shared<LiveFrame>(*on_screen_);
  frame->compile_s = frame->trace_s = frame->denoise_s = 0;
  frame->develop_s = seconds_of([&] { frame->picture = develop(*moving_, *frame->linear); });
  frame->limit = greatest(*frame);
  hand_out(std::move(frame), Shown::kQuickly);
}

void LiveSession::Loop::hand_out(std::shared_ptr<LiveFrame> frame, Shown how) {
  frame->number = ++frames_;
  frame->revision = revision_;
  frame->frame_s = seconds(Clock::now() - framed_);
  shown_ = how;
  on_screen_ = frame->moving ? frame : nullptr;
  if (live_.listener_.frame) live_.listener_.frame(std::move(frame));
  framed_ = Clock::now();
  spent_ = {};
}

}  // namespace voxlume
