#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "denoise/frame.h"

namespace voxlume {

/// Takes noise out of the frames of one view, one after the other, and remembers what it needs of those
/// before. Frames are processed on all threads that parallel_for has; the result is the same for any number.
class Denoiser {
 public:
  virtual ~Denoiser() = default;

  /// Denoises the next frame into `out`, whose planes keep their memory from frame to frame (they are made
  /// anew when the size changes). A frame of another size than the one before forgets what was.
  /// Throws Error kBadParameter when the frame lacks a layer that this method needs.
  virtual void denoise(const DenoiseFrame& frame, DenoisedFrame& out) = 0;

  /// The next frame has nothing to do with those before.
  virtual void forget() = 0;
};

/// What a method needs of a frame beyond radiance, alpha, depth and variance.
struct DenoiserNeeds {
  bool normal = false, albedo = false, classes = false, gradients = false;
};

/// A method as users name it.
struct DenoiserKind {
  std::string_view name;     ///< as in `--denoise`
  std::string_view summary;  ///< one line
  DenoiserNeeds needs;
  bool remembers;  ///< whether a result depends on the frames before
  std::unique_ptr<Denoiser> (*make)();
};

/// Every method, the default first.
const std::vector<DenoiserKind>& denoiser_kinds();

/// Throws Error kBadParameter for an unknown name, listing the known ones.
const DenoiserKind& find_denoiser(std::string_view name);

}  // namespace voxlume
