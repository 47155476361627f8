#pragma once
#include <memory>
#include <string>
#include <vector>

#include "denoise/denoiser.h"
#include "voxlume/image.h"

namespace voxlume::study {

/// A method under study, which is fed the frames of a sequence one after the other.
class Method {
 public:
  /// What a method is shown instead of the frame; null: the frame itself.
  using Change = void (*)(DenoiseFrame& frame);

  /// Without a kind, the noisy picture itself.
  explicit Method(std::string name, const DenoiserKind* kind = nullptr, Change change = nullptr,
                  bool has_history = true);

  const std::string& name() const { return name_; }
  /// Whether frames before make a difference. Where they do not, those that nobody looks at can be left out.
  bool has_history() const { return has_history_; }

  /// Denoises the next frame; the time that took [ms].
  double denoise(const DenoiseFrame& frame);
  /// Of the frame denoised last, over its background.
  Image picture(const DenoiseFrame& frame) const;
  /// The next frame starts a sequence.
  void forget();

 private:
  std::string name_;
  std::unique_ptr<Denoiser> denoiser_;
  Change change_;
  bool has_history_;
  DenoiseFrame changed_;
  DenoisedFrame out_;
};

/// The noisy picture and every denoiser that there is. `all` includes the ablations of wrls.
std::vector<Method> every_method(bool all);

/// The decoupled denoiser without one of its parts each: "one-class" (all samples of a pixel are one class),
/// "no-decoupling" (all light is `later`).
std::vector<Method> ablations();

/// The decoupled denoiser for single frames.
Method still_method();

}  // namespace voxlume::study
