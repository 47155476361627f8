#pragma once
#include "denoise/frame.h"
#include "denoise/local_mean.h"
#include "denoise/reprojection.h"

namespace voxlume {

/// What is known of a sequence's pictures. A picture is the sum of what spatial filters make of it and of the
/// residual, what they take from it: both have a history of their own.
struct PictureMemory {
  Planes3 filtered, residual;   ///< premultiplied by alpha
  Plane alpha, alpha_residual;  ///< of the filtered picture, and what the frames' own alpha has beyond it
  Plane filtered_variance, residual_variance;  ///< of the luminance of both
  Plane depth_mm;                              ///< of the frame

  /// Variance where nothing is remembered, beyond any that light has.
  static constexpr float kUnknown = 1e36f;

  /// Makes all planes anew, of zeros.
  void resize(int width, int height);
};

/// How far a frame is from what was predicted, averaged around each pixel.
struct Innovation {
  Planes3 filtered;                  ///< of the filtered picture
  Plane filtered_squared;            ///< in luminance
  Plane residual, residual_squared;  ///< in luminance
};

/// The temporal filter of the decoupled denoiser: Kalman filters of the filtered picture and of its residual.
/// What frames differ by beyond their noise tells, around each pixel, how wrong the prediction is, and
/// thereby how much the present frame counts. Light that changes takes the past along: its brightness around
/// a pixel is brought to the present one's.
///
/// The sum of both filtered parts tends to the plain mean as a frame's own noise falls, whatever bias the
/// spatial filters have.
class PictureHistory {
 public:
  /// `picture` has what spatial filters made of `frame`, of the frame's size, and gets the picture that is
  /// shown. A frame of another size than the one before forgets what was.
  void blend(const DenoiseFrame& frame, DenoisedFrame& picture);
  /// The next frame has nothing to do with those before.
  void forget() { has_memory_ = false; }

 private:
  void resize(int width, int height);
  void estimate_variance(const DenoiseFrame& frame);
  void predict(const DenoiseFrame& frame, const DenoisedFrame& picture);
  void add_residual(DenoisedFrame& picture);

  bool has_memory_ = false;
  CameraView camera_before_{};
  Reprojector reproject_;
  LocalMean local_mean_;
  Plane variance_;  ///< of the plain means' luminance, averaged around a pixel
  PictureMemory memory_;
  PictureMemory prior_, now_;  ///< these and the next two are empty until a frame follows another
  Planes3 prior_mean_;         ///< of prior_.filtered around a pixel
  Innovation off_;
  Planes3 restored_;  ///< of the residual, what all pixels around one have
  Plane error_;       ///< working space
};

}  // namespace voxlume
