#pragma once
#include <optional>
#include <vector>

#include "metrics/pixel_values.h"
#include "voxlume/image.h"

namespace voxlume {

// How steady a sequence of pictures is: the measures of xu2024, sections 6.4.3 and 6.4.4. Both look at R, G
// and B (premultiplied, as they are). Which values the paper measures it does not say; its threshold of 0.01
// only has a meaning for values in [0,1], so display values are the default.

/// How much the pictures of one moment differ from one another (xu2024, 6.4.3: "images variance"): render
/// some frames of history, then the next frame with many seeds (50 there) on that same history, denoise each,
/// and add each here. What is left of the variance is what flickers.
class TemporalVariance {
 public:
  explicit TemporalVariance(PixelValues values = PixelValues::kDisplay) : values_(values) {}

  /// One more picture of the moment. The first one sets the size. Throws Error kBadParameter when the size
  /// differs from the first one's, the picture is empty or a value is not finite; it is then not counted.
  void add(const Image& image);

  int count() const { return count_; }

  // The results. Each throws Error kBadParameter when fewer than two pictures were added.

  /// Of every pixel, row by row from the top: the variances over the pictures (unbiased, over count() - 1) of
  /// R, G and B, summed [value^2].
  std::vector<double> per_pixel() const;
  /// The sum of per_pixel(): the number the paper plots. It grows with the size of the picture.
  double sum() const;
  /// sum() over the number of pixels, which compares across sizes.
  double mean() const;

 private:
  PixelValues values_;
  int width_ = 0, height_ = 0, count_ = 0;
  std::vector<double> mean_, squares_;  // of R, G, B of every pixel; squared distances from the mean, summed
};

/// How soon the pictures stop changing after interaction halts (xu2024, 6.4.4): "when the RMSE between
/// consecutive frame images is less than 0.01, we consider the rendering results to have converged". Read
/// here as: the change of a frame is its RMSE to the frame before it, over all R, G and B values; the
/// sequence converges at the first frame whose change is below the threshold. Since noise can bring one frame
/// close to the last by luck, settled() says as well from which frame on all changes stayed below it.
class ConvergenceTime {
 public:
  static constexpr double kPaperThreshold = 0.01;

  explicit ConvergenceTime(double threshold = kPaperThreshold, PixelValues values = PixelValues::kDisplay)
      : threshold_(threshold), values_(values) {}

  /// A frame by its place in the sequence, 0 for the first one added, and the seconds given with it.
  struct Moment {
    int frame = 0;
    double seconds = 0;
  };

  /// The next frame, shown `seconds` after the halt. The first one, which has no change, is what was on show
  /// at the halt. Throws Error kBadParameter when the size differs from the frame before, the picture is
  /// empty or a value is not finite; it is then not counted.
  void add(const Image& image, double seconds);

  /// Of every frame but the first; changes()[i] is that of frame i + 1.
  const std::vector<double>& changes() const { return changes_; }
  /// The first frame whose change is below the threshold: the paper's measure. Absent as long as there is
  /// none.
  const std::optional<Moment>& converged() const { return converged_; }
  /// The first frame from which on the changes of all frames added are below the threshold. Absent when that
  /// of the last one is not.
  const std::optional<Moment>& settled() const { return settled_; }

 private:
  double threshold_;
  PixelValues values_;
  Image last_;
  std::vector<double> changes_;
  std::optional<Moment> converged_, settled_;
};

}  // namespace voxlume
