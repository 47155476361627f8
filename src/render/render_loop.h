#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "film/film.h"
#include "film/tile.h"
#include "film/trace_counters.h"
#include "voxlume/renderer.h"

namespace voxlume {

/// Traces samples sample_begin <= s < sample_end of every pixel of the tile and adds them to the film, each
/// pixel's in increasing order. Called on several threads, for different tiles. What it adds may depend on
/// pixel and sample alone.
using TraceFunction =
    std::function<void(const TileRect&, int sample_begin, int sample_end, Film&, TraceCounters&)>;

/// All that a render has come to; what a checkpoint holds. The samples taken so far are the film's counts:
/// the pixels of a tile have the same count, and their next sample has that index.
struct RenderState {
  Film film;
  TraceCounters counters;
  double elapsed_s = 0;  ///< first to last sample, without the time between interruption and resumption
  int tile_size = 32;    ///< edge of a tile in pixels, 1..65536
};

/// Samples of the pixels that have fewest: an interrupted pass leaves some with more.
int least_samples(const RenderState& state);

struct RenderLoopOptions {
  StopRule stop;
  /// Samples that the first run of a tile takes at once, at most: those of a pixel are then divided into
  /// classes together (Film::add_classes). 1..kPassCap
  int first_run = 1;
  int threads = 0;                                      ///< 0: all the machine has
  std::vector<int> tile_order;                          ///< a permutation of the tiles; empty: row by row
  std::function<void(const RenderProgress&)> progress;  ///< called by one thread, at most 10 times a second
  const std::atomic<bool>* cancel = nullptr;            ///< set by anyone to stop early
  std::filesystem::path checkpoint;                     ///< empty: none is written
  std::string fingerprint;                              ///< of the scene, for the checkpoint
  double checkpoint_interval_s = 30;
};

struct RenderOutcome {
  RenderStatus status = RenderStatus::kDone;
  double wall_s = 0;  ///< RenderState::elapsed_s at the end
};

/// The tiles of a width x height picture, row by row; those at the right and lower edge are cut.
std::vector<TileRect> make_tiles(int width, int height, int tile_size);

/// Adds samples to `state` until a stop rule is reached or the caller cancels.
///
/// Work is done in passes that bring every tile to the same count: 1, 2, 4, 8, 16, 32, 64, 96, ... samples.
/// Within a pass a tile advances in runs of samples short enough that cancellation and the time limit are
/// seen within a fraction of a second, and is left with whole samples. Passes and runs are scheduling only:
/// the film's sums are the same for any threads, tile size, tile order and interruptions, and so is the
/// outcome of the spp and noise rules.
///
/// With a checkpoint path the state is saved there every interval and on cancellation.
/// Throws Error kBadParameter for a wrong option, and whatever `trace`, `progress` and the checkpoint throw.
RenderOutcome run_render_loop(RenderState& state, const TraceFunction& trace,
                              const RenderLoopOptions& options);

}  // namespace voxlume
