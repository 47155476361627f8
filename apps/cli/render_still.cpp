#include <fmt/format.h>

#include <filesystem>

#include "cli/commands.h"
#include "cli/render_request.h"
#include "render/checkpoint.h"
#include "render/picture.h"
#include "render/statistics.h"
#include "scene/animation.h"
#include "scene/field_info.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;

void report_statistics(const RenderRun& run, const RenderState& state, double load_s) {
  RenderStatistics statistics = statistics_from(state);
  if (statistics.nonfinite_samples > 0) {
    print_warnings(
        {fmt::format("{} samples were not finite and counted as black", statistics.nonfinite_samples)});
  }
  if (run.request.stats.empty()) return;
  const CompiledScene& scene = run.session->compiled();
  statistics.load_s = load_s;
  statistics.threads = thread_count();
  statistics.simd = simd_name(scene.view().simd);
  statistics.integrator = enum_word(scene.description().render.integrator);
  statistics.majorant_build_ms = scene.majorant_build_ms();
  statistics.importance_list_s = scene.importance_list_s();
  statistics.importance_list_bytes = scene.importance_list_bytes();
  statistics.seed = scene.description().render.seed;
  statistics.version = VOXLUME_VERSION;
  statistics.total_s = run.elapsed_s();
  write_statistics(statistics, run.request.stats);
}

}  // namespace

int render_still(RenderRun& run) {
  const RenderRequest& request = run.request;
  const CompiledScene& scene = run.session->compiled();
  std::optional<FrameStamp> stamp;
  if (const auto& animation = run.session->description().animation) {
    const int frame = requested_frames(request, run.session->description()).first;
    stamp = {frame, frame_time_s(*animation, frame)};
  }
  // Before the work: it may lack what it needs.
  std::optional<PictureDenoiser> denoiser;
  const std::string& method = scene.description().render.denoise;
  if (method != "none") denoiser.emplace(method);
  PictureOptions options;
  if (is_exr_name(request.output)) options.aovs = scene.description().image.aovs;
  options.threads = request.threads;
  options.checkpoint = checkpoint_path(request.output);
  options.resume = request.resume;
  options.cancel = &run.interrupt.flag();
  if (run.progress.visible()) {
    const ImageDescription& image = scene.description().image;
    options.progress = [&](const RenderProgress& p) {
      run.progress.show(progress_text(p, {image.spp, image.seconds, image.noise}));
    };
  }
  if (request.resume && !fs::exists(options.checkpoint)) {
    fmt::print(stderr, "note: there is no {}; starting from the beginning\n",
               quote_text(options.checkpoint.string()));
  }
  const double load_s = run.elapsed_s();
  run.interrupt.defer();
  const PictureSamples samples =
      render_picture(scene, run.session->fingerprint(scene.description()), options);
  run.progress.clear();
  save_picture(finish_picture(samples.state, scene, options.aovs, stamp, denoiser ? &*denoiser : nullptr),
               scene.description(), request.output);
  report_statistics(run, samples.state, load_s);
  if (samples.status == RenderStatus::kCancelled) {
    fmt::print(stderr, "interrupted; the same command with --resume goes on\n");
    return kInterrupted;
  }
  std::error_code ignored;
  fs::remove(options.checkpoint, ignored);
  return kDone;
}

}  // namespace voxlume::cli
