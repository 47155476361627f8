#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "grid/value_range.h"
#include "transfer/transfer_view.h"

namespace voxlume {

/// A piece of mu_t, linear up to the next piece's start.
struct MaximumPiece {
  float end;               ///< data units; NaN for the last piece, which no value is beyond
  float anchor;            ///< data value at which mu_t holds
  float mu_t, mu_t_slope;  ///< 1/mm, 1/mm per data unit
  friend bool operator==(const MaximumPiece&, const MaximumPiece&) = default;
};

/// The tables of RangeMaximum, for vector code.
struct RangeMaximumView {
  const MaximumPiece* pieces = nullptr;
  std::int32_t piece_count = 0;
  /// In the lower 16 bits a piece that no value of the bucket is before, in the upper ones the first bucket
  /// from this one on with mu_t > 0 somewhere.
  const std::uint32_t* buckets = nullptr;
  std::int32_t bucket_count = 0;
  float bucket_origin = 0, buckets_per_unit = 0;
  /// knot_max[level * piece_count + p]: the supremum of mu_t at the starts of pieces p .. p + 2^level - 1,
  /// from either side.
  const float* knot_max = nullptr;
};

/// Suprema of mu_t over ranges of data values: mu_t is piecewise linear, so a supremum is found at the
/// range's ends or at a knot inside, and the knots' maxima are tabulated.
class RangeMaximum {
 public:
  RangeMaximum() = default;
  explicit RangeMaximum(const std::vector<TransferPiece>& pieces);

  /// The supremum over the closed range [lower, upper], exact, in O(log n); 0 for an empty range.
  float operator()(ValueRange range) const noexcept;
  /// The suprema of `count` ranges times `scale` to mu_maj; the same numbers, by vector code.
  void find(const ValueRange* ranges, std::int64_t count, float scale, float* mu_maj) const noexcept;

  RangeMaximumView view() const noexcept;

  /// Data values outside this range have the same mu_t in both, to the last bit, and so have ranges outside
  /// it their suprema. Empty where the functions are the same.
  friend ValueRange changed_values(const RangeMaximum& before, const RangeMaximum& after) noexcept;

 private:
  void make_knot_maxima();
  void make_buckets();
  bool visible(double lower, double upper) const noexcept;
  float piece_start(std::int32_t piece) const noexcept;

  std::vector<MaximumPiece> pieces_;
  std::vector<std::uint32_t> buckets_;
  float bucket_origin_ = 0, buckets_per_unit_ = 0;
  std::vector<float> knot_max_;
};

ValueRange changed_values(const RangeMaximum& before, const RangeMaximum& after) noexcept;

namespace simd {
/// RangeMaximum::find by the widest instruction set that the machine has.
void find_range_maxima(const RangeMaximumView& function, const ValueRange* ranges, std::int64_t count,
                       float scale, float* mu_maj) noexcept;
}  // namespace simd

}  // namespace voxlume
