#include "denoise/decoupled.h"

#include "denoise/signal.h"
#include "voxlume/error.h"

namespace voxlume {

void DecoupledDenoiser::denoise(const DenoiseFrame& frame, DenoisedFrame& out) {
  if (!frame.classes) {
    throw Error(ErrorCode::kBadParameter, "", "the decoupled denoiser needs the classes of samples");
  }
  matter_.resize(frame.width, frame.height);
  out.resize(frame.width, frame.height);
  filter_classes_(frame, matter_);
  filter_alpha(frame.alpha, frame.samples, out.alpha);
  compose(matter_, out);
  history_.blend(frame, out);
}

}  // namespace voxlume
