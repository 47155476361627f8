#include "render/render_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>

#include "base/parallel.h"
#include "render/checkpoint.h"
#include "render/progress_reporter.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMaxSamples = std::numeric_limits<int>::max();
constexpr int kMaxTileSize = 65536;
constexpr int kPassCap = 32;          // samples a tile gains in the longest pass
constexpr int kNoiseFromSamples = 8;  // fewer make the standard error itself too uncertain
constexpr double kRunSeconds = 0.1;   // what one call of the trace function should take

double seconds_between(Clock::time_point begin, Clock::time_point end) {
  return std::chrono::duration<double>(end - begin).count();
}

[[noreturn]] void fail_option(const std::string& message) {
  throw Error(ErrorCode::kBadParameter, "", message);
}

void check_options(const RenderState& state, const RenderLoopOptions& options, std::size_t tile_count) {
  const StopRule& stop = options.stop;
  if (!stop.spp && !stop.seconds && !stop.noise) {
    fail_option("nothing says when to stop; expected spp, seconds or noise");
  }
  if (stop.spp && *stop.spp < 1) fail_option("spp " + std::to_string(*stop.spp) + "; expected at least 1");
  if (stop.seconds && !(*stop.seconds > 0)) {
    fail_option("seconds " + std::to_string(*stop.seconds) + "; expected more than 0");
  }
  if (stop.noise && !(*stop.noise > 0)) {
    fail_option("noise " + std::to_string(*stop.noise) + "; expected more than 0");
  }
  if (state.tile_size < 1 || state.tile_size > kMaxTileSize) {
    fail_option("tile size " + std::to_string(state.tile_size) + "; expected 1 to " +
                std::to_string(kMaxTileSize));
  }
  if (options.tile_order.empty()) return;
  std::vector<int> sorted = options.tile_order;
  std::sort(sorted.begin(), sorted.end());
  bool permutation = sorted.size() == tile_count;
  for (std::size_t i = 0; permutation && i < tile_count; ++i) permutation = sorted[i] == static_cast<int>(i);
  if (!permutation) {
    fail_option("the tile order is not a permutation of the " + std::to_string(tile_count) + " tiles");
  }
}

// The count to which a pass brings every tile that has `samples` or more.
int pass_end(int samples) {
  if (samples >= kMaxSamples - kPassCap) return kMaxSamples;
  if (samples >= kPassCap) return (samples / kPassCap + 1) * kPassCap;
  int end = 1;
  while (end <= samples) end *= 2;
  return end;
}

bool is_pass_end(int samples) { return samples > 0 && pass_end(samples - 1) == samples; }

// One call of run_render_loop.
class Loop {
 public:
  Loop(RenderState& state, const TraceFunction& trace, const RenderLoopOptions& options)
      : state_(state),
        trace_(trace),
        options_(options),
        tiles_(make_tiles(state.film.width(), state.film.height(), std::max(state.tile_size, 1))),
        pixel_count_(static_cast<double>(state.film.pixel_count())),
        initial_samples_(static_cast<double>(state.film.total_samples())),
        initial_elapsed_s_(state.elapsed_s) {
    check_options(state, options, tiles_.size());
    for (const TileRect& tile : tiles_) {
      counts_.push_back(static_cast<int>(state.film.sample_count(tile.x0, tile.y0)));
    }
  }

  RenderOutcome run() {
    const ThreadLimit limit(options_.threads);
    start_ = Clock::now();
    checkpoint_saved_ = start_;
    ProgressReporter reporter(options_.progress, [this] { return progress(); });
    const RenderStatus status = run_passes(reporter);
    if (status == RenderStatus::kCancelled && !options_.checkpoint.empty()) save();
    reporter.finish();
    return {status, state_.elapsed_s};
  }

 private:
  RenderStatus run_passes(const ProgressReporter& reporter) {
    for (;;) {
      const auto [least, most] = std::minmax_element(counts_.begin(), counts_.end());
      least_ = *least;
      const bool whole = *least == *most;
      if (whole && least_ >= kNoiseFromSamples && is_pass_end(least_)) measure_noise();
      if (done(whole)) return RenderStatus::kDone;
      if (cancelled() || reporter.failed()) return RenderStatus::kCancelled;
      if (checkpoint_due()) save();
      run_pass(next_target());
    }
  }

  void measure_noise() {
    if (!options_.stop.noise && !options_.progress) return;
    noise_ = state_.film.noise();
    noise_samples_ = least_;
  }

  bool done(bool whole) const {
    const StopRule& stop = options_.stop;
    if (least_ == kMaxSamples || (stop.spp && least_ >= *stop.spp)) return true;
    if (stop.noise && whole && noise_samples_ == least_ && noise_ <= *stop.noise) return true;
    return time_over();
  }

  bool cancelled() const {
    return options_.cancel != nullptr && options_.cancel->load(std::memory_order_relaxed);
  }

  // Every pixel has a sample, whatever the limit.
  bool time_over() const {
    return options_.stop.seconds && least_ > 0 && elapsed_s() >= *options_.stop.seconds;
  }

  bool checkpoint_due() const {
    // The floor leaves time to go on between two checkpoints.
    return !options_.checkpoint.empty() &&
           seconds_between(checkpoint_saved_, Clock::now()) >= std::max(options_.checkpoint_interval_s, 0.01);
  }

  void save() {
    save_checkpoint(state_, options_.fingerprint, options_.checkpoint);
    checkpoint_saved_ = Clock::now();
  }

  double elapsed_s() const { return initial_elapsed_s_ + seconds_between(start_, Clock::now()); }

  int next_target() const {
    int target = least_ == 0 ? options_.first_run : pass_end(least_);
    if (options_.stop.spp) target = std::min(target, *options_.stop.spp);
    if (options_.stop.seconds && traced_ > 0) {
      // Short passes toward the end, so that tiles differ little when time is over.
      const double rate = static_cast<double>(traced_) / seconds_between(start_, Clock::now());
      const double affordable = std::max(0.0, *options_.stop.seconds - elapsed_s()) * rate / pixel_count_;
      target = std::min(target, least_ + static_cast<int>(std::clamp(affordable, 1.0, double{kPassCap})));
    }
    return target;
  }

  void run_pass(int target) {
    parallel_for(static_cast<std::int64_t>(tiles_.size()), 1, [&](std::int64_t i) {
      advance_tile(options_.tile_order.empty() ? static_cast<int>(i) : options_.tile_order[i], target);
    });
    state_.elapsed_s = elapsed_s();
  }

  void advance_tile(int tile, int target) {
    while (counts_[tile] < target && !cancelled() && !time_over() && !checkpoint_due()) {
      const bool first = counts_[tile] == 0;
      const int run = first ? target : std::min(target - counts_[tile], run_length(tiles_[tile]));
      TraceCounters counters;
      const Clock::time_point begin = Clock::now();
      trace_(tiles_[tile], counts_[tile], counts_[tile] + run, state_.film, counters);
      counts_[tile] += run;
      traced_ += static_cast<std::uint64_t>(run) * tiles_[tile].pixel_count();
      busy_ns_ += std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin).count();
      const std::lock_guard lock(counters_mutex_);
      state_.counters += counters;
    }
  }

  // Samples per pixel that a tile should take in one go; 1 while the speed is not known.
  int run_length(const TileRect& tile) const {
    const double samples = static_cast<double>(traced_), busy_s = static_cast<double>(busy_ns_) * 1e-9;
    if (samples == 0) return 1;
    if (busy_s == 0) return kPassCap;
    const double run = kRunSeconds * samples / busy_s / tile.pixel_count();
    return static_cast<int>(std::clamp(run, 1.0, double{kPassCap}));
  }

  // Called by the reporter's thread while others trace.
  RenderProgress progress() const {
    RenderProgress p;
    const double traced = static_cast<double>(traced_), session_s = seconds_between(start_, Clock::now());
    p.spp = (initial_samples_ + traced) / pixel_count_;
    p.elapsed_s = initial_elapsed_s_ + session_s;
    p.samples_per_s = session_s > 0 ? traced / session_s : 0;
    if (noise_ >= 0) p.noise = noise_;
    const auto at_most = [&](double seconds) {
      p.remaining_s = std::max(0.0, std::min(seconds, p.remaining_s.value_or(seconds)));
    };
    const StopRule& stop = options_.stop;
    if (stop.seconds) at_most(*stop.seconds - p.elapsed_s);
    if (p.samples_per_s > 0) {
      const double spp_per_s = p.samples_per_s / pixel_count_;
      if (stop.spp) at_most((*stop.spp - p.spp) / spp_per_s);
      // The standard error falls with the square root of the number of samples.
      if (stop.noise && p.noise) {
        const double ratio = *p.noise / *stop.noise;
        at_most((noise_samples_ * ratio * ratio - p.spp) / spp_per_s);
      }
    }
    return p;
  }

  RenderState& state_;
  const TraceFunction& trace_;
  const RenderLoopOptions& options_;
  const std::vector<TileRect> tiles_;
  const double pixel_count_, initial_samples_, initial_elapsed_s_;
  std::vector<int> counts_;  // samples of each tile's pixels
  int least_ = 0;            // of counts_, before the pass
  Clock::time_point start_, checkpoint_saved_;
  std::mutex counters_mutex_;
  std::atomic<std::uint64_t> traced_{0};  // samples of this call
  std::atomic<std::int64_t> busy_ns_{0};  // time inside the trace function, over all threads
  std::atomic<double> noise_{-1};         // as last measured; negative before
  std::atomic<int> noise_samples_{-1};    // samples per pixel at which it was measured
};

}  // namespace

int least_samples(const RenderState& state) {
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
  for (const TileRect& tile : make_tiles(state.film.width(), state.film.height(), state.tile_size))
    least = std::min(least, state.film.sample_count(tile.x0, tile.y0));
  return static_cast<int>(least);
}

std::vector<TileRect> make_tiles(int width, int height, int tile_size) {
  std::vector<TileRect> tiles;
  for (int y = 0; y < height; y += tile_size) {
    for (int x = 0; x < width; x += tile_size) {
      tiles.push_back({x, y, std::min(x + tile_size, width), std::min(y + tile_size, height)});
    }
  }
  return tiles;
}

RenderOutcome run_render_loop(RenderState& state, const TraceFunction& trace,
                              const RenderLoopOptions& options) {
  return Loop(state, trace, options).run();
}

}  // namespace voxlume
