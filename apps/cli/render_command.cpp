#include <memory>

#include "cli/commands.h"
#include "cli/output_file.h"
#include "cli/render_request.h"
#include "scene/open_volume.h"
#include "scene/scene_file.h"
#include "scene/validate.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

/// The scene of the input under the flags, not resolved.
SceneDescription requested_scene(const RenderRequest& request) {
  SceneDescription scene = scene_of_input(request.input);
  request.flags.apply(scene);
  validate_scene(scene, request.input + ": /");
  return scene;
}

/// Refuses what the scene's animation and the outputs make impossible together.
void check_animation_output(const RenderRequest& request, const SceneDescription& scene) {
  if (request.output.empty()) return;
  const OutputKind kind = output_kind(request.output);
  if (kind == OutputKind::kPicture && !scene.animation && request.frames.empty()) return;
  const FrameRange range = requested_frames(request, scene);
  if (kind == OutputKind::kFrames) check_frames_absent(request, FramePattern(request.output, "-o"), range);
  if (kind == OutputKind::kMovie) {
    check_frames_absent(request, movie_frames(request.output), range);
    if (scene.background && scene.background->kind == BackgroundKind::kTransparent)
      throw Error(ErrorCode::kBadParameter, "-o",
                  "a movie has no transparency; expected another background, or -o with frame-####.png");
  }
}

/// Reads and compiles; says what is going on and what is odd.
void load(RenderRun& run, const SceneDescription& scene) {
  run.progress.show("reading " + scene.volume.path);
  Volume volume = open_volume(scene.volume, run.progress.of("reading " + scene.volume.path));
  run.progress.clear();
  print_warnings(volume.warnings);
  run.progress.show("preparing");
  Session& session = run.session.emplace(scene, std::move(volume), run.progress.of("preparing"));
  const bool frame = scene.animation && !run.request.output.empty();
  session.compile(
      frame ? session.frame_description(requested_frames(run.request, scene).first) : session.description(),
      run.progress.of("looking for what is important"));
  run.progress.clear();
  print_warnings(session.compiled().warnings());
}

int render(const RenderRequest& request) {
  check_outputs(request);
  const SceneDescription scene = requested_scene(request);
  check_inputs_kept(request, scene);
  with_scene_name(request.input, [&] { check_animation_output(request, scene); });
  RenderRun run(request);
  int code = kDone;
  with_scene_name(request.input, [&] {
    load(run, scene);
    if (!request.save_scene.empty()) save_scene(run.session->description(), request.save_scene);
    if (request.output.empty()) return;
    const OutputKind kind = output_kind(request.output);
    code = kind == OutputKind::kPicture  ? render_still(run)
           : kind == OutputKind::kFrames ? render_frames(run)
                                         : render_movie(run);
  });
  return code;
}

constexpr const char* kNotes = R"(
Flags override the scene's fields. The first of --spp, --seconds and --noise that is reached ends the render.
An interrupted render (Ctrl-C) writes the picture so far and OUT.checkpoint; the same command with --resume
goes on from there, bit for bit. Without -o, --save-scene writes the scene and nothing is rendered.
An animated scene, or --turntable, is written to numbered pictures (-o frame-####.png, or .exr) or to a movie
(-o movie.mp4 or .webm, by ffmpeg), whose frames lie in OUT.frames until it is complete.

Examples:
  voxlume render phantom -o head.png --preset ct-skin --camera 30,10,1.2
  voxlume render head-ct.nrrd -o bone.exr --noise 0.02 --aov depth,normal --background transparent
  voxlume render block.bin --raw 256x256x108,i16,0.957,0.957,1.5 -o block.png --clip :,:,0:80
  voxlume render head-ct.nrrd -o head.mp4 --turntable 6 --fps 24 --size 640x640)";

}  // namespace

void add_render_command(CLI::App& program, Action& action) {
  CLI::App* const command = program.add_subcommand("render", "Render a volume or scene to a picture");
  const auto request = std::make_shared<RenderRequest>();
  command->add_option("INPUT", request->input, "Volume file, DICOM folder, scene (.json) or \"phantom\"")
      ->required();
  command
      ->add_option("-o,--output", request->output,
                   "Picture to write, .png or .exr; frame-####.png or movie.mp4 of an animation")
      ->type_name("OUT");
  request->flags.add_to(*command);
  command->add_option("--threads", request->threads, "Threads to use; all by default")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--resume", request->resume, "Go on from OUT.checkpoint or the frames that are there");
  command
      ->add_option("--frames", request->frames,
                   "First and last frame of an animation, counted from 0; or one")
      ->type_name("A:B");
  command->add_option("--stats", request->stats, "Write statistics of the render as JSON")->type_name("FILE");
  command->add_option("--save-scene", request->save_scene, "Write the scene with everything chosen in it")
      ->type_name("FILE");
  command->footer(kNotes);
  command->callback([&action, request] { action = [request] { return render(*request); }; });
}

}  // namespace voxlume::cli
