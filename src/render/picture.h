#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "render/picture_denoiser.h"
#include "render/render_loop.h"
#include "scene/compile.h"
#include "voxlume/image.h"

namespace voxlume {

struct PictureOptions {
  std::vector<std::string> aovs;  ///< as ImageDescription::aovs
  int threads = 0;                ///< 0: all the machine has
  std::filesystem::path checkpoint;
  bool resume = false;  ///< go on from the checkpoint, if it is there
  const std::atomic<bool>* cancel = nullptr;
  std::function<void(const RenderProgress&)> progress;
};

struct PictureSamples {
  RenderState state;
  RenderStatus status = RenderStatus::kDone;
};

/// Renders a compiled scene until its own stop rule is reached or the caller cancels, when the checkpoint is
/// written; it is left in place. `fingerprint` is the scene's (scene_fingerprint). Throws Error: those of
/// load_checkpoint and run_render_loop.
PictureSamples render_picture(const CompiledScene& scene, const std::string& fingerprint,
                              const PictureOptions& options);

/// Which frame of an animation a picture is.
struct FrameStamp {
  int number = 0;  ///< from 0
  double time_s = 0;
};

/// The picture of what was rendered, with its layers and metadata (voxlume/image.h). Between samples and
/// picture this is the one place, for stills and frames alike; frames come in their order. It is denoised by
/// `denoiser`, which may be null. Throws Error: those of PictureDenoiser.
Image finish_picture(const RenderState& state, const CompiledScene& scene,
                     const std::vector<std::string>& aovs, const std::optional<FrameStamp>& frame = {},
                     PictureDenoiser* denoiser = nullptr);

/// The metadata that finish_picture gives a picture, anew: of a scene that differs in how it is developed.
void describe_picture(const CompiledScene& scene, const std::optional<FrameStamp>& frame, Image& image);

/// Writes a finished picture as PNG (developed as the scene says) or EXR, by the extension of `path`.
/// Throws Error kFileNotFound, kInternal.
void save_picture(const Image& picture, const SceneDescription& scene, const std::filesystem::path& path);

/// Whether `path` is named as an EXR file.
bool is_exr_name(const std::filesystem::path& path);

}  // namespace voxlume
