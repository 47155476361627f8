#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/bilateral.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/parallel.h"
#include "denoise/bilateral.h"
#include "denoise/guides-inl.h"
#include "denoise/signal.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// exp(-d^2 / (2 * 2^2)) for d = 0..3 pixels.
constexpr std::array<float, 4> kGaussian{1, 0.8825f, 0.6065f, 0.3247f};

void bilateral_row(const DenoiseFrame& frame, const Guides& guides, int y, Signal& out) {
  const auto taps = make_taps<3>(frame.alpha.stride(), 1, kGaussian);
  const GuideRows rows(guides, y);
  const Rows3 radiance(frame.radiance, y);
  const float* alpha = frame.alpha.row(y);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const GuideCentre centre = guide_centre(rows, x);
    F3 sum = zero3();
    F sum_alpha = hn::Zero(kD);
    for (const Tap& tap : taps) {
      const F weight = exp_approx(log_weight(centre, rows, x, tap));
      sum = add_scaled(sum, radiance.at(x + tap.offset), weight);
      sum_alpha = hn::MulAdd(hn::LoadU(kD, alpha + x + tap.offset), weight, sum_alpha);
    }
    store(sum, out.radiance, x, y, lanes);
    store(sum_alpha, out.alpha, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(bilateral_row);

namespace {

class Bilateral final : public Denoiser {
 public:
  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override {
    out.resize(frame.width, frame.height);
    signal_.resize(frame.width, frame.height);
    make_guides(frame, guides_);
    parallel_for(frame.height, 8, [&](std::int64_t y) {
      HWY_DYNAMIC_DISPATCH(bilateral_row)(frame, guides_, static_cast<int>(y), signal_);
    });
    filter_alpha(frame.alpha, frame.samples, out.alpha);
    compose(signal_, out);
  }

  void forget() override {}

 private:
  Guides guides_;
  Signal signal_;
};

}  // namespace

std::unique_ptr<Denoiser> make_bilateral() { return std::make_unique<Bilateral>(); }

}  // namespace voxlume
#endif  // HWY_ONCE
