#include "transfer/range_extremes.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace voxlume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::int32_t kBuckets = 4096;
/// The last piece that a bucket can name; later ones are found from there.
constexpr std::int32_t kLastTold = 0xffff;
/// Of a bucket's distance from the first, by which rounding can move its ends.
constexpr double kBucketSlack = 1e-6;

float value_at(const ExtremePiece& piece, float value) noexcept {
  const float mu_t = piece.mu_t + piece.mu_t_slope * (value - piece.anchor);
  return mu_t > 0 ? mu_t : 0;
}

constexpr auto greater = [](float a, float b) { return a < b ? b : a; };
constexpr auto lesser = [](float a, float b) { return b < a ? b : a; };

bool same_line(const ExtremePiece& a, const ExtremePiece& b) noexcept {
  return a.anchor == b.anchor && a.mu_t == b.mu_t && a.mu_t_slope == b.mu_t_slope;
}

float end_or_infinity(const ExtremePiece& piece) noexcept {
  return std::isnan(piece.end) ? kInfinity : piece.end;
}

}  // namespace

RangeExtremes::RangeExtremes(const std::vector<TransferPiece>& pieces) {
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const TransferPiece& p = pieces[i];
    const float end = i + 1 < pieces.size() ? pieces[i + 1].start : std::numeric_limits<float>::quiet_NaN();
    pieces_.push_back({end, p.anchor, p.mu_t, p.mu_t_slope});
  }
  knot_max_ = knot_extremes(greater);
  knot_min_ = knot_extremes(lesser);
  make_buckets();
}

template <class Pick>
std::vector<float> RangeExtremes::knot_extremes(Pick pick) const {
  const std::size_t n = pieces_.size();
  std::vector<float> out(n);
  for (std::size_t p = 1; p < n; ++p) {
    const float at = pieces_[p - 1].end;
    out[p] = pick(value_at(pieces_[p - 1], at), value_at(pieces_[p], at));
  }
  for (std::size_t step = 1; 2 * step < n; step *= 2) {
    const std::size_t row = out.size() - n;
    for (std::size_t p = 0; p < n; ++p)
      out.push_back(pick(out[row + p], out[row + std::min(p + step, n - 1)]));
  }
  return out;
}

void RangeExtremes::make_buckets() {
  bucket_origin_ = pieces_[0].anchor;
  const double width = double{pieces_.back().anchor} - double{bucket_origin_};
  buckets_per_unit_ = static_cast<float>(kBuckets / width);
  std::int32_t count = kBuckets;
  if (!(width > 0 && width < 1e38 && buckets_per_unit_ > 0 && buckets_per_unit_ < kInfinity)) {
    count = 1;
    buckets_per_unit_ = 0;
  }
  constexpr double kEndless = std::numeric_limits<float>::max();
  buckets_.resize(static_cast<std::size_t>(count));
  const double step = width / kBuckets;
  std::int32_t piece = 0;
  for (std::int32_t b = 0; b < count; ++b) {
    const double lower = bucket_origin_ + b * step * (1 - kBucketSlack);
    while (b > 0 && pieces_[piece].end <= lower) ++piece;
    buckets_[b] = static_cast<std::uint32_t>(std::min(piece, kLastTold));
  }
  std::int32_t next_visible = count;
  for (std::int32_t b = count - 1; b >= 0; --b) {
    const double lower = bucket_origin_ + b * step * (1 - kBucketSlack);
    const double upper = bucket_origin_ + (b + 1) * step * (1 + kBucketSlack);
    if (visible(b == 0 ? -kEndless : lower, b == count - 1 ? kEndless : upper)) next_visible = b;
    buckets_[b] |= static_cast<std::uint32_t>(next_visible) << 16;
  }
}

bool RangeExtremes::visible(double lower, double upper) const noexcept {
  return maximum({std::nextafter(static_cast<float>(lower), -kInfinity),
                  std::nextafter(static_cast<float>(upper), kInfinity)}) > 0;
}

float RangeExtremes::piece_start(std::int32_t piece) const noexcept {
  return piece > 0 ? pieces_[piece - 1].end : -kInfinity;
}

template <class Pick>
float RangeExtremes::extreme(ValueRange range, const std::vector<float>& knots, Pick pick) const noexcept {
  if (!(range.lower <= range.upper)) return 0;
  const auto piece_of = [&](float value) {
    const auto past = [](float v, const ExtremePiece& piece) { return v < piece.end; };
    return std::upper_bound(pieces_.begin(), pieces_.end() - 1, value, past) - pieces_.begin();
  };
  const std::ptrdiff_t first = piece_of(range.lower), last = piece_of(range.upper);
  const float ends = pick(value_at(pieces_[first], range.lower), value_at(pieces_[last], range.upper));
  if (first == last) return ends;
  const int level = std::bit_width(static_cast<std::size_t>(last - first)) - 1;
  const float* row = knots.data() + static_cast<std::size_t>(level) * pieces_.size();
  return pick(ends, pick(row[first + 1], row[last + 1 - (std::ptrdiff_t{1} << level)]));
}

float RangeExtremes::maximum(ValueRange range) const noexcept { return extreme(range, knot_max_, greater); }

float RangeExtremes::minimum(ValueRange range) const noexcept { return extreme(range, knot_min_, lesser); }

void RangeExtremes::find_maxima(const ValueRange* ranges, std::int64_t count, float scale,
                                float* mu_maj) const noexcept {
  simd::find_range_maxima(view(), ranges, count, scale, mu_maj);
}

void RangeExtremes::find_minima(const ValueRange* ranges, std::int64_t count, float* mu_min) const noexcept {
  simd::find_range_minima(view(), ranges, count, mu_min);
}

RangeExtremesView RangeExtremes::view() const noexcept {
  return {pieces_.data(),   static_cast<std::int32_t>(pieces_.size()),
          buckets_.data(),  static_cast<std::int32_t>(buckets_.size()),
          bucket_origin_,   buckets_per_unit_,
          knot_max_.data(), knot_min_.data()};
}

ValueRange changed_values(const RangeExtremes& before, const RangeExtremes& after) noexcept {
  const auto &a = before.pieces_, &b = after.pieces_;
  const auto n_a = static_cast<std::int32_t>(a.size()), n_b = static_cast<std::int32_t>(b.size());
  const std::int32_t shorter = std::min(n_a, n_b);
  if (shorter == 0) return {-kInfinity, kInfinity};
  std::int32_t head = 0;
  while (head < shorter && same_line(a[head], b[head]) &&
         end_or_infinity(a[head]) == end_or_infinity(b[head]))
    ++head;
  if (head == n_a && head == n_b) return {kInfinity, -kInfinity};
  // The last pieces end at infinity, so the first difference is within both.
  const float lower = same_line(a[head], b[head])
                          ? std::min(end_or_infinity(a[head]), end_or_infinity(b[head]))
                          : before.piece_start(head);
  std::int32_t tail = 1;
  const auto tail_differs = [&] {
    return !same_line(a[n_a - tail], b[n_b - tail]) ||
           before.piece_start(n_a - tail) != after.piece_start(n_b - tail);
  };
  while (tail < shorter && !tail_differs()) ++tail;
  const float upper = end_or_infinity(a[n_a - tail]);
  return {std::min(lower, upper), std::max(lower, upper)};
}

}  // namespace voxlume
