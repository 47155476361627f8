#pragma once
#include "denoise/class_filters.h"
#include "denoise/denoiser.h"
#include "denoise/picture_history.h"

namespace voxlume {

/// The decoupled denoiser: the spatial filters of xu2024 section 5, and a history that notices when it is
/// late. As the samples of a frame grow many, the picture goes over to their plain mean.
class DecoupledDenoiser final : public Denoiser {
 public:
  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override;
  void forget() override { history_.forget(); }

 private:
  ClassFilters filter_classes_;
  Matter matter_;
  PictureHistory history_;
};

}  // namespace voxlume
