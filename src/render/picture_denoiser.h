#pragma once
#include <memory>

#include "denoise/denoiser.h"
#include "film/film.h"
#include "render/gradient_samples.h"
#include "scene/compile.h"
#include "voxlume/image.h"

namespace voxlume {

/// The layers that a film must keep for the denoiser `name` (/render/denoise); none for "none".
/// Throws Error kBadParameter for an unknown name.
FilmLayers denoiser_layers(const std::string& name);

/// Denoises the pictures of one scene, in the order of its frames.
class PictureDenoiser {
 public:
  /// `name` is one of denoiser_kinds(). Throws Error kBadParameter for an unknown one, kUnsupported where a
  /// library that it needs is missing.
  explicit PictureDenoiser(const std::string& name);

  /// Whether a picture depends on those before.
  bool remembers() const { return kind_.remembers; }

  /// Replaces the colours and A of `image`, which shows `film`, a rendering of `scene` that keeps
  /// denoiser_layers().
  void apply(const Film& film, const CompiledScene& scene, Image& image);

  /// The next picture has nothing to do with those before.
  void forget();

 private:
  const DenoiserKind& kind_;
  std::unique_ptr<Denoiser> denoiser_;
  DenoiseFrame frame_;
  DenoisedFrame denoised_;
  GradientSampler gradients_;
};

}  // namespace voxlume
