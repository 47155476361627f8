#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "cli/interrupt.h"
#include "cli/scene_flags.h"
#include "cli/terminal.h"
#include "render/frame_files.h"
#include "render/session.h"

namespace voxlume::cli {

/// What the user asked `voxlume render` for.
struct RenderRequest {
  std::string input, output, stats, save_scene;
  std::string frames;  ///< as written: "A:B" with either side optional, or "A"; empty: all
  int threads = 0;
  bool resume = false;
  SceneFlags flags;
};

enum class OutputKind { kPicture, kFrames, kMovie };

/// What the name of the output stands for: frame-####.png, movie.mp4, or a single picture.
OutputKind output_kind(const std::string& output);

/// Refuses outputs that cannot be written, before any work is done for them. `output` may be empty.
void check_outputs(const RenderRequest& request);

/// Refuses outputs that would overwrite what the picture is made from. The scene file alone may be written
/// back.
void check_inputs_kept(const RenderRequest& request, SceneDescription scene);

/// The frames that --frames means, out of those of the scene's animation. Throws Error naming the flag or the
/// output where the scene is still.
FrameRange requested_frames(const RenderRequest& request, const SceneDescription& scene);

/// One run of `voxlume render`, from reading to writing.
struct RenderRun {
  explicit RenderRun(const RenderRequest& r) : request(r), threads(r.threads) {}

  double elapsed_s() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  }

  const RenderRequest& request;
  const std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
  InterruptGuard interrupt;
  ThreadLimit threads;
  ProgressLine progress;
  std::optional<Session> session;
};

// Each renders the scene of run.session to the request's output and returns an exit code.
int render_still(RenderRun& run);
/// To numbered pictures.
int render_frames(RenderRun& run);
int render_movie(RenderRun& run);

/// Refuses frames of the range, or checkpoints of them, that are there already, unless the request is to go
/// on from them.
void check_frames_absent(const RenderRequest& request, const FramePattern& files, const FrameRange& range);
/// The pictures that a movie is made of, in a folder beside it.
FramePattern movie_frames(const std::string& movie);

}  // namespace voxlume::cli
