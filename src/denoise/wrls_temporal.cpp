#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/wrls_temporal.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <hwy/contrib/math/math-inl.h>

#include "denoise/recursive_least_squares-inl.h"
#include "denoise/row-inl.h"
#include "denoise/wrls_rows.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

using Ints = hn::RebindToSigned<Floats>;
using I = hn::Vec<Ints>;
constexpr Ints kInts;

/// A share of the frame's brightness below which the spatial filter sees no contrast.
constexpr float kDark = 0.05f;
/// Bounds of the spatial filter's sigma, a relative brightness.
constexpr float kLeastSigma = 0.03f, kGreatestSigma = 0.35f;
/// A pixel that is brighter than kSpike times the brightest around it and than kDimSpike times the frame is a
/// spike.
constexpr float kSpike = 2, kDimSpike = 4;
/// Share of a frame in the smoothed spread.
constexpr float kSpreadShare = 0.1f;

F square(F a) { return hn::Mul(a, a); }
F3 clamp(F3 a, F3 low, F3 high) {
  return {hn::Min(hn::Max(a.x, low.x), high.x), hn::Min(hn::Max(a.y, low.y), high.y),
          hn::Min(hn::Max(a.z, low.z), high.z)};
}
HWY_INLINE F3 select(hn::Mask<Floats> mask, F3 yes, F3 no) {
  return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y),
          hn::IfThenElse(mask, yes.z, no.z)};
}

HWY_INLINE F3 ycocg_from_rgb(F3 c) {
  const F half = hn::Set(kD, 0.5f), sum = hn::Mul(half, hn::Add(c.x, c.z));
  return {hn::Mul(half, hn::Add(sum, c.y)), hn::Mul(half, hn::Sub(c.x, c.z)),
          hn::Mul(half, hn::Sub(c.y, sum))};
}
HWY_INLINE F3 rgb_from_ycocg(F3 c) {
  const F rest = hn::Sub(c.x, c.z);
  return {hn::Add(rest, c.y), hn::Add(c.x, c.z), hn::Sub(rest, c.y)};
}

/// Places in a plane, one a lane.
struct Places {
  I offset;              ///< from row 0, column 0
  std::ptrdiff_t first;  ///< of the first lane
  bool side_by_side;     ///< the others follow

  HWY_INLINE explicit Places(I offsets) : offset(offsets), first(hn::GetLane(offsets)) {
    side_by_side = hn::AllTrue(kInts, hn::Eq(offset, hn::Iota(kInts, static_cast<int>(first))));
  }
  HWY_INLINE F operator()(const Plane& plane) const {
    const float* origin = plane.row(0);
    return side_by_side ? hn::LoadU(kD, origin + first) : hn::GatherIndex(kD, origin, offset);
  }
  HWY_INLINE F3 operator()(const Planes3& planes) const {
    return {(*this)(planes[0]), (*this)(planes[1]), (*this)(planes[2])};
  }
};

/// Where the pixels of a vector were in the frame before.
struct Past {
  Places nearest;
  hn::Mask<Floats> known;  ///< that there was the same matter
  bool between;            ///< some were between pixels, and take from four of them:
  I left_top, to_right, to_below;
  F right, below;  ///< the shares of the right and of the lower two
};

/// A coordinate's pixel and the share of the next one. Matter that has not moved but for rounding has not
/// moved.
HWY_INLINE void split(F point, int size, I& pixel, F& share) {
  const F last = hn::Set(kD, static_cast<float>(size - 1)), zero = hn::Zero(kD);
  const F from_centre = hn::Min(hn::Max(hn::Sub(point, hn::Set(kD, 0.5f)), zero), last);
  const F rounded = hn::Round(from_centre);
  const auto still = hn::Lt(hn::Abs(hn::Sub(from_centre, rounded)), hn::Set(kD, 1.0f / 64));
  const F place = hn::IfThenElse(still, rounded, from_centre);
  const F whole = hn::Floor(place);
  pixel = hn::ConvertTo(kInts, whole);
  share = hn::Sub(place, whole);
}

HWY_INLINE Past find_past(const WrlsUpdate& update, int x, int y, std::size_t lanes) {
  const int stride = update.before.depth_mm.stride();
  const F px = load(update.moved.x, x, y), py = load(update.moved.y, x, y), zero = hn::Zero(kD);
  const auto seen = hn::And(hn::FirstN(kD, lanes), hn::Ge(px, zero));
  const I own = hn::Iota(kInts, y * stride + x);
  const auto offset = [&](I column, I row) HWY_ATTR {
    const I there = hn::Add(hn::Mul(row, hn::Set(kInts, stride)), column);
    return hn::IfThenElse(hn::RebindMask(kInts, seen), there, own);
  };
  // Points in the picture are not negative: converting is rounding down.
  const Places nearest(offset(hn::ConvertTo(kInts, hn::IfThenElseZero(seen, px)),
                              hn::ConvertTo(kInts, hn::IfThenElseZero(seen, py))));
  const F depth = nearest(update.before.depth_mm);
  const F error = hn::Abs(hn::Sub(depth, load(update.moved.depth_mm, x, y)));
  const auto same = hn::Le(error, hn::Set(kD, kWrlsDepthTolerance * update.frame.size_mm));
  const auto known = hn::And(seen, hn::And(same, hn::Gt(depth, zero)));

  I column, row;
  F right, down;
  split(px, update.frame.width, column, right);
  split(py, update.frame.height, row, down);
  const auto to_right = hn::Gt(right, zero), to_below = hn::Gt(down, zero);
  return {.nearest = nearest,
          .known = known,
          .between = !hn::AllFalse(kD, hn::And(known, hn::Or(to_right, to_below))),
          .left_top = offset(column, row),
          .to_right = hn::IfThenElseZero(hn::RebindMask(kInts, to_right), hn::Set(kInts, 1)),
          .to_below = hn::IfThenElseZero(hn::RebindMask(kInts, to_below), hn::Set(kInts, stride)),
          .right = right,
          .below = down};
}

/// The history of a feature, bilinear between pixels: what is a model's own is taken from the nearest, which
/// for z would be seen as a texture that jumps.
HWY_INLINE void history(const Past& past, const WrlsModels& before, F3& z, F& alpha) {
  z = past.nearest(before.z);
  alpha = past.nearest(before.z_alpha);
  if (!past.between) return;
  const Places a(past.left_top), b(hn::Add(past.left_top, past.to_right));
  const Places c(hn::Add(a.offset, past.to_below)), d(hn::Add(b.offset, past.to_below));
  const auto mix = [&](const Plane& plane) HWY_ATTR {
    const F left_top = a(plane), left_bottom = c(plane);
    const F top = hn::MulAdd(hn::Sub(b(plane), left_top), past.right, left_top);
    const F bottom = hn::MulAdd(hn::Sub(d(plane), left_bottom), past.right, left_bottom);
    return hn::MulAdd(hn::Sub(bottom, top), past.below, top);
  };
  z = {mix(before.z[0]), mix(before.z[1]), mix(before.z[2])};
  alpha = mix(before.z_alpha);
}

/// The frame around a pixel, 3 x 3.
struct Neighbourhood {
  F3 colour, mean;     ///< the pixel's own, and the mean
  F3 lowest, highest;  ///< YCoCg
  F alpha, alpha_mean, alpha_lowest, alpha_highest;
  F luminance_square_mean, variance_mean;
  F others;  ///< greatest luminance of the eight around
};

HWY_INLINE Neighbourhood look_around(const DenoiseFrame& frame, float brightest, int x, int y) {
  const F most = hn::Set(kD, brightest), ninth = hn::Set(kD, 1.0f / 9);
  Neighbourhood n;
  const auto colour_at = [&](int column, int row) HWY_ATTR {
    const F3 c = load(frame.radiance, column, row);
    return F3{hn::Min(c.x, most), hn::Min(c.y, most), hn::Min(c.z, most)};
  };
  n.colour = colour_at(x, y);
  n.alpha = n.alpha_lowest = n.alpha_highest = load(frame.alpha, x, y);
  n.lowest = n.highest = ycocg_from_rgb(n.colour);
  n.mean = zero3();
  n.alpha_mean = n.luminance_square_mean = n.variance_mean = n.others = hn::Zero(kD);
  const F width = hn::Set(kD, static_cast<float>(frame.width));
  for (int dx = -1; dx <= 1; ++dx) {
    const F column = hn::Iota(kD, static_cast<float>(x + dx));
    const auto inside = hn::And(hn::Ge(column, hn::Zero(kD)), hn::Lt(column, width));
    for (int dy = -1; dy <= 1; ++dy) {
      // Beyond an edge the picture goes on as it ends.
      const int row = std::clamp(y + dy, 0, frame.height - 1);
      const F3 c = select(inside, colour_at(x + dx, row), colour_at(x, row));
      const F a = hn::IfThenElse(inside, load(frame.alpha, x + dx, row), load(frame.alpha, x, row));
      const F variance =
          hn::IfThenElse(inside, load(frame.variance, x + dx, row), load(frame.variance, x, row));
      const F3 t = ycocg_from_rgb(c);
      n.lowest = {hn::Min(n.lowest.x, t.x), hn::Min(n.lowest.y, t.y), hn::Min(n.lowest.z, t.z)};
      n.highest = {hn::Max(n.highest.x, t.x), hn::Max(n.highest.y, t.y), hn::Max(n.highest.z, t.z)};
      n.alpha_lowest = hn::Min(n.alpha_lowest, a);
      n.alpha_highest = hn::Max(n.alpha_highest, a);
      n.mean = add_scaled(n.mean, c, ninth);
      n.alpha_mean = hn::MulAdd(a, ninth, n.alpha_mean);
      const F light = luminance(c);
      n.luminance_square_mean = hn::MulAdd(square(light), ninth, n.luminance_square_mean);
      if (dx != 0 || row != y) n.others = hn::Max(n.others, hn::IfThenElseZero(inside, light));
      n.variance_mean = hn::MulAdd(variance, ninth, n.variance_mean);
    }
  }
  return n;
}

/// The pixel without what makes it a spike: it is brighter than any around it only so far, unless all is dim.
HWY_INLINE F3 without_spike(const Neighbourhood& n, float scale_of_frame) {
  const F limit = hn::Max(hn::Mul(n.others, hn::Set(kD, kSpike)), hn::Set(kD, kDimSpike * scale_of_frame));
  return scale(n.colour, hn::Div(limit, hn::Max(limit, luminance(n.colour))));
}

struct Feature {
  F3 z;
  F alpha;
};

/// Of a pixel without history: the mean around it, and as much of its own difference from the mean as is not
/// noise (a Wiener filter with the variances of 3 x 3 pixels). All of it counts as noise where one sample a
/// pixel does not tell.
HWY_INLINE Feature first_feature(const Neighbourhood& n, F3 colour, F samples) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f);
  const F spread = hn::Sub(n.luminance_square_mean, square(luminance(n.mean)));
  const auto tells = hn::And(hn::Gt(spread, zero), hn::Gt(samples, one));
  const F detail = hn::IfThenElseZero(tells, hn::Max(zero, hn::Sub(one, hn::Div(n.variance_mean, spread))));
  return {add_scaled(n.mean, sub(colour, n.mean), detail),
          hn::MulAdd(hn::Sub(n.alpha, n.alpha_mean), detail, n.alpha_mean)};
}

/// iglesias2020 eq. 12, with the history held between the least and greatest of 3 x 3 pixels in YCoCg.
HWY_INLINE Feature next_feature(const Neighbourhood& n, F3 colour, F3 z_before, F alpha_before) {
  const F share = hn::Set(kD, kWrlsHistory), rest = hn::Set(kD, 1 - kWrlsHistory);
  const F3 z = rgb_from_ycocg(clamp(ycocg_from_rgb(z_before), n.lowest, n.highest));
  const F alpha = hn::Min(hn::Max(alpha_before, n.alpha_lowest), n.alpha_highest);
  const F3 mixed = add_scaled(scale(z, share), colour, rest);
  const F zero = hn::Zero(kD);
  // The box in YCoCg has corners that are no light.
  return {{hn::Max(mixed.x, zero), hn::Max(mixed.y, zero), hn::Max(mixed.z, zero)},
          hn::MulAdd(alpha, share, hn::Mul(n.alpha, rest))};
}

/// d^2 of eq. 13.
HWY_INLINE F squared_distance(F3 colour, F3 z, float scale) {
  const F3 error = sub(colour, z);
  const F least = hn::Sqrt(hn::Min(dot(colour, colour), dot(z, z)));
  const F norm = hn::Add(least, hn::Set(kD, kWrlsEpsilon * scale));
  return hn::Div(dot(error, error), square(norm));
}

/// A model that predicts the feature.
template <int d>
HWY_INLINE LinearModel<d> first_model(F3 z, float scale) {
  LinearModel<d> model;
  for (F& element : model.p) element = hn::Zero(kD);
  for (F& coefficient : model.beta) coefficient = hn::Zero(kD);
  model.at(0, 0) = hn::Set(kD, d == 1 ? kWrlsFirstPWithoutFeature : kWrlsFirstP);
  if constexpr (d == 1) {
    model.beta[0] = z.x, model.beta[1] = z.y, model.beta[2] = z.z;
  } else {
    for (int k = 1; k < d; ++k) {
      model.at(k, k) = hn::Set(kD, kWrlsFirstP / (scale * scale));
      model.beta[3 * k + k - 1] = hn::Set(kD, 1.0f);
    }
  }
  return model;
}

/// Eqs. 8 to 14, with bounds on what is forgotten: one coefficient a frame in turn.
template <int d>
HWY_INLINE void update_model(LinearModel<d>& model, const WrlsUpdate& update, F3 colour, F3 z, F weight) {
  F predictor[d];
  predictor[0] = hn::Set(kD, 1.0f);
  if constexpr (d == 4) predictor[1] = z.x, predictor[2] = z.y, predictor[3] = z.z;
  model.observe(predictor, colour, weight, kWrlsForgetting, kWrlsLargestGain);
  const int k = update.frame_number % d;
  const F unit = hn::Set(kD, kWrlsLargestGrowth);
  const F limit = d == 1
                      ? hn::Mul(unit, hn::Set(kD, kWrlsFirstPWithoutFeature))
                      : hn::Mul(unit, hn::Set(kD, kWrlsFirstP / (k == 0 ? 1 : update.scale * update.scale)));
  const auto is = [&](int channel) HWY_ATTR { return hn::Set(kD, k == channel ? 1.0f : 0.0f); };
  // Without the feature nothing is expected: the mean stays what it is.
  const F3 expected = d == 1 ? F3{model.beta[0], model.beta[1], model.beta[2]} : F3{is(1), is(2), is(3)};
  model.limit_ignorance(k, limit, expected);
}

/// What the spatial filter compares, and how sharply.
HWY_INLINE void store_guide(const WrlsUpdate& update, F3 z, F spread, int x, int y, std::size_t lanes) {
  const F3 t = ycocg_from_rgb(z);
  const F brightness = hn::Add(t.x, hn::Set(kD, kDark * update.scale));
  const F inverse = hn::Div(hn::Set(kD, 1.0f), brightness);
  const F relative = hn::Mul(brightness, hn::Set(kD, 1 / update.scale));
  store({hn::Log(kD, relative), hn::Mul(t.y, inverse), hn::Mul(t.z, inverse)}, update.guide.colour, x, y,
        lanes);
  const F sigma_square = hn::Min(hn::Max(spread, hn::Set(kD, kLeastSigma * kLeastSigma)),
                                 hn::Set(kD, kGreatestSigma * kGreatestSigma));
  store(hn::Div(hn::Set(kD, -0.5f), sigma_square), update.guide.sharpness, x, y, lanes);
}

template <int d>
void update_row(const WrlsUpdate& update, int y) {
  const WrlsModels& before = update.before;
  WrlsModels& after = update.after;
  for_row(update.frame.width, [&](int x, std::size_t lanes) HWY_ATTR {
    const Past past = find_past(update, x, y, lanes);
    const Neighbourhood n = look_around(update.frame, kWrlsBrightest * update.scale, x, y);
    const F3 colour = without_spike(n, update.scale);
    const Feature first = first_feature(n, colour, load(update.frame.samples, x, y));
    F3 z_before;
    F alpha_before;
    history(past, before, z_before, alpha_before);
    const Feature next = next_feature(n, colour, z_before, alpha_before);
    const F3 z = select(past.known, next.z, first.z);
    store(z, after.z, x, y, lanes);
    store(hn::IfThenElse(past.known, next.alpha, first.alpha), after.z_alpha, x, y, lanes);

    const F distance = squared_distance(n.colour, z, update.scale);
    const F one = hn::Set(kD, 1.0f), bounded = hn::Min(distance, one);
    const F spread_before = hn::IfThenElse(past.known, past.nearest(before.spread), bounded);
    const F spread = hn::MulAdd(hn::Sub(bounded, spread_before), hn::Set(kD, kSpreadShare), spread_before);
    store(spread, after.spread, x, y, lanes);
    store_guide(update, z, spread, x, y, lanes);

    LinearModel<d> model = first_model<d>(z, update.scale);
    for (int i = 0; i < LinearModel<d>::kTriangle; ++i)
      model.p[i] = hn::IfThenElse(past.known, past.nearest(before.p[i]), model.p[i]);
    for (int i = 0; i < 3 * d; ++i)
      model.beta[i] = hn::IfThenElse(past.known, past.nearest(before.beta[i]), model.beta[i]);
    constexpr float kExponent = -1 / (kWrlsBandwidth * kWrlsBandwidth);
    const F weight = update.weighted ? hn::Exp(kD, hn::Mul(distance, hn::Set(kD, kExponent))) : one;
    update_model(model, update, n.colour, z, weight);
    for (int i = 0; i < LinearModel<d>::kTriangle; ++i) store(model.p[i], after.p[i], x, y, lanes);
    for (int i = 0; i < 3 * d; ++i) store(model.beta[i], after.beta[i], x, y, lanes);

    const F depth = load(update.frame.depth_mm, x, y);
    store(hn::IfThenElse(hn::Gt(depth, hn::Zero(kD)), depth, load(update.moved.depth_mm, x, y)),
          after.depth_mm, x, y, lanes);
  });
}

void update_models_row(const WrlsUpdate& update, int y) {
  if (update.before.p.size() == 1)
    update_row<1>(update, y);
  else
    update_row<4>(update, y);
}

void measure_brightness_row(const DenoiseFrame& frame, int y, WrlsBrightness& row) {
  F log_sum = hn::Zero(kD), count = hn::Zero(kD);
  const F one = hn::Set(kD, 1.0f), zero = hn::Zero(kD);
  for_row(frame.width, [&](int x, std::size_t) HWY_ATTR {
    const F light = luminance(load(frame.radiance, x, y)), alpha = load(frame.alpha, x, y);
    const auto lit = hn::And(hn::Gt(light, zero), hn::Gt(alpha, zero));
    const F ratio = hn::IfThenElse(lit, hn::Div(light, alpha), one);
    log_sum = hn::Add(log_sum, hn::Log2(kD, ratio));
    count = hn::Add(count, hn::IfThenElseZero(lit, one));
  });
  row.log2_sum = hn::GetLane(hn::SumOfLanes(kD, log_sum));
  row.count = hn::GetLane(hn::SumOfLanes(kD, count));
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(update_models_row);
HWY_EXPORT(measure_brightness_row);

void update_models_row(const WrlsUpdate& update, int y) {
  HWY_DYNAMIC_DISPATCH(update_models_row)(update, y);
}
void measure_brightness_row(const DenoiseFrame& frame, int y, WrlsBrightness& row) {
  HWY_DYNAMIC_DISPATCH(measure_brightness_row)(frame, y, row);
}

}  // namespace voxlume
#endif  // HWY_ONCE
