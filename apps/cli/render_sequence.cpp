#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "cli/commands.h"
#include "cli/render_request.h"
#include "image_io/movie.h"
#include "render/sequence.h"
#include "render/statistics.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;

std::string frames_text(const FrameRange& range) {
  return range.count() == 1 ? fmt::format("frame {}", range.first)
                            : fmt::format("frames {} to {}", range.first, range.last);
}

/// The folder for a movie's frames. Throws Error naming it.
void make_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directory(folder, failed);
  if (!fs::is_directory(folder, failed))
    throw Error(ErrorCode::kBadParameter, "-o",
                "the folder " + quote_text(folder.string()) + " for the movie's frames cannot be made");
}

/// Renders what is missing of `range` to numbered files, in a folder that is made for them if need be.
RenderStatus render_missing(RenderRun& run, const FramePattern& files, const FrameRange& range) {
  std::uint64_t nonfinite_samples = 0;
  nlohmann::json statistics = nlohmann::json::array();
  SequenceOptions options{files, range, run.request.resume, run.request.threads, &run.interrupt.flag(),
                          {},    {}};
  if (run.progress.visible())
    options.progress = [&](const SequenceProgress& p) { run.progress.show(progress_text(p)); };
  options.written = [&](int frame, const RenderStatistics& of_frame) {
    nonfinite_samples += of_frame.nonfinite_samples;
    nlohmann::json entry = to_json(of_frame);
    entry["frame"] = frame;
    for (const char* key :
         {"threads", "simd", "integrator", "total_s", "majorant_build_ms", "seed", "version"})
      entry.erase(key);
    statistics.push_back(std::move(entry));
  };
  run.progress.show("checking every frame's scene");
  const std::vector<int> frames = frames_to_render(*run.session, options);
  if (output_kind(run.request.output) == OutputKind::kMovie) make_folder(files.path(0).parent_path());
  run.interrupt.defer();
  const RenderStatus status = render_sequence(*run.session, frames, options);
  run.progress.clear();
  if (nonfinite_samples > 0)
    print_warnings({fmt::format("{} samples were not finite and counted as black", nonfinite_samples)});
  if (!run.request.stats.empty()) {
    const nlohmann::json all = {{"frames", statistics},
                                {"threads", thread_count()},
                                {"total_s", run.elapsed_s()},
                                {"version", VOXLUME_VERSION}};
    write_file_atomically(run.request.stats, all.dump(2) + "\n");
  }
  return status;
}

int report_interrupted() {
  fmt::print(stderr, "interrupted; the same command with --resume goes on\n");
  return kInterrupted;
}

}  // namespace

int render_frames(RenderRun& run) {
  const RenderRequest& request = run.request;
  const FrameRange range = requested_frames(request, run.session->description());
  const FramePattern files(request.output, "-o");
  if (render_missing(run, files, range) == RenderStatus::kCancelled) return report_interrupted();
  return kDone;
}

int render_movie(RenderRun& run) {
  const RenderRequest& request = run.request;
  const SceneDescription& scene = run.session->description();
  const FrameRange range = requested_frames(request, scene);
  const FramePattern files = movie_frames(request.output);
  const fs::path folder = files.path(0).parent_path();
  if (render_missing(run, files, range) == RenderStatus::kCancelled) return report_interrupted();
  run.progress.show(fmt::format("encoding {} of {}", request.output, frames_text(range)));
  try {
    encode_movie(find_ffmpeg(), {folder, "%06d.png", range.first, range.count(), scene.animation->fps},
                 request.output);
  } catch (const Error& error) {
    run.progress.clear();
    if (run.interrupt.flag()) return report_interrupted();
    throw Error(error.code(), error.where(),
                error.message() + "; its frames are in " + quote_text(folder.string()) +
                    ", and --resume tries again");
  }
  // Only what this program wrote: the folder may hold frames of other parts.
  std::error_code ignored;
  for (int frame = range.first; frame <= range.last; ++frame) fs::remove(files.path(frame), ignored);
  fs::remove(folder, ignored);
  return kDone;
}

}  // namespace voxlume::cli
