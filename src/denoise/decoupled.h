#pragma once
#include <array>
#include <memory>
#include <vector>

#include "denoise/denoiser.h"
#include "denoise/guides.h"
#include "denoise/local_mean.h"
#include "denoise/reprojection.h"

namespace voxlume {

/// The classes of a frame after filtering, and what the next frame asks of them.
struct DecoupledHistory {
  std::array<SampleClass, 2> classes;
  Plane alpha;
  Plane depth_mm;
  Plane luminance;  ///< of the denoised picture, premultiplied
};

/// What one frame passes from one stage of the decoupled denoiser to the next.
struct DecoupledStages {
  std::array<Planes3, 2> fx_diffuse, fx_specular;         ///< after their spatial filter (xu2024 eq. 11)
  std::array<Planes3, 2> fl_diffuse, fl_specular, later;  ///< after the first step of theirs
  Planes3 matter;                                         ///< radiance of what scattered, composed
  Plane scattered;                                        ///< samples behind `matter`; 0 where there is none
  Guides guides;
  Plane variance;  ///< of the means' luminance, averaged around a pixel
  Planes3 residual;
  Plane error;                    ///< squared distance in luminance from the means, averaged likewise
  float inverse_depth_sigma = 0;  ///< [1/mm]
  float inverse_light = 1;        ///< 1 / mean luminance of fl, where a sample scattered
};

/// The decoupled denoiser (xu2024 section 5). How the first scattering scatters and the light that arrives
/// there are filtered apart, class by class, each with the weights that suit it, and multiplied again. As the
/// samples grow many, the picture goes over to their plain mean.
class DecoupledDenoiser final : public Denoiser {
 public:
  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override;
  void forget() override { has_history_ = false; }

 private:
  void resize(int width, int height);

  bool has_history_ = false;
  CameraView camera_before_{};
  Reprojector reproject_;
  LocalMean local_mean_;
  DecoupledStages stages_;
  DecoupledHistory now_, before_;
  std::vector<double> row_sums_;
};

}  // namespace voxlume
