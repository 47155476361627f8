#include "denoise/svgf.h"

#include "denoise/atrous_level.h"
#include "denoise/gradient.h"
#include "denoise/temporal.h"

namespace voxlume {
namespace {

/// Of schied2017 section 4.4: tolerated difference in luminance, in standard deviations.
constexpr float kLuminanceSigma = 4;

class Svgf final : public Denoiser {
 public:
  explicit Svgf(bool adaptive) : adaptive_(adaptive) {}

  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override {
    out.resize(frame.width, frame.height);
    for (Signal* signal : {&history_colors_, &signals_[0], &signals_[1]})
      signal->resize(frame.width, frame.height);
    make_guides(frame, guides_);
    const Plane* change = adaptive_ && frame.gradients ? &gradient_(frame, guides_) : nullptr;
    history_.blend(frame, guides_, history_colors_, change, signals_[0]);

    const auto level = [&](const Signal& from, int step, Signal& to) {
      filter_level(from, guides_, step, LuminanceStop::kVariance, kLuminanceSigma, to);
    };
    level(signals_[0], 1, history_colors_);
    level(history_colors_, 2, signals_[0]);
    level(signals_[0], 4, signals_[1]);
    level(signals_[1], 8, signals_[0]);
    level(signals_[0], 16, signals_[1]);

    filter_alpha(history_.means().alpha, history_.alpha_counts(), out.alpha);
    compose(signals_[1], out);
    history_.keep(frame, guides_);
  }

  void forget() override { history_.forget(); }

 private:
  bool adaptive_;
  Guides guides_;
  TemporalHistory history_;
  TemporalGradient gradient_;
  Signal history_colors_;  ///< the first level of the frame before
  std::array<Signal, 2> signals_;
};

}  // namespace

std::unique_ptr<Denoiser> make_svgf() { return std::make_unique<Svgf>(false); }
std::unique_ptr<Denoiser> make_asvgf() { return std::make_unique<Svgf>(true); }

}  // namespace voxlume
