#include <filesystem>

#include "cli/output_file.h"
#include "cli/render_request.h"
#include "image_io/movie.h"
#include "render/checkpoint.h"
#include "scene/animation.h"
#include "scene/field_info.h"
#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const std::string& flag, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, flag, message);
}

bool same_file(const std::string& a, const std::string& b) {
  return !a.empty() && !b.empty() && fs::absolute(a).lexically_normal() == fs::absolute(b).lexically_normal();
}

void check_picture(const RenderRequest& request, OutputKind kind) {
  bool layers = false;
  if (kind == OutputKind::kMovie) {
    find_ffmpeg();
  } else {
    layers = picture_format(request.output, "-o") == PictureFormat::kExr;
  }
  if (!layers && request.flags.given("--aov")) {
    refuse("--aov", std::string(kind == OutputKind::kMovie ? "a movie" : "a PNG") +
                        " holds no layers; expected -o with a name ending in .exr");
  }
  check_writable(request.output, "-o");
  if (kind == OutputKind::kFrames) FramePattern(request.output, "-o");
}

/// Refuses names that two outputs have.
void check_distinct(const RenderRequest& request, const std::string& checkpoint) {
  for (const auto& [flag, path] :
       {std::pair{"--stats", request.stats}, {"--save-scene", request.save_scene}}) {
    if (same_file(path, request.output) || same_file(path, checkpoint))
      refuse(flag, "has the name of the picture or its checkpoint");
  }
  if (same_file(request.stats, request.save_scene)) refuse("--stats", "has the name of --save-scene");
}

}  // namespace

OutputKind output_kind(const std::string& output) {
  if (is_movie_name(output)) return OutputKind::kMovie;
  return FramePattern::is_pattern(output) ? OutputKind::kFrames : OutputKind::kPicture;
}

void check_outputs(const RenderRequest& request) {
  const bool renders = !request.output.empty();
  if (!renders && request.save_scene.empty())
    refuse("-o", "missing; expected a picture to write, such as -o out.png");
  for (const auto& [flag, given] : {std::pair{"--resume", request.resume},
                                    {"--stats", !request.stats.empty()},
                                    {"--frames", !request.frames.empty()}}) {
    if (!renders && given) refuse(flag, "needs -o: without it nothing is rendered");
  }
  const OutputKind kind = output_kind(request.output);
  if (renders) check_picture(request, kind);
  if (!request.stats.empty()) check_writable(request.stats, "--stats");
  if (!request.save_scene.empty()) check_writable(request.save_scene, "--save-scene");
  const std::string checkpoint = renders ? checkpoint_path(request.output).string() : "";
  check_distinct(request, checkpoint);
  if (kind == OutputKind::kPicture && renders && !request.resume && fs::exists(checkpoint)) {
    refuse("-o", quote_text(checkpoint) +
                     " of an interrupted render is there; --resume goes on from it, or "
                     "remove it to start anew");
  }
}

void check_inputs_kept(const RenderRequest& request, SceneDescription scene) {
  std::vector<std::string> inputs;
  for_each_path(scene, [&](std::string& path) { inputs.push_back(path); });
  check_not_input(request.save_scene, inputs, "--save-scene");
  inputs.push_back(request.input);
  check_not_input(request.output, inputs, "-o");
  check_not_input(request.stats, inputs, "--stats");
}

FrameRange requested_frames(const RenderRequest& request, const SceneDescription& scene) {
  const OutputKind kind = output_kind(request.output);
  if (!scene.animation) {
    if (kind == OutputKind::kPicture)
      refuse("--frames", "nothing moves; expected --turntable or a scene with an animation");
    refuse("-o",
           quote_text(request.output) +
               " is a name for an animation, and nothing moves; expected --turntable or a scene with an "
               "animation, or a name without #");
  }
  const int count = frame_count(*scene.animation);
  const FrameRange range = frame_range(request.frames, {0, count - 1});
  if (kind == OutputKind::kPicture && range.count() != 1) {
    refuse("-o",
           quote_text(request.output) + " is one picture and the scene has " + std::to_string(count) +
               " frames; expected a name such as frame-####.png or movie.mp4, or --frames with one number");
  }
  return range;
}

FramePattern movie_frames(const std::string& movie) {
  return FramePattern(fs::path(movie + ".frames") / "######.png", "-o");
}

void check_frames_absent(const RenderRequest& request, const FramePattern& files, const FrameRange& range) {
  if (request.resume) return;
  for (int frame = range.first; frame <= range.last; ++frame) {
    for (const fs::path& file : {files.path(frame), checkpoint_path(files.path(frame))}) {
      if (!fs::exists(file)) continue;
      refuse("-o", quote_text(file.string()) +
                       " is there; --resume goes on from what is there, or remove it to start anew");
    }
  }
}

}  // namespace voxlume::cli
