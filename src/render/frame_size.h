#pragma once

namespace voxlume {

/// What a frame is traced at while the view moves.
struct FrameSize {
  int width = 0, height = 0;  ///< pixels
  int spp = 1;                ///< samples per pixel
  friend bool operator==(const FrameSize&, const FrameSize&) = default;
};

/// What a frame took [s].
struct FrameCost {
  double fixed_s = 0;       ///< whatever its size
  double per_sample_s = 0;  ///< tracing
  double per_pixel_s = 0;   ///< denoising, developing, encoding
};

/// Samples per pixel from which on a still picture, full_width wide, looks better than a moving one that a
/// denoiser made of so many frames, the last of that size.
int first_still_spp(const FrameSize& moving, int frames, int full_width);

/// Chooses the size of frames so that each takes about as long as it may, from what those before took. Steps
/// are coarse and taken with hesitation, since a denoiser forgets when the size changes.
class FrameSizeChoice {
 public:
  /// `budget_s` > 0.
  explicit FrameSizeChoice(double budget_s) : budget_s_(budget_s) {}

  /// For a picture of full_width x full_height (>= 1) on screen: between it and an eighth of its sides.
  FrameSize next(int full_width, int full_height);
  /// What a frame of that size took.
  void learn(const FrameSize& size, double fixed_s, double trace_s, double rest_s);

  const FrameCost& cost() const { return cost_; }

 private:
  double expected_s(const FrameSize& size) const;

  const double budget_s_;
  FrameCost cost_;
  bool known_ = false;
  int step_ = 6;  ///< of kShrink
};

}  // namespace voxlume
