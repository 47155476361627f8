#pragma once
#include <cstdint>
#include <limits>
#include <vector>

#include "grid/value_range.h"
#include "transfer/transfer_view.h"

namespace voxlume {

/// A piece of mu_t, linear up to the next piece's start.
struct ExtremePiece {
  float end;               ///< data units; NaN for the last piece, which no value is beyond
  float anchor;            ///< data value at which mu_t holds
  float mu_t, mu_t_slope;  ///< 1/mm, 1/mm per data unit
  friend bool operator==(const ExtremePiece&, const ExtremePiece&) = default;
};

/// The tables of RangeExtremes, for vector code.
struct RangeExtremesView {
  const ExtremePiece* pieces = nullptr;
  std::int32_t piece_count = 0;
  /// In the lower 16 bits a piece that no value of the bucket is before, in the upper ones the first bucket
  /// from this one on with mu_t > 0 somewhere.
  const std::uint32_t* buckets = nullptr;
  std::int32_t bucket_count = 0;
  float bucket_origin = 0, buckets_per_unit = 0;
  /// [level * piece_count + p]: the supremum and the infimum of mu_t at the starts of pieces
  /// p .. p + 2^level - 1, from either side.
  const float *knot_max = nullptr, *knot_min = nullptr;
};

/// Suprema and infima of mu_t over ranges of data values: mu_t is piecewise linear, so they are found at the
/// range's ends or at a knot inside, and the knots' extremes are tabulated.
class RangeExtremes {
 public:
  RangeExtremes() = default;
  explicit RangeExtremes(const std::vector<TransferPiece>& pieces);

  /// The supremum over the closed range [lower, upper], exact, in O(log n); 0 for an empty range.
  float maximum(ValueRange range) const noexcept;
  /// The infimum, no look-up in the range is below, to the last bit; 0 for a range that is empty or not
  /// finite.
  float minimum(ValueRange range) const noexcept;
  /// The suprema of `count` ranges times `scale` to mu_maj; the same numbers, by vector code.
  void find_maxima(const ValueRange* ranges, std::int64_t count, float scale, float* mu_maj) const noexcept;
  /// The infima of `count` ranges to mu_min; the same numbers, by vector code.
  void find_minima(const ValueRange* ranges, std::int64_t count, float* mu_min) const noexcept;

  RangeExtremesView view() const noexcept;

  /// Data values outside this range have the same mu_t in both, to the last bit, and so have ranges outside
  /// it their suprema. Empty where the functions are the same.
  friend ValueRange changed_values(const RangeExtremes& before, const RangeExtremes& after) noexcept;

 private:
  template <class Pick>
  std::vector<float> knot_extremes(Pick pick) const;
  template <class Pick>
  float extreme(ValueRange range, const std::vector<float>& knots, Pick pick) const noexcept;
  void make_buckets();
  bool visible(double lower, double upper) const noexcept;
  float piece_start(std::int32_t piece) const noexcept;

  std::vector<ExtremePiece> pieces_;
  std::vector<std::uint32_t> buckets_;
  float bucket_origin_ = 0, buckets_per_unit_ = 0;
  std::vector<float> knot_max_, knot_min_;
};

ValueRange changed_values(const RangeExtremes& before, const RangeExtremes& after) noexcept;

namespace simd {
/// RangeExtremes' functions by the widest instruction set that the machine has.
void find_range_maxima(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count,
                       float scale, float* mu_maj) noexcept;
void find_range_minima(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count,
                       float* mu_min) noexcept;
}  // namespace simd

}  // namespace voxlume
