#pragma once
#include <array>
#include <vector>

#include "denoise/class_filters.h"
#include "denoise/denoiser.h"
#include "denoise/matter.h"
#include "denoise/reprojection.h"

namespace voxlume {

/// The classes of a frame after filtering, and what the next frame asks of them.
struct ClassHistory {
  std::array<SampleClass, 2> classes;
  Plane alpha;
  Plane depth_mm;
};

/// In what units a frame's depths and light are compared.
struct BlendScales {
  float inverse_depth_sigma;  ///< [1/mm]
  float inverse_light;        ///< 1 / mean luminance of fl + later, where a sample scattered
};

/// The decoupled denoiser with the temporal filters of its paper (xu2024 eqs. 12 to 14): each class of
/// samples continues the classes of the frame before. For comparison: what it shows of light that moves is
/// late.
class Xu2024Denoiser final : public Denoiser {
 public:
  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override;
  void forget() override { has_history_ = false; }

 private:
  bool has_history_ = false;
  CameraView camera_before_{};
  Reprojector reproject_;
  ClassFilters filter_classes_;
  Matter matter_;
  ClassHistory now_, before_;
  std::vector<double> row_sums_;
};

}  // namespace voxlume
