#pragma once
#include <vector>

#include "transfer/range_extremes.h"
#include "transfer/transfer_view.h"
#include "voxlume/scene.h"

namespace voxlume {

/// Compiled 1-D transfer function with range maxima. Immutable.
class TransferFunction {
 public:
  /// Compiles `description`, whose reference length and points are given. Without any extinction curve
  /// nothing is visible; without a colour curve the albedo is 0.8 grey. mu_t = density_scale * -ln(1 - min(o,
  /// 0.9999)) / reference_length_mm; opacity segments are cut until interpolating mu_t is within 2e-4 of
  /// that. Values are rounded to floats; equal floats are a step. Throws Error kBadParameter with the JSON
  /// path of what is wrong.
  explicit TransferFunction(const TransferDescription& description);

  TransferView view() const;

  /// The supremum of mu_t over the closed range of data values [lower, upper], exact, in O(log n).
  float max_mu_t(float lower, float upper) const;
  /// The supremum over all values.
  float max_mu_t() const;
  const RangeExtremes& extremes() const { return extremes_; }
  /// The infimum of mu_t over the closed range of data values [lower, upper], exact, in O(log n): no look-up
  /// in it is below, to the last bit. 0 where the range is empty or not finite.
  float min_mu_t(float lower, float upper) const;
  /// Whether any value emits light.
  bool emits() const;

 private:
  std::vector<TransferPiece> pieces_;
  std::vector<ExtinctionPiece> extinction_;
  std::vector<std::int32_t> bucket_piece_;
  std::vector<float> bucket_split_;
  void fill_buckets();
  float buckets_per_unit_ = 0;
  float reference_length_mm_ = 1;
  RangeExtremes extremes_;
};

/// Opacity per reference length to extinction [1/mm] (design convention; o is clamped to [0, 0.9999]).
double mu_t_from_opacity(double opacity, double reference_length_mm);

}  // namespace voxlume
