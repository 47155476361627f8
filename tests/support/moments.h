#pragma once
#include <cmath>

namespace voxlume::test {

/// Mean and its standard error (Welford).
class Moments {
 public:
  void add(double x) {
    ++count_;
    const double from_old = x - mean_;
    mean_ += from_old / count_;
    squares_ += from_old * (x - mean_);
  }
  double mean() const { return mean_; }
  double standard_error() const { return std::sqrt(squares_ / (count_ - 1) / count_); }
  /// Standard errors between the mean and `expected`; `rounding` is an error allowed on top.
  double z(double expected, double rounding = 0) const {
    const double off = std::abs(mean_ - expected) - rounding;
    if (off <= 0) return 0;
    return std::copysign(off / standard_error(), mean_ - expected);
  }

 private:
  double count_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace voxlume::test
