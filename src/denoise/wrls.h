#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "denoise/denoiser.h"
#include "denoise/reprojection.h"
#include "denoise/wrls_rows.h"

namespace voxlume {

/// What iglesias2020 section 5.3 takes away from the method to show what each part is good for (Figs. 8, 9).
struct WrlsOptions {
  bool weighted = true;  ///< weights of eq. 13; without them, w = 1: recursive least squares
  bool feature = true;   ///< p = [1, z]; without it p = [1]: a mean over time
};

/// Weighted recursive least squares (iglesias2020 sections 5 and 6): every pixel has a linear model that
/// predicts its radiance from a feature, the temporally smoothed radiance, and learns from every frame. The
/// models follow the matter, and each pixel of the result is predicted by the mean model of those around it.
/// docs/denoising.md tells what the paper leaves open and how it is filled.
class Wrls : public Denoiser {
 public:
  explicit Wrls(WrlsOptions options) : options_(options) {}

  void denoise(const DenoiseFrame& frame, DenoisedFrame& out) override;
  void forget() override;

  /// The models after the last frame.
  const WrlsModels& models() const noexcept { return models_[now_]; }
  /// The brightness of the last frame's matter [radiance]: the geometric mean of luminance / alpha, so that a
  /// few very bright samples do not move it. 0 before there was any light.
  float scale() const noexcept { return scale_; }

 private:
  void resize(int width, int height);
  void measure_scale(const DenoiseFrame& frame);

  WrlsOptions options_;
  std::array<WrlsModels, 2> models_;
  int now_ = 0;
  WrlsGuide guide_;
  Reprojector reproject_;
  std::optional<CameraView> camera_before_;
  std::vector<WrlsBrightness> rows_;
  float scale_ = 0;
  int frame_number_ = 0;
};

template <WrlsOptions options>
std::unique_ptr<Denoiser> make_wrls() {
  return std::make_unique<Wrls>(options);
}

}  // namespace voxlume
