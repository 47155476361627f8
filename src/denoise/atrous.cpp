#include "denoise/atrous.h"

#include "denoise/atrous_level.h"

namespace voxlume {
namespace {

/// Tolerated at the first level, as a part of the luminance: dammertz2010 has a constant for colours in
/// [0,1].
constexpr float kLuminanceSigma = 2;

class ATrous final : public Denoiser {
 public:
  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override {
    out.resize(frame.width, frame.height);
    make_guides(frame, guides_);
    load_signal(frame, signals_[0]);
    signals_[1].resize(frame.width, frame.height);
    int now = 0;
    for (int level = 0; level < 5; ++level, now = 1 - now) {
      filter_level(signals_[now], guides_, 1 << level, LuminanceStop::kLuminance,
                   kLuminanceSigma / static_cast<float>(1 << level), signals_[1 - now]);
    }
    filter_alpha(frame.alpha, frame.samples, out.alpha);
    compose(signals_[now], out);
  }

  void forget() override {}

 private:
  Guides guides_;
  std::array<Signal, 2> signals_;
};

}  // namespace

std::unique_ptr<Denoiser> make_atrous() { return std::make_unique<ATrous>(); }

}  // namespace voxlume
