#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "transfer/range_extremes_simd.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "transfer/range_extremes.h"
#include "transfer/vector_records-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::ScalableTag<float>;
using Ints = hn::ScalableTag<std::int32_t>;
using F = hn::Vec<Floats>;
using I = hn::Vec<Ints>;

/// RangeExtremes::maximum, or ::minimum, for a vector of ranges, with the same arithmetic.
template <bool kMinimum>
class VectorExtreme {
 public:
  explicit VectorExtreme(const RangeExtremesView& f)
      : pieces_(reinterpret_cast<const float*>(f.pieces)),
        buckets_(reinterpret_cast<const std::int32_t*>(f.buckets)),
        knots_(kMinimum ? f.knot_min : f.knot_max),
        origin_(hn::Set(d_, f.bucket_origin)),
        per_unit_(hn::Set(d_, f.buckets_per_unit)),
        last_bucket_(hn::Set(d_, static_cast<float>(f.bucket_count - 1))),
        piece_count_(hn::Set(di_, f.piece_count)) {}

  HWY_INLINE F operator()(F lower, F upper) const {
    const I bucket = bucket_of(lower), upper_bucket = bucket_of(upper);
    const I entry = hn::GatherIndex(di_, buckets_, bucket);
    const I next_visible = hn::BitCast(di_, hn::ShiftRight<16>(hn::BitCast(du_, entry)));
    const auto maybe =
        hn::And(hn::RebindMask(d_, hn::Not(hn::Gt(next_visible, upper_bucket))), hn::Le(lower, upper));
    if (hn::AllFalse(d_, maybe)) return hn::Zero(d_);
    const I low_half = hn::Set(di_, 0xffff);
    I first = hn::And(entry, low_half);
    I last = hn::And(hn::GatherIndex(di_, buckets_, upper_bucket), low_half);
    const F at_lower = value_at(lower, first);
    F extreme = pick(at_lower, value_at(upper, last));
    const I crossed = hn::Sub(last, first);
    const auto crossing = hn::RebindMask(d_, hn::Gt(crossed, hn::Zero(di_)));
    if (!hn::AllFalse(d_, crossing))
      extreme = hn::IfThenElse(crossing, pick(extreme, knot_extreme(first, last, crossed)), extreme);
    return hn::IfThenElseZero(maybe, extreme);
  }

 private:
  static HWY_INLINE F pick(F a, F b) {
    if constexpr (kMinimum)
      return hn::Min(a, b);
    else
      return hn::Max(a, b);
  }

  HWY_INLINE I bucket_of(F value) const {
    const F at = hn::Mul(hn::Sub(value, origin_), per_unit_);
    // NaN falls into bucket 0.
    return hn::ConvertTo(di_, hn::Min(hn::IfThenElseZero(hn::Gt(at, hn::Zero(d_)), at), last_bucket_));
  }

  /// The piece that a value is in, from its bucket's on, and mu_t there.
  HWY_INLINE F value_at(F value, I& piece) const {
    for (;;) {
      F end, anchor, mu_t, slope;
      vector_load_records(d_, pieces_, piece, end, anchor, mu_t, slope);
      const auto beyond = hn::Ge(value, end);
      if (hn::AllFalse(d_, beyond)) {
        const F v = hn::Add(mu_t, hn::Mul(slope, hn::Sub(value, anchor)));
        return hn::IfThenElseZero(hn::Gt(v, hn::Zero(d_)), v);
      }
      piece = hn::Sub(piece, hn::BitCast(di_, hn::VecFromMask(d_, beyond)));
    }
  }

  /// The extreme at the knots of pieces first + 1 .. last; any value where there are none.
  HWY_INLINE F knot_extreme(I first, I last, I crossed) const {
    // The exponent of a whole number's float is the logarithm's floor; counts are far below 2^24.
    const I some = hn::Max(crossed, one_);
    const I exponent =
        hn::Sub(hn::ShiftRight<23>(hn::BitCast(di_, hn::ConvertTo(d_, some))), hn::Set(di_, 127));
    const I width =
        hn::ConvertTo(di_, hn::BitCast(d_, hn::ShiftLeft<23>(hn::Add(exponent, hn::Set(di_, 127)))));
    const I row = hn::Mul(exponent, piece_count_);
    const I last_start = hn::Max(hn::Sub(hn::Add(last, one_), width), hn::Zero(di_));
    const I first_start = hn::Min(hn::Add(first, one_), hn::Sub(piece_count_, one_));
    return pick(hn::GatherIndex(d_, knots_, hn::Add(row, first_start)),
                hn::GatherIndex(d_, knots_, hn::Add(row, last_start)));
  }

  Floats d_;
  Ints di_;
  hn::RebindToUnsigned<Ints> du_;
  const float* pieces_;
  const std::int32_t* buckets_;
  const float* knots_;
  F origin_, per_unit_, last_bucket_;
  I piece_count_;
  I one_ = hn::Set(Ints(), 1);
};

template <bool kMinimum>
void find_extremes(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count,
                   float scale, float* out) {
  const Floats d;
  constexpr std::int64_t kMostLanes = 16;
  const auto lanes = static_cast<std::int64_t>(hn::Lanes(d));
  const VectorExtreme<kMinimum> extreme(function);
  const F factor = hn::Set(d, scale);
  const auto step = [&](const ValueRange* from, float* to) HWY_ATTR {
    F lower, upper;
    hn::LoadInterleaved2(d, reinterpret_cast<const float*>(from), lower, upper);
    hn::StoreU(hn::Mul(extreme(lower, upper), factor), d, to);
  };
  std::int64_t i = 0;
  for (; i + lanes <= count; i += lanes) step(ranges + i, out + i);
  if (i == count) return;
  ValueRange rest[kMostLanes];
  float results[kMostLanes];
  for (std::int64_t n = 0; n < kMostLanes; ++n) rest[n] = i + n < count ? ranges[i + n] : ValueRange{1, 0};
  step(rest, results);
  for (std::int64_t n = 0; i + n < count; ++n) out[i + n] = results[n];
}

void find_maxima(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count, float scale,
                 float* mu_maj) {
  find_extremes<false>(function, ranges, count, scale, mu_maj);
}

void find_minima(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count,
                 float* mu_min) {
  find_extremes<true>(function, ranges, count, 1.0f, mu_min);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(find_maxima);
HWY_EXPORT(find_minima);

void simd::find_range_maxima(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count,
                             float scale, float* mu_maj) noexcept {
  HWY_DYNAMIC_DISPATCH(find_maxima)(function, ranges, count, scale, mu_maj);
}

void simd::find_range_minima(const RangeExtremesView& function, const ValueRange* ranges, std::int64_t count,
                             float* mu_min) noexcept {
  HWY_DYNAMIC_DISPATCH(find_minima)(function, ranges, count, mu_min);
}

}  // namespace voxlume
#endif
