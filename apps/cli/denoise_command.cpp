#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <memory>

#include "base/parallel.h"
#include "cli/commands.h"
#include "cli/interrupt.h"
#include "cli/output_file.h"
#include "cli/terminal.h"
#include "denoise/denoiser.h"
#include "image_io/image_io.h"
#include "render/file_denoiser.h"
#include "render/frame_files.h"
#include "scene/field_info.h"
#include "voxlume/error.h"

namespace voxlume::cli {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

struct DenoiseRequest {
  std::string input, output, method, frames;
  int threads = 0;
  bool overwrite = false;
};

/// A picture and what is made of it.
struct Step {
  std::string input, output;
};

[[noreturn]] void refuse(const std::string& where, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, where, message);
}

int list_methods() {
  for (const DenoiserKind& kind : denoiser_kinds()) fmt::print("{:16} {}\n", kind.name, kind.summary);
  return kDone;
}

const DenoiserKind& requested_method(const std::string& name) {
  if (name.empty()) return denoiser_kinds().front();
  try {
    return find_denoiser(name);
  } catch (const Error& error) {
    refuse("--method", error.message() + ", or list, which tells them apart");
  }
}

/// The numbers of the frames that are asked for, which must all be there.
FrameRange range_on_disk(const DenoiseRequest& request, const FramePattern& files) {
  const std::vector<int> found = files.frames_on_disk();
  if (found.empty())
    throw Error(ErrorCode::kFileNotFound, request.input,
                "no frame of this name is there, such as " + quote_text(files.path(0).string()));
  const FrameRange range = frame_range(request.frames, {found.front(), found.back()});
  for (int frame = range.first; frame <= range.last; ++frame) {
    if (!std::binary_search(found.begin(), found.end(), frame))
      throw Error(ErrorCode::kFileNotFound, files.path(frame).string(),
                  fmt::format("is missing; frames from {} to {} are expected without a gap, or --frames with "
                              "those to take",
                              range.first, range.last));
  }
  return range;
}

std::vector<Step> steps_of(const DenoiseRequest& request) {
  const bool sequence = FramePattern::is_pattern(request.input);
  if (sequence != FramePattern::is_pattern(request.output))
    refuse("-o", sequence ? "expected a name with #, such as clean-####.exr, for the pictures of a sequence"
                          : "has a # in it, and there is one picture; expected a name without");
  if (!sequence && !request.frames.empty())
    refuse("--frames", "there is one picture; expected INPUT with #, such as frame-####.exr");
  if (!sequence) return {{request.input, request.output}};
  const FramePattern in(request.input, "INPUT"), out(request.output, "-o");
  const FrameRange range = range_on_disk(request, in);
  std::vector<Step> steps;
  for (int frame = range.first; frame <= range.last; ++frame)
    steps.push_back({in.path(frame).string(), out.path(frame).string()});
  return steps;
}

/// Refuses outputs that cannot be written or would replace something, before any work is done for them.
void check_outputs(const DenoiseRequest& request, const std::vector<Step>& steps) {
  std::vector<std::string> inputs;
  for (const Step& step : steps) inputs.push_back(step.input);
  for (const Step& step : steps) {
    check_writable(step.output, "-o");
    if (!fs::exists(step.output)) continue;
    check_not_input(step.output, inputs, "-o");
    if (!request.overwrite) refuse("-o", quote_text(step.output) + " is there; --overwrite replaces it");
  }
}

SequenceProgress progress_at(std::size_t done, std::size_t count, Clock::time_point start) {
  SequenceProgress out;
  out.position = static_cast<int>(done) + 1;
  out.count = static_cast<int>(count);
  if (done > 0) {
    const double elapsed_s = std::chrono::duration<double>(Clock::now() - start).count();
    out.s_per_frame = elapsed_s / static_cast<double>(done);
    out.remaining_s = *out.s_per_frame * static_cast<double>(count - done);
  }
  return out;
}

int denoise(const DenoiseRequest& request) {
  if (request.method == "list") return list_methods();
  if (request.input.empty()) refuse("INPUT", "missing; expected a picture such as frame-####.exr");
  if (request.output.empty()) refuse("-o", "missing; expected a picture to write, such as -o clean-####.exr");
  const DenoiserKind& method = requested_method(request.method);
  picture_format(request.output, "-o");
  const std::vector<Step> steps = steps_of(request);
  check_outputs(request, steps);
  InterruptGuard interrupt;
  const ThreadLimit threads(request.threads);
  FileDenoiser denoiser(method);
  if (method.needs.gradients)
    print_warnings({fmt::format("pictures hold no gradient samples, without which {} is svgf", method.name)});
  ProgressLine progress;
  interrupt.defer();
  const Clock::time_point start = Clock::now();
  for (std::size_t i = 0; i < steps.size(); ++i) {
    if (interrupt.flag()) {
      progress.clear();
      fmt::print(stderr, "interrupted; {} of {} pictures are written; --overwrite does all of them again\n",
                 i, steps.size());
      return kInterrupted;
    }
    progress.show(progress_text(progress_at(i, steps.size(), start)));
    const auto& [input, output] = steps[i];
    save_with_own_scene(denoiser.denoise(read_image(input), input), input, output);
  }
  return kDone;
}

constexpr const char* kNotes = R"(
A sequence is processed in order, each frame with what was learned from those before. Pictures to be denoised
are rendered with --aov denoise. Pictures of other programs lack what decoupled and xu2024 read: take --method
wrls, which needs no layers, or svgf, which needs normal and albedo. PNG is developed as the scene of the
picture says.

Examples:
  voxlume render phantom -o frame-####.exr --turntable 4 --spp 4 --aov denoise
  voxlume denoise frame-####.exr -o clean-####.exr
  voxlume denoise frame-####.exr -o clean-####.png --method svgf --frames 0:24
  voxlume denoise --method list)";

}  // namespace

void add_denoise_command(CLI::App& program, Action& action) {
  CLI::App* const command =
      program.add_subcommand("denoise", "Take the noise out of a picture or a sequence of pictures");
  const auto request = std::make_shared<DenoiseRequest>();
  command->add_option("INPUT", request->input, "Picture, or sequence such as frame-####.exr");
  command->add_option("-o,--output", request->output, "Picture to write, .png or .exr; with # for a sequence")
      ->type_name("OUT");
  command->add_option("--method", request->method, "Which denoiser; list tells them")->type_name("NAME");
  command->add_option("--frames", request->frames, "First and last number of the frames to take; or one")
      ->type_name("A:B");
  command->add_option("--threads", request->threads, "Threads to use; all by default")
      ->type_name("N")
      ->check(CLI::Range(1, 1024));
  command->add_flag("--overwrite", request->overwrite, "Replace pictures that are there");
  command->footer(kNotes);
  command->callback([&action, request] { action = [request] { return denoise(*request); }; });
}

}  // namespace voxlume::cli
