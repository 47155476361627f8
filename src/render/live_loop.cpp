#include "render/live_loop.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <utility>

#include "base/parallel.h"
#include "base/progress_parts.h"
#include "integrator/path_tracer.h"
#include "render/film_image.h"
#include "render/fingerprint.h"
#include "tonemap/tone_map.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// Passes over what is important, and their looks, while the view moves: its lists are made for every frame.
constexpr int kMovingRayPasses = 4;
/// What the first pass of a still picture may take [s].
constexpr double kFirstStill_s = 0.5;
/// A still picture is shown again after so many times what showing it takes, but not more often than this.
constexpr double kShowShare = 4, kShowEvery_s = 0.15;

/// The scene without what the film does not depend on.
SceneDescription scene_of_film(SceneDescription scene) {
  scene = scene_of_samples(std::move(scene));
  scene.render.denoise = "none";
  scene.image.aovs.clear();
  return scene;
}

/// Whether points in both scenes look alike but for light: what a denoiser has gathered is of use.
bool same_matter(const SceneDescription& a, const SceneDescription& b) {
  return a.transfer == b.transfer && a.proxies == b.proxies && a.labels == b.labels &&
         a.materials == b.materials && a.material == b.material && a.visibility == b.visibility &&
         a.illustration == b.illustration && a.render == b.render;
}

void clear(RenderState& state) {
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  for (const std::span<std::byte> sums : state.film.accumulators()) {  // some are empty
    const std::size_t blocks = (sums.size() + kBlock - 1) / kBlock;
    parallel_for(static_cast<std::int64_t>(blocks), 1, [&](std::int64_t i) {
      const std::size_t begin = static_cast<std::size_t>(i) * kBlock;
      std::memset(sums.data() + begin, 0, std::min(kBlock, sums.size() - begin));
    });
  }
  state.counters = {};
  state.elapsed_s = 0;
}

/// An empty state, `old` if it is of that kind.
void prepare(std::optional<RenderState>& state, int width, int height, FilmLayers layers) {
  if (state && state->film.width() == width && state->film.height() == height &&
      state->film.layers() == layers) {
    clear(*state);
  } else {
    state.reset();  // before the next takes as much
    state.emplace(RenderState{Film(width, height, layers), {}, 0});
  }
}

}  // namespace

void LiveSession::Loop::run() {
  for (;;) {
    switch (wait()) {
      case Step::kEnd:
        give_up_asides();
        return;
      case Step::kMove:
        attempt([&] { move(); });
        break;
      case Step::kRefine:
        attempt([&] { refine(); });
        break;
      case Step::kAside:
        draw(next_aside());
        break;
    }
  }
}

LiveSession::Loop::Step LiveSession::Loop::wait() {
  std::unique_lock lock(live_.mutex_);
  for (;;) {
    const Wishes& wishes = live_.wishes_;
    if (wishes.ending) return Step::kEnd;
    take_wishes();
    const bool draws = wishes.watched && scene_ && !failed_;
    if (draws && !at_rest() && !still_) return Step::kMove;
    const bool shown = still_ && !on_screen_ && shown_ != Shown::kNot;
    if (draws && !shown) return Step::kRefine;
    if (wishes.watched && !wishes.asides.empty() && (shown || !scene_ || failed_)) return Step::kAside;
    const bool refines = !done_ && !wishes.yielding;
    if (draws && (refines || (shown_ == Shown::kQuickly && at_rest()))) return Step::kRefine;
    if (draws && shown_ == Shown::kQuickly)
      live_.wake_.wait_until(lock, edited_ + rest());
    else
      live_.wake_.wait(lock);
  }
}

// mutex_ is held.
void LiveSession::Loop::take_wishes() {
  Wishes& wishes = live_.wishes_;
  live_.cancel_ = false;
  if (wishes.scene) {
    revision_ = wishes.revision;
    take_scene(std::move(*wishes.scene));
    wishes.scene.reset();
  }
  if (std::exchange(wishes.split_changed, false)) {
    split_ = wishes.split;
    note_edit();
  }
}

void LiveSession::Loop::note_edit() {
  hurried_ = !at_rest();
  edited_ = Clock::now();
  shown_ = Shown::kNot;
}

void LiveSession::Loop::take_scene(SceneDescription scene) {
  scene.animation.reset();
  note_edit();
  framed_ = edited_;
  done_ = false;
  const bool same_film = scene_ && !failed_ && scene_of_film(*scene_) == scene_of_film(scene);
  if (!scene_ || !same_matter(*scene_, scene)) forgets_ = true;
  if (!scene_ || scene_->render.denoise != scene.render.denoise) denoised_.reset();
  scene_ = std::move(scene);
  failed_ = still_compiled_ = false;
  if (same_film && still_) return;
  if (still_) spare_ = std::exchange(still_, std::nullopt);
  on_screen_.reset();
  first_still_spp_ = 0;
}

LiveSession::Loop::Clock::duration LiveSession::Loop::rest() const {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(live_.options_.rest_s));
}

bool LiveSession::Loop::at_rest() const { return Clock::now() - edited_ >= rest(); }

/// Tells of what goes wrong; the scene is then left alone.
template <class Work>
void LiveSession::Loop::attempt(Work&& work) {
  try {
    work();
  } catch (const Cancelled&) {  // the session ends
  } catch (const std::exception& error) {
    failed_ = true;
    still_.reset();
    spare_.reset();
    if (live_.listener_.trouble) live_.listener_.trouble(revision_, error.what());
  }
}

RenderStatus LiveSession::Loop::trace(RenderState& state, const StopRule& stop,
                                      const std::atomic<bool>* cancel, bool tells) const {
  RenderLoopOptions loop;
  loop.stop = stop;
  if (state.film.layers().classes) loop.first_run = std::clamp(stop.spp.value_or(1), 1, kClassifiedTogether);
  loop.threads = live_.options_.threads;
  loop.cancel = cancel;
  if (tells && live_.listener_.progress)
    loop.progress = [this](const RenderProgress& p) { live_.listener_.progress(overall(p)); };
  SceneView view = live_.session_.compiled().view();
  view.keeps_parts = state.film.layers().classes;
  const auto trace_tile = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
    render_tile(view, tile, begin, end, film, counters);
  };
  return run_render_loop(state, trace_tile, loop).status;
}

/// What remains until the scene's own rules, where a pass knows of its own end.
RenderProgress LiveSession::Loop::overall(const RenderProgress& pass) const {
  RenderProgress out = pass;
  out.remaining_s.reset();
  const auto at_most = [&](double s) {
    out.remaining_s = std::max(0.0, std::min(s, out.remaining_s.value_or(s)));
  };
  const ImageDescription& image = scene_->image;
  const double spp_per_s = pass.samples_per_s / image.width / image.height;
  if (image.seconds) at_most(*image.seconds - pass.elapsed_s);
  if (spp_per_s > 0) {
    if (image.spp) at_most((*image.spp - pass.spp) / spp_per_s);
    if (image.noise && pass.noise)
      at_most(pass.spp * (std::pow(*pass.noise / *image.noise, 2) - 1) / spp_per_s);
  }
  return out;
}

void LiveSession::Loop::move() {
  SceneDescription scene = *scene_;
  const FrameSize size = sizes_.next(scene.image.width, scene.image.height);
  scene.image.width = size.width;
  scene.image.height = size.height;
  scene.render.frame += ++drawn_;
  if (scene.visibility)
    scene.visibility->ray_passes = std::min(scene.visibility->ray_passes, kMovingRayPasses);
  spent_ = {};
  still_compiled_ = false;
  spent_.compile_s = seconds_of([&] { compile(std::move(scene), false); });
  prepare(moving_, size.width, size.height, kLayers);
  StopRule stop;
  stop.spp = size.spp;
  spent_.trace_s = seconds_of([&] { trace(*moving_, stop, nullptr, false); });
  const LiveFrame spent = spent_;  // publishing ends its account
  const double rest_s = seconds_of([&] { publish(*moving_, Shown::kQuickly); });
  first_still_spp_ = first_still_spp(size, history_, scene_->image.width);
  sizes_.learn(size, spent.compile_s, spent.trace_s, rest_s);
}

void LiveSession::Loop::compile_still() {
  if (still_compiled_) return;
  spent_.compile_s += seconds_of([&] { compile(*scene_, true); });
  still_compiled_ = true;
}

/// Where it gives way, and when the session ends, it throws Cancelled.
void LiveSession::Loop::compile(SceneDescription scene, bool gives_way) {
  const CancelScope scope(live_.ending_);
  LongWork work(live_.listener_.compiling, live_.options_.patience_s);
  live_.session_.compile(std::move(scene), [&](double share) {
    if (gives_way && live_.cancel_) throw Cancelled();
    work.is_done(share);
  });
  std::vector<std::string> warnings = live_.session_.compiled().warnings();
  if (warnings == warnings_) return;
  warnings_ = std::move(warnings);
  if (live_.listener_.warnings) live_.listener_.warnings(warnings_);
}

/// Throws Cancelled where it gives way.
void LiveSession::Loop::begin_still() {
  const CancelScope scope(live_.cancel_);
  prepare(spare_, scene_->image.width, scene_->image.height, kLayers);
  still_ = std::exchange(spare_, std::nullopt);
}

StopRule LiveSession::Loop::still_stop() const {
  const ImageDescription& image = scene_->image;
  return {image.spp, image.seconds, image.noise};
}

bool LiveSession::Loop::still_done() const {
  if (!still_) return false;
  const StopRule stop = still_stop();
  const int spp = least_samples(*still_);
  return (stop.spp && spp >= *stop.spp) || (stop.seconds && still_->elapsed_s >= *stop.seconds) ||
         (stop.noise && spp >= kNoiseFrom && still_->film.noise() <= *stop.noise);
}

/// Whether the still picture has samples, and enough of them to take the place of a moving one.
bool LiveSession::Loop::still_is_best() const {
  const int spp = least_samples(*still_);
  return spp > 0 && (done_ || spp >= first_still_spp_);
}

/// The count of samples that the next pass ends at; as render_picture's passes do, so that its rules are
/// looked at after the same ones.
int LiveSession::Loop::next_still_spp() const {
  const int at = least_samples(*still_);
  if (at >= 32) return (at / 32 + 1) * 32;
  int end = 1;
  while (end <= at) end *= 2;
  if (at > 0) return end;
  const double pass_s = sizes_.cost().per_sample_s * static_cast<double>(still_->film.pixel_count());
  const int most = scene_->image.noise ? kNoiseFrom : 32;
  while (pass_s > 0 && end < most && 2 * end * pass_s < kFirstStill_s) end *= 2;
  return end;
}

void LiveSession::Loop::refine() {
  try {
    compile_still();
    if (!still_) begin_still();
  } catch (const Cancelled&) {
    return;
  }
  done_ = still_done();
  const bool due = shown_ == Shown::kNot || (shown_ == Shown::kQuickly && at_rest());
  if (due && still_is_best()) {  // samples that an edit has not touched
    publish(*still_, hurried_ && !at_rest() ? Shown::kQuickly : Shown::kWell);
    return;
  }
  if (shown_ == Shown::kNot && on_screen_) show_again();
  if (done_) return;
  StopRule stop = still_stop();
  stop.spp = std::min(next_still_spp(), stop.spp.value_or(1 << 30));
  denoised_.reset();
  RenderStatus status{};
  spent_.trace_s += seconds_of([&] { status = trace(*still_, stop, &live_.cancel_, true); });
  if (status == RenderStatus::kCancelled) return;
  done_ = still_done();
  if (!still_is_best()) return;
  const double since_s = seconds(Clock::now() - framed_);
  if (shown_ == Shown::kNot || on_screen_ || done_ || since_s > std::max(kShowEvery_s, kShowShare * show_s_))
    publish(*still_, Shown::kWell);
}

LiveSession::Aside LiveSession::Loop::next_aside() {
  const std::lock_guard lock(live_.mutex_);
  std::vector<Aside>& asides = live_.wishes_.asides;
  Aside aside = std::move(asides.front());
  asides.erase(asides.begin());
  return aside;
}

void LiveSession::Loop::draw(Aside aside) {
  Image8 picture;
  try {
    still_compiled_ = false;
    live_.session_.compile(aside.scene);
    const ImageDescription& image = aside.scene.image;
    RenderState state{Film(image.width, image.height, {}), {}, 0};
    StopRule stop;
    stop.spp = aside.spp;
    if (trace(state, stop, &live_.cancel_, false) == RenderStatus::kCancelled) {  // and try again later
      const std::lock_guard lock(live_.mutex_);
      live_.wishes_.asides.insert(live_.wishes_.asides.begin(), std::move(aside));
      return;
    }
    const bool transparent = live_.session_.compiled().view().background == BackgroundKind::kTransparent;
    picture = tone_map(image_from_film(state.film, {}, transparent),
                       {image.exposure_ev, image.tone_curve, transparent, false});
  } catch (const std::exception&) {
    picture = {};
  }
  aside.done(std::move(picture));
}

void LiveSession::Loop::give_up_asides() {
  std::vector<Aside> left;
  {
    const std::lock_guard lock(live_.mutex_);
    left.swap(live_.wishes_.asides);
  }
  for (const Aside& aside : left) aside.done({});
}

}  // namespace voxlume
