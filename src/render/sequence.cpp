#include "render/sequence.h"

#include <algorithm>
#include <chrono>

#include "image_io/picture_text.h"
#include "render/checkpoint.h"
#include "render/picture.h"
#include "render/statistics.h"
#include "scene/animation.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kDigestText = "voxlume:digest";
/// Frames that a denoiser is shown again before one that follows a gap. What it keeps of older ones is a few
/// percent.
constexpr int kRecalledFrames = 32;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// One call of render_sequence.
class SequenceLoop {
 public:
  SequenceLoop(Session& session, const std::vector<int>& frames, const SequenceOptions& options)
      : session_(session), frames_(frames), options_(options) {}

  RenderStatus run() {
    const std::string& method = session_.description().render.denoise;
    if (method != "none") denoiser_.emplace(method);
    int last = -1;
    for (const int frame : frames_) {
      if (denoiser_ && denoiser_->remembers()) {
        for (int before = std::max(last + 1, frame - kRecalledFrames); before < frame; ++before)
          if (recall(before) == RenderStatus::kCancelled) return RenderStatus::kCancelled;
      }
      if (render(frame) == RenderStatus::kCancelled) return RenderStatus::kCancelled;
      last = frame;
      ++written_;
    }
    return RenderStatus::kDone;
  }

 private:
  /// The options of every frame.
  PictureOptions picture_options(int frame) const {
    PictureOptions picture;
    picture.threads = options_.threads;
    picture.cancel = options_.cancel;
    if (options_.progress)
      picture.progress = [this, frame](const RenderProgress& p) { options_.progress(progress(frame, p)); };
    return picture;
  }

  /// Names the frame in errors that the volume alone brings to light.
  void compile(int frame) {
    SceneDescription scene = session_.frame_description(frame);
    try {
      session_.compile(std::move(scene), [&](double) {
        if (options_.progress) options_.progress(progress(frame, {}));
      });
    } catch (const Error& error) {
      throw Error(error.code(), error.where(), error.message() + " (frame " + std::to_string(frame) + ")");
    }
  }

  /// Shows the denoiser a frame that is there already, or is not asked for.
  RenderStatus recall(int frame) {
    compile(frame);
    const CompiledScene& scene = session_.compiled();
    const PictureSamples samples =
        render_picture(scene, session_.fingerprint(scene.description()), picture_options(frame));
    if (samples.status != RenderStatus::kCancelled) finish_picture(samples.state, scene, {}, {}, &*denoiser_);
    return samples.status;
  }

  RenderStatus render(int frame) {
    const Clock::time_point begin = Clock::now();
    compile(frame);
    const CompiledScene& scene = session_.compiled();
    const double compile_s = seconds_since(begin);
    const fs::path file = options_.files.path(frame);

    PictureOptions picture = picture_options(frame);
    if (is_exr_name(file)) picture.aovs = scene.description().image.aovs;
    picture.checkpoint = checkpoint_path(file);
    picture.resume = options_.resume;
    const PictureSamples samples = render_picture(scene, session_.fingerprint(scene.description()), picture);
    if (samples.status == RenderStatus::kCancelled) return samples.status;

    const double time_s = frame_time_s(*session_.description().animation, frame);
    Image image = finish_picture(samples.state, scene, picture.aovs, FrameStamp{frame, time_s},
                                 denoiser_ ? &*denoiser_ : nullptr);
    image.metadata[kDigestText] = session_.digest(scene.description());
    save_picture(image, scene.description(), file);
    std::error_code ignored;
    fs::remove(picture.checkpoint, ignored);
    if (options_.written) {
      RenderStatistics statistics = statistics_from(samples.state);
      statistics.load_s = compile_s;
      statistics.importance_list_s = scene.importance_list_s();
      statistics.importance_list_bytes = scene.importance_list_bytes();
      options_.written(frame, statistics);
    }
    return samples.status;
  }

  SequenceProgress progress(int frame, const RenderProgress& picture) const {
    SequenceProgress out{frame - options_.range.first + 1, options_.range.count(), picture, {}, {}};
    const double elapsed_s = seconds_since(start_);
    const auto left = static_cast<double>(frames_.size() - written_);
    if (written_ > 0) {
      out.s_per_frame = elapsed_s / (static_cast<double>(written_) + share(picture));
      out.remaining_s = *out.s_per_frame * (left - share(picture));
    } else if (picture.remaining_s) {
      out.remaining_s = *picture.remaining_s + (left - 1) * (picture.elapsed_s + *picture.remaining_s);
    }
    return out;
  }

  /// How much of a picture is done, as far as can be told.
  static double share(const RenderProgress& picture) {
    if (!picture.remaining_s) return 0;
    const double whole_s = picture.elapsed_s + *picture.remaining_s;
    return whole_s > 0 ? picture.elapsed_s / whole_s : 0;
  }

  Session& session_;
  const std::vector<int>& frames_;
  const SequenceOptions& options_;
  std::optional<PictureDenoiser> denoiser_;
  const Clock::time_point start_ = Clock::now();
  std::size_t written_ = 0;
};

}  // namespace

std::vector<int> frames_to_render(const Session& session, const SequenceOptions& options) {
  std::vector<int> frames;
  for (int frame = options.range.first; frame <= options.range.last; ++frame) {
    const SceneDescription scene = session.frame_description(frame);
    const fs::path file = options.files.path(frame);
    if (!fs::exists(file)) {
      frames.push_back(frame);
    } else if (picture_text(file, kDigestText) != session.digest(scene)) {
      throw Error(ErrorCode::kBadParameter, file.string(),
                  "belongs to another scene or other settings; remove it or choose another name");
    }
  }
  return frames;
}

RenderStatus render_sequence(Session& session, const std::vector<int>& frames,
                             const SequenceOptions& options) {
  return SequenceLoop(session, frames, options).run();
}

}  // namespace voxlume
