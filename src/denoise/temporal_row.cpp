#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/temporal_row.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/guides-inl.h"
#include "denoise/temporal_row.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// schied2017 section 4.1.
constexpr float kLeastWeight = 0.2f;
/// Frames in a history at most: what keeps the count meaningful after a long rest.
constexpr float kLongest = 32;
/// Histories shorter than this have no variance of their own (schied2017 section 4.2).
constexpr float kShort = 4;
/// How far the reprojected depth may be off, in differences that neighbours have.
constexpr float kDepthTolerance = 10;
/// How far normals may differ: squared, times Guides::feature_rate. Half a radian for exact ones.
constexpr float kNormalTolerance = 16;
/// How far alpha may have been from what the frame says, in standard deviations of its samples.
constexpr float kAlphaTolerance = 1.5f;
/// Frames that a mean with the least weight amounts to: (2 - w) / w.
constexpr float kFramesOfMean = (2 - kLeastWeight) / kLeastWeight;

using Ints = hn::RebindToSigned<Floats>;
using I = hn::Vec<Ints>;
constexpr Ints kInts;

/// Places in a plane, one a lane, most often side by side.
class Places {
 public:
  Places(F column, F row, int stride)
      : index_(hn::Add(hn::Mul(hn::ConvertTo(kInts, row), hn::Set(kInts, stride)),
                       hn::ConvertTo(kInts, column))),
        first_(hn::GetLane(index_)),
        side_by_side_(hn::AllTrue(kInts, hn::Eq(index_, hn::Iota(kInts, first_)))) {}
  HWY_INLINE F of(const Plane& plane) const {
    const float* start = plane.row(0);
    return side_by_side_ ? hn::LoadU(kD, start + first_) : hn::GatherIndex(kD, start, index_);
  }
  HWY_INLINE F3 of(const Planes3& planes) const { return {of(planes[0]), of(planes[1]), of(planes[2])}; }

 private:
  I index_;
  int first_;
  bool side_by_side_;
};

/// Sums over taps of the frame before.
struct History {
  F weight, frames, alpha, first, second, color_alpha;
  F3 color;
};

/// Adds a tap where it shows the same matter. column and row may be up to three pixels outside.
HWY_INLINE void add_tap(const TemporalInput& in, const GuideCentre& centre, F depth, F column, F row,
                        F kernel, History& sum) {
  const Places places(column, row, in.before.alpha.stride());
  const F depth_there = places.of(in.guides_before.depth_mm);
  const F3 difference = sub(centre.normal, places.of(in.guides_before.normal));
  const auto near =
      hn::Lt(hn::Mul(hn::AbsDiff(depth, depth_there), centre.depth_rate), hn::Set(kD, kDepthTolerance));
  const auto alike =
      hn::Lt(hn::Mul(dot(difference, difference), centre.feature_rate), hn::Set(kD, kNormalTolerance));
  const auto matter = hn::Gt(depth_there, hn::Zero(kD));
  const F weight = hn::IfThenElseZero(hn::And(matter, hn::And(near, alike)), kernel);
  sum.weight = hn::Add(sum.weight, weight);
  sum.frames = hn::MulAdd(places.of(in.before.frames), weight, sum.frames);
  sum.alpha = hn::MulAdd(places.of(in.before.alpha), weight, sum.alpha);
  sum.first = hn::MulAdd(places.of(in.before.first), weight, sum.first);
  sum.second = hn::MulAdd(places.of(in.before.second), weight, sum.second);
  sum.color = add_scaled(sum.color, places.of(in.colors.radiance), weight);
  sum.color_alpha = hn::MulAdd(places.of(in.colors.alpha), weight, sum.color_alpha);
}

/// The history of pixels that were seen before: bilinear, or 3 x 3 pixels where none of four will do.
HWY_INLINE History find_history(const TemporalInput& in, const GuideCentre& centre, int x, int y) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f), half = hn::Set(kD, 0.5f), none = hn::Set(kD, -2.0f);
  History sum{zero, zero, zero, zero, zero, zero, zero3()};
  const auto inside = [&](F place, int size) {
    return hn::Min(hn::Max(hn::Sub(place, half), none), hn::Set(kD, static_cast<float>(size) + 1));
  };
  const F px = inside(load(in.moved->x, x, y), in.frame.width);
  const F py = inside(load(in.moved->y, x, y), in.frame.height);
  const F depth = load(in.moved->depth_mm, x, y);
  const F column = hn::Floor(px), row = hn::Floor(py), u = hn::Sub(px, column), v = hn::Sub(py, row);
  const F left = hn::Sub(one, u), above = hn::Sub(one, v);
  add_tap(in, centre, depth, column, row, hn::Mul(left, above), sum);
  add_tap(in, centre, depth, hn::Add(column, one), row, hn::Mul(u, above), sum);
  add_tap(in, centre, depth, column, hn::Add(row, one), hn::Mul(left, v), sum);
  add_tap(in, centre, depth, hn::Add(column, one), hn::Add(row, one), hn::Mul(u, v), sum);
  const auto lost = hn::And(hn::Lt(sum.weight, hn::Set(kD, 0.01f)), hn::Gt(depth, zero));
  if (hn::AllFalse(kD, lost)) return sum;
  const F kernel = hn::IfThenElseZero(lost, one), column_near = hn::Round(px), row_near = hn::Round(py);
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx)
      add_tap(in, centre, depth, hn::Add(column_near, hn::Set(kD, static_cast<float>(dx))),
              hn::Add(row_near, hn::Set(kD, static_cast<float>(dy))), kernel, sum);
  }
  return sum;
}

/// What the pixels of a row have in a plane with a value for 3 x 3 pixels.
HWY_INLINE F of_stratum(const Plane& plane, int x, int y) {
  const F column = hn::Add(hn::Iota(kD, static_cast<float>(x)), hn::Set(kD, 0.5f));
  const F stratum = hn::Min(hn::Floor(hn::Mul(column, hn::Set(kD, 1.0f / 3))),
                            hn::Set(kD, static_cast<float>(plane.width() - 1)));
  return hn::GatherIndex(kD, plane.row(y / 3), hn::ConvertTo(kInts, stratum));
}

/// Alpha as the frame allows: within what 3 x 3 pixels have, and within kAlphaTolerance standard deviations
/// of what the pixel's own samples say: (k + 1) / (n + 2) for k of n that scattered. Else matter that moves
/// would leave its outline behind.
HWY_INLINE F clamp_alpha(F value, const DenoiseFrame& frame, int x, int y) {
  const F one = hn::Set(kD, 1.0f), own = load(frame.alpha, x, y);
  F least = own, most = own;
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const F neighbour = load(frame.alpha, x + dx, y + dy);
      least = hn::Min(least, neighbour);
      most = hn::Max(most, neighbour);
    }
  }
  const F samples = load(frame.samples, x, y);
  const F trials = hn::Div(one, hn::Add(samples, hn::Set(kD, 2.0f)));
  const F likely = hn::Mul(hn::MulAdd(own, samples, one), trials);
  const F deviation = hn::Sqrt(hn::Mul(hn::Mul(likely, hn::Sub(one, likely)), trials));
  const F off = hn::Mul(hn::Set(kD, kAlphaTolerance), deviation);
  const F within = hn::Min(hn::Max(value, hn::Sub(likely, off)), hn::Add(likely, off));
  return hn::Min(hn::Max(within, least), most);
}

HWY_INLINE F mix(F from, F to, F share) { return hn::MulAdd(hn::Sub(to, from), share, from); }

void blend_columns(const TemporalInput& in, const GuideRows& guides, int x, int y, std::size_t lanes,
                   TemporalMeans& now, Plane& alpha_counts, Signal& out) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f);
  History old{zero, zero, zero, zero, zero, zero, zero3()};
  if (in.moved) old = find_history(in, guide_centre(guides, x), x, y);
  const F part = inverse_or_zero(old.weight);
  F frames = hn::Min(hn::Set(kD, kLongest), hn::MulAdd(old.frames, part, one));
  F share = hn::Max(hn::Set(kD, kLeastWeight), hn::Div(one, frames));
  if (in.change) {
    const F change = of_stratum(*in.change, x, y);
    share = mix(share, one, change);
    frames = mix(frames, one, change);
  }
  share = hn::IfThenElse(hn::Gt(part, zero), share, one);

  const F3 radiance = load(in.frame.radiance, x, y);
  const F alpha = load(in.frame.alpha, x, y), y_radiance = luminance(radiance);
  const F found_alpha = hn::Mul(old.alpha, part);
  const F kept = hn::Mul(clamp_alpha(found_alpha, in.frame, x, y), inverse_or_zero(found_alpha));
  const F old_alpha = hn::Mul(found_alpha, kept), old_part = hn::Mul(part, kept);
  const F new_alpha = mix(old_alpha, alpha, share);
  const F first = mix(hn::Mul(old.first, old_part), y_radiance, share);
  const F second = mix(hn::Mul(old.second, old_part),
                       hn::Mul(hn::Mul(y_radiance, y_radiance), inverse_or_zero(alpha)), share);
  const F3 old_radiance = scale(old.color, hn::Mul(inverse_or_zero(old.color_alpha), old_alpha));
  const F3 blended{mix(old_radiance.x, radiance.x, share), mix(old_radiance.y, radiance.y, share),
                   mix(old_radiance.z, radiance.z, share)};
  store(new_alpha, now.alpha, x, y, lanes);
  store(first, now.first, x, y, lanes);
  store(second, now.second, x, y, lanes);
  store(frames, now.frames, x, y, lanes);
  const F worth = hn::Min(frames, hn::Set(kD, kFramesOfMean));
  store(hn::Mul(load(in.frame.samples, x, y), worth), alpha_counts, x, y, lanes);

  const F by_alpha = inverse_or_zero(new_alpha), mean = hn::Mul(first, by_alpha);
  store(blended, out.radiance, x, y, lanes);
  store(new_alpha, out.alpha, x, y, lanes);
  store(hn::Mul(luminance(blended), by_alpha), out.luminance, x, y, lanes);
  const F of_a_frame = hn::Max(zero, hn::NegMulAdd(mean, mean, hn::Mul(second, by_alpha)));
  store(hn::Div(of_a_frame, worth), out.variance, x, y, lanes);
}

void blend_row(const TemporalInput& in, int y, TemporalMeans& now, Plane& alpha_counts, Signal& out) {
  const GuideRows guides(in.guides, y);
  for_row(in.frame.width,
          [&](int x, std::size_t lanes) { blend_columns(in, guides, x, y, lanes, now, alpha_counts, out); });
}

void spatial_variance_row(const TemporalMeans& now, const Guides& guides, int y, Plane& variance) {
  const auto taps = make_taps<3>(now.alpha.stride(), 1, {1, 1, 1, 1});
  const GuideRows rows(guides, y);
  const float *alpha = now.alpha.row(y), *first = now.first.row(y), *second = now.second.row(y);
  for_row(now.alpha.width(), [&](int x, std::size_t lanes) {
    const F frames = load(now.frames, x, y);
    const auto young = hn::And(hn::Lt(frames, hn::Set(kD, kShort)), hn::FirstN(kD, lanes));
    if (hn::AllFalse(kD, young)) return;
    const GuideCentre centre = guide_centre(rows, x);
    F sum_alpha = hn::Zero(kD), sum_first = sum_alpha, sum_second = sum_alpha;
    for (const Tap& tap : taps) {
      const std::ptrdiff_t i = x + tap.offset;
      const F weight = exp_approx(log_weight(centre, rows, x, tap));
      sum_alpha = hn::MulAdd(hn::LoadU(kD, alpha + i), weight, sum_alpha);
      sum_first = hn::MulAdd(hn::LoadU(kD, first + i), weight, sum_first);
      sum_second = hn::MulAdd(hn::LoadU(kD, second + i), weight, sum_second);
    }
    const F by_alpha = inverse_or_zero(sum_alpha), mean = hn::Mul(sum_first, by_alpha);
    const F about_mean = hn::Max(hn::Zero(kD), hn::NegMulAdd(mean, mean, hn::Mul(sum_second, by_alpha)));
    const F estimate = hn::Mul(about_mean, hn::Div(hn::Set(kD, kShort), frames));
    store(hn::IfThenElse(young, estimate, load(variance, x, y)), variance, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(blend_row);
HWY_EXPORT(spatial_variance_row);

void blend_row(const TemporalInput& input, int y, TemporalMeans& now, Plane& alpha_counts, Signal& out) {
  HWY_DYNAMIC_DISPATCH(blend_row)(input, y, now, alpha_counts, out);
}

void spatial_variance_row(const TemporalMeans& now, const Guides& guides, int y, Plane& variance) {
  HWY_DYNAMIC_DISPATCH(spatial_variance_row)(now, guides, y, variance);
}

}  // namespace voxlume
#endif  // HWY_ONCE
