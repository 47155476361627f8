#pragma once
#include "denoise/guides.h"
#include "denoise/reprojection.h"
#include "denoise/signal.h"

namespace voxlume {

/// Means over the frames of a pixel's history.
struct TemporalMeans {
  Plane alpha;
  Plane first, second;  ///< of alpha * Y and of alpha * Y^2, with Y the luminance of the colour
  Plane frames;         ///< how many the history has; [1, 32]

  void resize(int width, int height);
};

/// Exponential means over the frames of a view, each pixel following its matter, and how far they can be
/// trusted: the temporal part of SVGF (schied2017 sections 4.1 and 4.2).
class TemporalHistory {
 public:
  /// Blends the frame into its history. The frame weighs max(0.2, 1 / n) of a history of n <= 32 frames,
  /// itself included, and all of it where the matter was not in the picture or where depth or normal say that
  /// something else was. The history's alpha is kept to what the frame's own samples make likely. `change`
  /// (null: none) is 0..1 for each 3 x 3 pixels and blends that weight, and the history's length, toward
  /// those of a first frame.
  ///
  /// `colors` has the colours of the frame before, as radiance / alpha. `out` becomes the blended signal. Its
  /// variance is that of a frame's luminance over the history, divided by the frames that the mean is worth;
  /// or, where n < 4, that over 7 x 7 pixels, times 4 / n. (SVGF leaves out the division, which is too much
  /// for colours whose texture has not been divided out.)
  void blend(const DenoiseFrame& frame, const Guides& guides, const Signal& colors, const Plane* change,
             Signal& out);

  /// Keeps what the next frame needs. `guides` are those given to blend; other planes come back in them.
  void keep(const DenoiseFrame& frame, Guides& guides);

  void forget() { known_ = false; }

  /// Of the last frame.
  const TemporalMeans& means() const { return now_; }
  /// How many samples the blended alpha is worth.
  const Plane& alpha_counts() const { return alpha_counts_; }

 private:
  TemporalMeans now_, before_;
  Guides guides_before_;
  CameraView camera_before_{};
  Reprojector reproject_;
  Plane alpha_counts_;
  bool known_ = false;
};

}  // namespace voxlume
