#include "metrics/temporal.h"

#include <cmath>
#include <cstddef>
#include <string>

#include "metrics/metrics.h"
#include "voxlume/error.h"

namespace voxlume {

void TemporalVariance::add(const Image& image) {
  check_picture(image, "the picture");
  if (count_ > 0 && (image.width != width_ || image.height != height_)) {
    throw Error(ErrorCode::kBadParameter, "",
                "the picture is " + std::to_string(image.width) + " x " + std::to_string(image.height) +
                    " pixels, expected " + std::to_string(width_) + " x " + std::to_string(height_) +
                    " as the first one");
  }
  if (count_ == 0) {
    width_ = image.width;
    height_ = image.height;
    mean_.assign(image.pixel_count() * 3, 0.0);
    squares_.assign(image.pixel_count() * 3, 0.0);
  }
  ++count_;
  // Welford 1962: sums of squares of far-off means would cancel.
  for (std::size_t i = 0; i < mean_.size(); ++i) {
    const double value = pixel_value(image.rgba[i / 3 * 4 + i % 3], values_);
    const double distance = value - mean_[i];
    mean_[i] += distance / count_;
    squares_[i] += distance * (value - mean_[i]);
  }
}

std::vector<double> TemporalVariance::per_pixel() const {
  if (count_ < 2) {
    throw Error(ErrorCode::kBadParameter, "",
                "found " + std::to_string(count_) + " pictures, expected at least 2 to have a variance");
  }
  std::vector<double> variance(mean_.size() / 3);
  for (std::size_t i = 0; i < squares_.size(); ++i) variance[i / 3] += squares_[i] / (count_ - 1);
  return variance;
}

double TemporalVariance::sum() const {
  double sum = 0;
  for (const double variance : per_pixel()) sum += variance;
  return sum;
}

double TemporalVariance::mean() const { return sum() / (static_cast<double>(width_) * height_); }

void ConvergenceTime::add(const Image& image, double seconds) {
  if (last_.rgba.empty()) {
    check_picture(image, "the picture");
  } else {
    changes_.push_back(rmse(image, last_, values_));
    const Moment moment{static_cast<int>(changes_.size()), seconds};
    const bool below = changes_.back() < threshold_;
    if (below && !converged_) converged_ = moment;
    if (below && !settled_) settled_ = moment;
    if (!below) settled_.reset();
  }
  last_ = Image(image.width, image.height);  // without layers
  last_.rgba = image.rgba;
}

}  // namespace voxlume
