#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <optional>

#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/output_file.h"
#include "cli/picture.h"
#include "cli/scene_flags.h"
#include "cli/terminal.h"
#include "grid/volume_statistics.h"
#include "integrator/path_tracer.h"
#include "render/checkpoint.h"
#include "render/film_image.h"
#include "render/statistics.h"
#include "scene/compile.h"
#include "scene/field_info.h"
#include "scene/open_volume.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "scene/validate.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// What the user asked for.
struct RenderRequest {
  std::string input, output, stats, save_scene;
  int threads = 0;
  bool resume = false;
  SceneFlags flags;
};

/// Refuses outputs that cannot be written, before any work is done for them.
void check_outputs(const RenderRequest& request) {
  if (request.output.empty() && request.save_scene.empty()) {
    throw Error(ErrorCode::kBadParameter, "-o", "missing; expected a picture to write, such as -o out.png");
  }
  if (request.output.empty() && (!request.stats.empty() || request.resume)) {
    throw Error(ErrorCode::kBadParameter, request.resume ? "--resume" : "--stats",
                "needs -o: without it nothing is rendered");
  }
  if (!request.output.empty()) {
    const PictureFormat format = picture_format(request.output, "-o");
    if (format == PictureFormat::kPng && request.flags.given("--aov")) {
      throw Error(ErrorCode::kBadParameter, "--aov",
                  "a PNG holds no layers; expected -o with a name ending in .exr");
    }
    check_writable(request.output, "-o");
  }
  if (!request.stats.empty()) check_writable(request.stats, "--stats");
  if (!request.save_scene.empty()) check_writable(request.save_scene, "--save-scene");
  const auto same = [](const std::string& a, const std::string& b) {
    return !a.empty() && !b.empty() &&
           fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal();
  };
  const std::string checkpoint = request.output.empty() ? "" : checkpoint_path(request.output).string();
  for (const auto& [flag, path] :
       {std::pair{"--stats", request.stats}, {"--save-scene", request.save_scene}}) {
    if (same(path, request.output) || same(path, checkpoint))
      throw Error(ErrorCode::kBadParameter, flag, "has the name of the picture or its checkpoint");
  }
  if (same(request.stats, request.save_scene))
    throw Error(ErrorCode::kBadParameter, "--stats", "has the name of --save-scene");
  if (!checkpoint.empty() && !request.resume && fs::exists(checkpoint)) {
    throw Error(ErrorCode::kBadParameter, "-o",
                quote_text(checkpoint) +
                    " of an interrupted render is there; --resume goes on from it, or "
                    "remove it to start anew");
  }
}

/// Refuses outputs that would overwrite what the picture is made from. The scene file alone may be written
/// back.
void check_inputs_kept(const RenderRequest& request, SceneDescription scene) {
  std::vector<std::string> inputs;
  for_each_path(scene, [&](std::string& path) { inputs.push_back(path); });
  check_not_input(request.save_scene, inputs, "--save-scene");
  inputs.push_back(request.input);
  check_not_input(request.output, inputs, "-o");
  check_not_input(request.stats, inputs, "--stats");
}

/// The scene of the input under the flags, not resolved.
SceneDescription requested_scene(const RenderRequest& request) {
  SceneDescription scene = scene_of_input(request.input);
  request.flags.apply(scene);
  validate_scene(scene, request.input + ": /");
  return scene;
}

StopRule stop_rule(const ImageDescription& image) { return {image.spp, image.seconds, image.noise}; }

/// One run of `voxlume render`, from reading to writing.
class RenderRun {
 public:
  RenderRun(const RenderRequest& request, SceneDescription scene)
      : request_(request), threads_(request.threads), scene_(std::move(scene)) {
    with_scene_name(request.input, [this] { load(); });
    if (!request.save_scene.empty()) save_scene(compiled_->description(), request.save_scene);
  }

  int render() {
    const SceneDescription& scene = compiled_->description();
    aovs_ = picture_format(request_.output, "-o") == PictureFormat::kExr ? scene.image.aovs
                                                                         : std::vector<std::string>{};
    const fs::path checkpoint = checkpoint_path(request_.output);
    const std::string fingerprint = scene_fingerprint(scene, compiled_->volume(), statistics_);
    RenderState state = start_state(checkpoint, fingerprint);

    RenderLoopOptions options;
    options.stop = stop_rule(scene.image);
    options.threads = request_.threads;
    options.cancel = &interrupt_.flag();
    options.checkpoint = checkpoint;
    options.fingerprint = fingerprint;
    if (progress_.visible()) {
      options.progress = [&](const RenderProgress& p) { progress_.show(progress_text(p, options.stop)); };
    }
    load_s_ = seconds_since(start_);
    interrupt_.defer();
    const RenderOutcome outcome = run_render_loop(state, tracer(), options);
    progress_.clear();
    write_results(state);
    if (outcome.status == RenderStatus::kCancelled) {
      fmt::print(stderr, "interrupted; the same command with --resume goes on\n");
      return kInterrupted;
    }
    std::error_code ignored;
    fs::remove(checkpoint, ignored);
    return kDone;
  }

 private:
  void load() {
    progress_.show("reading " + scene_.volume.path);
    Volume volume = open_volume(scene_.volume);
    progress_.clear();
    print_warnings(volume.warnings);
    progress_.show("preparing");
    statistics_ = compute_statistics(make_grid_view(volume));
    SceneDescription resolved = resolve(scene_, volume, statistics_);
    compiled_.emplace(std::move(resolved), std::move(volume), statistics_);
    progress_.clear();
    print_warnings(compiled_->warnings());
  }

  RenderState start_state(const fs::path& checkpoint, const std::string& fingerprint) const {
    if (request_.resume) {
      if (fs::exists(checkpoint)) return load_checkpoint(checkpoint, fingerprint);
      fmt::print(stderr, "note: there is no {}; starting from the beginning\n",
                 quote_text(checkpoint.string()));
    }
    const ImageDescription& image = compiled_->description().image;
    return {Film(image.width, image.height, film_layers(aovs_)), {}, 0};
  }

  TraceFunction tracer() const {
    return [this](const TileRect& tile, int begin, int end, Film& film, TraceCounters& counters) {
      render_tile(compiled_->view(), tile, begin, end, film, counters);
    };
  }

  void write_results(const RenderState& state) const {
    write_picture(state.film, aovs_, compiled_->description(), request_.output);
    RenderStatistics statistics = statistics_from(state);
    if (statistics.nonfinite_samples > 0) {
      print_warnings(
          {fmt::format("{} samples were not finite and counted as black", statistics.nonfinite_samples)});
    }
    if (request_.stats.empty()) return;
    statistics.load_s = load_s_;
    statistics.threads = thread_count();
    statistics.simd = simd_name(compiled_->view().simd);
    statistics.majorant_build_ms = compiled_->majorant_build_ms();
    statistics.seed = compiled_->description().render.seed;
    statistics.version = VOXLUME_VERSION;
    statistics.total_s = seconds_since(start_);
    write_statistics(statistics, request_.stats);
  }

  const RenderRequest& request_;
  const Clock::time_point start_ = Clock::now();
  InterruptGuard interrupt_;
  ThreadLimit threads_;
  ProgressLine progress_;
  SceneDescription scene_;
  VolumeStatistics statistics_;
  std::optional<CompiledScene> compiled_;
  std::vector<std::string> aovs_;
  double load_s_ = 0;
};

int render(const RenderRequest& request) {
  check_outputs(request);
  const SceneDescription scene = requested_scene(request);
  check_inputs_kept(request, scene);
  RenderRun run(request, scene);
  return request.output.empty() ? kDone : run.render();
}

constexpr const char* kNotes = R"(
Flags override the scene's fields. The first of --spp, --seconds and --noise that is reached ends the render.
An interrupted render (Ctrl-C) writes the picture so far and OUT.checkpoint; the same command with --resume
goes on from there, bit for bit. Without -o, --save-scene writes the scene and nothing is rendered.

Examples:
  voxlume render phantom -o head.png --preset ct-skin --camera 30,10,1.2
  voxlume render head-ct.nrrd -o bone.exr --noise 0.02 --aov depth,normal --background transparent
  voxlume render block.bin --raw 256x256x108,i16,0.957,0.957,1.5 -o block.png --clip :,:,0:80)";

}  // namespace

void add_render_command(CLI::App& program, Action& action) {
  CLI::App* const command = program.add_subcommand("render", "Render a volume or scene to a picture");
  const auto request = std::make_shared<RenderRequest>();
  command->add_option("INPUT", request->input, "Volume file, DICOM folder, scene (.json) or \"phantom\"")
      ->required();
  command->add_option("-o,--output", request->output, "Picture to write, .png or .exr")->type_name("OUT");
  request->flags.add_to(*command);
  command->add_option("--threads", request->threads, "Threads to use; all by default")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--resume", request->resume, "Go on from OUT.checkpoint, if it is there");
  command->add_option("--stats", request->stats, "Write statistics of the render as JSON")->type_name("FILE");
  command->add_option("--save-scene", request->save_scene, "Write the scene with everything chosen in it")
      ->type_name("FILE");
  command->footer(kNotes);
  command->callback([&action, request] { action = [request] { return render(*request); }; });
}

}  // namespace voxlume::cli
