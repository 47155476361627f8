#pragma once
#include <array>

#include "denoise/guides.h"
#include "denoise/matter.h"

namespace voxlume {

/// What one spatial filter of the classes passes to the next.
struct ClassStages {
  std::array<Planes3, 2> fx_diffuse, fx_specular;         ///< after their filter (xu2024 eq. 11)
  std::array<Planes3, 2> fl_diffuse, fl_specular, later;  ///< after the first of two steps (xu2024 5.3.2)
  Guides guides;
  float inverse_depth_sigma = 0;  ///< [1/mm]
};

/// The spatial filters of the decoupled denoiser (xu2024 section 5.3). How the first scattering scatters (fx)
/// and the light that arrives there (fl, later) are filtered apart, class by class, each with the weights
/// that suit it, and multiplied again.
class ClassFilters {
 public:
  /// Depths that differ by this share of the scene's size belong to different things. xu2024 has 2 dm for
  /// heads of about 5 dm across.
  static constexpr float kDepthSigma = 0.4f;

  /// `frame` has classes; `out` and, if not null, `classes` have its size. `classes` gets the filtered
  /// classes of each pixel (empty ones are zero), `out` what they are together.
  void operator()(const DenoiseFrame& frame, Matter& out, std::array<SampleClass, 2>* classes = nullptr);

 private:
  ClassStages stages_;
};

}  // namespace voxlume
