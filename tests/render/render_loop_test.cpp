#include "render/render_loop.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <map>
#include <mutex>
#include <numeric>
#include <random>
#include <set>
#include <thread>

#include "render/checkpoint.h"
#include "render/synthetic_trace.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using test::film_bytes;
using test::new_state;
using test::synthetic_trace;

RenderLoopOptions spp_options(int spp, int threads = 0) {
  RenderLoopOptions options;
  options.stop.spp = spp;
  options.threads = threads;
  return options;
}

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(Tiles, CoverEveryPixelOnce) {
  for (const int tile_size : {1, 3, 8, 32, 100}) {
    std::vector<int> covered(37 * 21);
    for (const TileRect& tile : make_tiles(37, 21, tile_size)) {
      EXPECT_LE(tile.width(), tile_size);
      EXPECT_GT(tile.pixel_count(), 0);
      for (int y = tile.y0; y < tile.y1; ++y) {
        for (int x = tile.x0; x < tile.x1; ++x) ++covered[y * 37 + x];
      }
    }
    EXPECT_EQ(std::count(covered.begin(), covered.end(), 1), 37 * 21) << tile_size;
  }
}

TEST(RenderLoop, SameFilmForAnyThreadsTilesAndOrder) {
  const RenderState expected = test::direct_state(45, 31, 21);
  std::mt19937 generator(1);
  for (const int threads : {1, 2, 7}) {
    for (const int tile_size : {1, 7, 16, 32, 64}) {
      RenderState state = new_state(45, 31, tile_size);
      RenderLoopOptions options = spp_options(21, threads);
      options.tile_order.resize(make_tiles(45, 31, tile_size).size());
      std::iota(options.tile_order.begin(), options.tile_order.end(), 0);
      std::shuffle(options.tile_order.begin(), options.tile_order.end(), generator);
      const RenderOutcome outcome = run_render_loop(state, synthetic_trace, options);
      EXPECT_EQ(outcome.status, RenderStatus::kDone);
      EXPECT_EQ(film_bytes(state.film), film_bytes(expected.film))
          << threads << " threads, tiles of " << tile_size;
      EXPECT_EQ(state.counters, expected.counters);
      EXPECT_GT(outcome.wall_s, 0);
      EXPECT_EQ(outcome.wall_s, state.elapsed_s);
    }
  }
}

TEST(RenderLoop, ResumesBitIdenticalFromAnyCut) {
  const RenderState expected = test::direct_state(29, 23, 40);
  const test::TemporaryFolder folder;
  std::mt19937 generator(2);
  int cuts = 0;
  for (int repeat = 0; repeat < 25; ++repeat) {
    RenderState state = new_state(29, 23, std::array{4, 8, 11}[repeat % 3]);
    for (RenderStatus status = RenderStatus::kCancelled; status == RenderStatus::kCancelled;) {
      std::atomic<bool> cancel{false};
      std::atomic<int> calls_left{static_cast<int>(generator() % 150)};
      RenderLoopOptions options = spp_options(40, static_cast<int>(1 + generator() % 4));
      options.cancel = &cancel;
      options.checkpoint = folder / "checkpoint";
      options.fingerprint = "scene";
      const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
        if (calls_left-- <= 0) cancel = true;
        synthetic_trace(tile, begin, end, film, counters);
      };
      status = run_render_loop(state, trace, options).status;
      if (status == RenderStatus::kCancelled) {
        ++cuts;
        const double elapsed_s = state.elapsed_s;
        state = load_checkpoint(options.checkpoint, "scene");
        EXPECT_EQ(state.elapsed_s, elapsed_s);
      }
    }
    EXPECT_EQ(film_bytes(state.film), film_bytes(expected.film)) << "repeat " << repeat;
    EXPECT_EQ(state.counters, expected.counters);
  }
  EXPECT_GT(cuts, 25);
}

TEST(RenderLoop, RunsOfATileFollowOneAnother) {
  RenderState state = new_state(40, 40, 16);
  std::mutex mutex;
  std::map<std::pair<int, int>, int> next;
  const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
    {
      const std::lock_guard lock(mutex);
      EXPECT_EQ((next[{tile.x0, tile.y0}]), begin);
      EXPECT_GT(end, begin);
      next[{tile.x0, tile.y0}] = end;
    }
    synthetic_trace(tile, begin, end, film, counters);
  };
  run_render_loop(state, trace, spp_options(100));
  EXPECT_EQ(next.size(), 9u);
  for (const auto& [tile, end] : next) EXPECT_EQ(end, 100);
}

TEST(RenderLoop, MoreSamplesContinueAFinishedRender) {
  RenderState state = new_state(20, 20, 8);
  run_render_loop(state, synthetic_trace, spp_options(5));
  run_render_loop(state, synthetic_trace, spp_options(13));
  EXPECT_EQ(film_bytes(state.film), film_bytes(test::direct_state(20, 20, 13).film));
  const double elapsed_s = state.elapsed_s;
  EXPECT_EQ(run_render_loop(state, synthetic_trace, spp_options(9)).status, RenderStatus::kDone);
  EXPECT_EQ(state.film.sample_count(3, 3), 13u);
  EXPECT_EQ(state.elapsed_s, elapsed_s);
}

// Luminance 0 or 2 with equal chance: standard error 1/sqrt(n), noise about 1/sqrt(n)/1.01.
void coin_trace(const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
  for (int y = tile.y0; y < tile.y1; ++y) {
    for (int x = tile.x0; x < tile.x1; ++x) {
      for (int s = begin; s < end; ++s) {
        Rng rng(1, 0, static_cast<std::uint32_t>(y * 4096 + x), static_cast<std::uint32_t>(s));
        film.add(x, y, {.radiance = Vec3f(rng.next() < 0.5f ? 0.0f : 2.0f)});
        ++counters.paths;
      }
    }
  }
}

TEST(RenderLoop, NoiseStopsAtThePassThatReachesIt) {
  for (const auto& [noise, spp] : {std::pair{0.30, 16u}, {0.20, 32u}, {0.13, 64u}, {0.105, 96u}}) {
    for (const int threads : {1, 3}) {
      RenderState state = new_state(64, 64, 16);
      RenderLoopOptions options;
      options.stop.noise = noise;
      options.threads = threads;
      EXPECT_EQ(run_render_loop(state, coin_trace, options).status, RenderStatus::kDone);
      EXPECT_EQ(state.film.sample_count(63, 63), spp) << noise;
      EXPECT_EQ(state.film.total_samples(), 64u * 64 * spp);
      EXPECT_LE(state.film.noise(), noise);
    }
  }
}

TEST(RenderLoop, InterruptionDoesNotMoveTheNoiseStop) {
  RenderState state = new_state(64, 64, 16);
  RenderLoopOptions options;
  options.stop.noise = 0.20;
  for (int calls = 3;; calls += 5) {
    std::atomic<bool> cancel{false};
    std::atomic<int> left{calls};
    options.cancel = &cancel;
    const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
      if (left-- <= 0) cancel = true;
      coin_trace(tile, begin, end, film, counters);
    };
    if (run_render_loop(state, trace, options).status == RenderStatus::kDone) break;
  }
  EXPECT_EQ(state.film.total_samples(), 64u * 64 * 32);
}

TEST(RenderLoop, NoiseIsNotTrustedBeforeEightSamples) {
  RenderState state = new_state(8, 8, 8);
  RenderLoopOptions options;
  options.stop.noise = 1e6;
  run_render_loop(state, coin_trace, options);
  EXPECT_EQ(state.film.total_samples(), 64u * 8);
}

TEST(RenderLoop, FirstRuleReachedStops) {
  RenderState state = new_state(32, 32, 16);
  RenderLoopOptions options;
  options.stop = {.spp = 24, .seconds = 100, .noise = 1e-9};
  run_render_loop(state, coin_trace, options);
  EXPECT_EQ(state.film.total_samples(), 32u * 32 * 24);
  options.stop = {.spp = 1000000, .seconds = 100, .noise = 0.20};
  run_render_loop(state, coin_trace, options);
  EXPECT_EQ(state.film.total_samples(), 32u * 32 * 32);
}

void slow_trace(const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
  std::this_thread::sleep_for(std::chrono::milliseconds(2) * (end - begin));
  synthetic_trace(tile, begin, end, film, counters);
}

TEST(RenderLoop, SecondsStopInTimeWithEvenTiles) {
  RenderState state = new_state(64, 64, 16);
  RenderLoopOptions options;
  options.threads = 2;
  options.stop.seconds = 0.5;
  const RenderOutcome outcome = run_render_loop(state, slow_trace, options);
  EXPECT_EQ(outcome.status, RenderStatus::kDone);
  EXPECT_GT(outcome.wall_s, 0.45);
  EXPECT_LT(outcome.wall_s, 1.0);
  std::set<std::uint32_t> counts;
  for (const TileRect& tile : make_tiles(64, 64, 16)) {
    counts.insert(state.film.sample_count(tile.x0, tile.y0));
  }
  EXPECT_GE(*counts.begin(), 2u);
  EXPECT_LE(*counts.rbegin() - *counts.begin(), 8u);
}

TEST(RenderLoop, EveryPixelHasASampleHoweverShortTheTime) {
  RenderState state = new_state(64, 64, 16);
  RenderLoopOptions options;
  options.stop.seconds = 1e-9;
  run_render_loop(state, slow_trace, options);
  for (const TileRect& tile : make_tiles(64, 64, 16)) {
    EXPECT_EQ(state.film.sample_count(tile.x0, tile.y0), 1u);
  }
}

TEST(RenderLoop, SecondsCountOverResumedParts) {
  RenderState state = new_state(16, 16, 16);
  state.elapsed_s = 100;
  RenderLoopOptions options;
  options.stop.seconds = 100;
  const double wall_s = seconds_of([&] { run_render_loop(state, slow_trace, options); });
  EXPECT_LT(wall_s, 5);
  EXPECT_EQ(state.film.sample_count(0, 0), 1u);
}

TEST(RenderLoop, CancelIsSeenSoonInSlowScenes) {
  RenderState state = new_state(320, 320, 16);  // 400 tiles at 2 ms a sample: a long pass takes 13 s
  std::atomic<bool> cancel{false};
  RenderLoopOptions options = spp_options(1000000, 2);
  options.cancel = &cancel;
  std::thread canceller([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    cancel = true;
  });
  RenderOutcome outcome;
  const double wall_s = seconds_of([&] { outcome = run_render_loop(state, slow_trace, options); });
  canceller.join();
  EXPECT_EQ(outcome.status, RenderStatus::kCancelled);
  EXPECT_LT(wall_s, 0.8);
}

TEST(RenderLoop, CancelledBeforeTheStartTracesNothing) {
  RenderState state = new_state(16, 16, 8);
  const std::atomic<bool> cancel{true};
  RenderLoopOptions options = spp_options(4);
  options.cancel = &cancel;
  EXPECT_EQ(run_render_loop(state, synthetic_trace, options).status, RenderStatus::kCancelled);
  EXPECT_EQ(state.film.total_samples(), 0u);
}

TEST(RenderLoop, CheckpointsOnTheWay) {
  const test::TemporaryFolder folder;
  RenderState state = new_state(64, 64, 16);
  RenderLoopOptions options = spp_options(40, 2);
  options.checkpoint = folder / "checkpoint";
  options.fingerprint = "scene";
  options.checkpoint_interval_s = 0.05;
  std::set<std::filesystem::file_time_type> times;
  std::mutex mutex;
  const auto trace = [&](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
    slow_trace(tile, begin, end, film, counters);
    std::error_code none_yet;
    const auto time = std::filesystem::last_write_time(options.checkpoint, none_yet);
    const std::lock_guard lock(mutex);
    if (!none_yet) times.insert(time);
  };
  run_render_loop(state, trace, options);
  EXPECT_GE(times.size(), 3u);
  EXPECT_EQ(film_bytes(state.film), film_bytes(test::direct_state(64, 64, 40).film));
  // The last one is of an earlier moment; going on from it ends the same.
  RenderState resumed = load_checkpoint(options.checkpoint, "scene");
  EXPECT_LT(resumed.film.total_samples(), state.film.total_samples());
  run_render_loop(resumed, synthetic_trace, spp_options(40));
  EXPECT_EQ(film_bytes(resumed.film), film_bytes(state.film));
}

TEST(RenderLoop, ProgressComesFromOneThreadAndEndsAtTheEnd) {
  RenderState state = new_state(64, 64, 16);
  RenderLoopOptions options = spp_options(32, 2);
  std::vector<RenderProgress> seen;
  std::set<std::thread::id> threads;
  options.progress = [&](const RenderProgress& p) {
    seen.push_back(p);
    threads.insert(std::this_thread::get_id());
  };
  const RenderOutcome outcome = run_render_loop(state, slow_trace, options);
  EXPECT_EQ(threads.size(), 1u);
  ASSERT_GE(seen.size(), 2u);
  EXPECT_LE(static_cast<double>(seen.size()), outcome.wall_s * 10 + 2);
  for (std::size_t i = 1; i < seen.size(); ++i) {
    EXPECT_GE(seen[i].spp, seen[i - 1].spp);
    EXPECT_GE(seen[i].elapsed_s, seen[i - 1].elapsed_s);
  }
  EXPECT_EQ(seen.back().spp, 32);
  EXPECT_EQ(seen.back().remaining_s.value(), 0);
  EXPECT_NEAR(seen.back().noise.value(), state.film.noise(), 1e-12);
  EXPECT_GT(seen.back().samples_per_s, 0);
}

TEST(RenderLoop, ExceptionsReachTheCaller) {
  RenderState state = new_state(32, 32, 8);
  const auto bad_trace = [](const TileRect&, int, int, Film&, TraceCounters&) {
    throw std::runtime_error("trace");
  };
  EXPECT_THROW(run_render_loop(state, bad_trace, spp_options(4)), std::runtime_error);
  RenderLoopOptions options = spp_options(20, 1);
  options.progress = [](const RenderProgress&) { throw std::runtime_error("progress"); };
  EXPECT_THROW(run_render_loop(state, slow_trace, options), std::runtime_error);
}

TEST(RenderLoop, RefusesWrongOptions) {
  RenderState state = new_state(32, 32, 16);
  std::vector<RenderLoopOptions> wrong(7);
  wrong[1].stop.spp = 0;
  wrong[2].stop.seconds = 0;
  wrong[3].stop.seconds = std::nan("");
  wrong[4].stop.noise = -1;
  wrong[5] = wrong[6] = spp_options(1);
  wrong[5].tile_order = {0, 1, 2};
  wrong[6].tile_order = {0, 1, 2, 2};
  for (const RenderLoopOptions& options : wrong) {
    EXPECT_THROW(run_render_loop(state, synthetic_trace, options), Error);
  }
  state.tile_size = 0;
  EXPECT_THROW(run_render_loop(state, synthetic_trace, spp_options(1)), Error);
}

}  // namespace
}  // namespace voxlume
