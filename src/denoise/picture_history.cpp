#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/picture_history.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "denoise/picture_history.h"
#include "denoise/row-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// In units of the plain means' variance: what the variance of a filtered picture may be (it is largest at
/// edges), what that of its mean around a pixel is, and the least mean squared error that is believed of it.
constexpr float kFilteredVariance = 0.27f, kFilteredMeanVariance = 0.025f, kFilteredError = 0.1f;
/// The present frame counts at least as much.
constexpr float kLeastFilteredGain = 0.15f, kLeastResidualGain = 0.03f;
/// How far the residual's innovations may exceed what is expected of their squares, and of the square of
/// their mean, before they count as a change.
constexpr float kSquareMargin = 1.2f, kMeanMargin = 2;
/// Sums of squares of such luminances are finite.
constexpr float kLargestLight = 1e17f;
/// Pixels of a LocalMean.
constexpr float kWindow = (2 * LocalMean::kRadius + 1) * (2 * LocalMean::kRadius + 1);

HWY_INLINE F squared(F a) { return hn::Mul(a, a); }
HWY_INLINE F positive(F a) { return hn::Max(a, hn::Zero(kD)); }
HWY_INLINE F3 positive(F3 a) { return {positive(a.x), positive(a.y), positive(a.z)}; }
/// a / b; 1 where both are 0. a, b >= 0.
HWY_INLINE F share_of(F a, F b) {
  const F tiny = hn::Set(kD, 1e-30f);
  return hn::Div(hn::Add(a, tiny), hn::Add(b, tiny));
}
/// a / b; 0 where both are 0.
HWY_INLINE F signal_share(F a, F b) { return hn::Div(a, hn::Add(b, hn::Set(kD, 1e-30f))); }

void luminance_row(const DenoiseFrame& frame, int y, Plane& out) {
  for_row(frame.width,
          [&](int x, std::size_t lanes) { store(luminance(load(frame.radiance, x, y)), out, x, y, lanes); });
}

/// The variance of each pixel's mean; of a single sample, which has none, its distance from those around it.
void variance_row(const DenoiseFrame& frame, const Plane& local_luminance, int y, Plane& out) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F apart = hn::Sub(luminance(load(frame.radiance, x, y)), load(local_luminance, x, y));
    const auto single = hn::Lt(load(frame.samples, x, y), hn::Set(kD, 1.5f));
    store(hn::IfThenElse(single, squared(apart), load(frame.variance, x, y)), out, x, y, lanes);
  });
}

/// What the spatial filters made of a pixel; the plain mean where that cannot be light (or is no number).
HWY_INLINE F3 load_filtered(const DenoiseFrame& frame, const DenoisedFrame& picture, int x, int y) {
  const F3 filtered = load(picture.radiance, x, y);
  const F largest = hn::Max(hn::Max(hn::Abs(filtered.x), hn::Abs(filtered.y)), hn::Abs(filtered.z));
  const F sum = hn::Add(hn::Add(filtered.x, filtered.y), filtered.z);  // not a number if one of them is none
  const auto is_light = hn::And(hn::Le(largest, hn::Set(kD, kLargestLight)), hn::Eq(sum, sum));
  return choose(is_light, filtered, load(frame.radiance, x, y));
}

/// Four pixels around where a pixel was in the frame before, and how much each counts.
struct Bilinear {
  hn::Vec<hn::RebindToSigned<Floats>> offset;  ///< of the upper left one, from row 0 of a plane
  F weights[4];
};

/// Pixels outside the picture do not count, those with matter elsewhere in depth little. The weights add up
/// to 1, or to 0 where too little of the four is left.
HWY_INLINE Bilinear place_before(const Reprojection& moved, const Plane& depth_mm, float inverse_depth_sigma,
                                 int x, int y) {
  const hn::RebindToSigned<Floats> integers;
  const F half = hn::Set(kD, 0.5f), one = hn::Set(kD, 1.0f), zero = hn::Zero(kD);
  const F px = load(moved.x, x, y), py = load(moved.y, x, y);
  const auto seen = hn::Ge(px, zero);
  const F u = hn::IfThenElseZero(seen, hn::Sub(px, half)), v = hn::IfThenElseZero(seen, hn::Sub(py, half));
  const F left = hn::Floor(u), top = hn::Floor(v);
  const F right_part = hn::Sub(u, left), lower_part = hn::Sub(v, top);
  const F depth = load(moved.depth_mm, x, y);
  const F last_column = hn::Set(kD, static_cast<float>(depth_mm.width() - 1));
  const F last_row = hn::Set(kD, static_cast<float>(depth_mm.height() - 1));
  Bilinear at;
  at.offset = hn::Add(hn::Mul(hn::ConvertTo(integers, top), hn::Set(integers, depth_mm.stride())),
                      hn::ConvertTo(integers, left));
  F sum = zero;
  for (int i = 0; i < 4; ++i) {
    const bool to_right = i % 2 == 1, below = i / 2 == 1;
    const F column = to_right ? hn::Add(left, one) : left, row = below ? hn::Add(top, one) : top;
    auto inside = hn::And(hn::Ge(column, zero), hn::Le(column, last_column));
    inside = hn::And(inside, hn::And(hn::Ge(row, zero), hn::Le(row, last_row)));
    const F there = hn::GatherIndex(kD, depth_mm.row(below) + to_right, at.offset);
    const F apart = hn::Mul(hn::AbsDiff(there, depth), hn::Set(kD, inverse_depth_sigma));
    const F alike = hn::IfThenElse(hn::Gt(there, zero), exp_approx(hn::Neg(apart)), one);
    const F weight = hn::Mul(to_right ? right_part : hn::Sub(one, right_part),
                             below ? lower_part : hn::Sub(one, lower_part));
    at.weights[i] = hn::IfThenElseZero(hn::And(seen, inside), hn::Mul(weight, alike));
    sum = hn::Add(sum, at.weights[i]);
  }
  const F norm = hn::IfThenElseZero(hn::Gt(sum, hn::Set(kD, 0.05f)), hn::Div(one, sum));
  for (F& weight : at.weights) weight = hn::Mul(weight, norm);
  return at;
}

HWY_INLINE F gather(const Plane& plane, const Bilinear& at) {
  F sum = hn::Zero(kD);
  for (int i = 0; i < 4; ++i)
    sum = hn::MulAdd(hn::GatherIndex(kD, plane.row(i / 2) + i % 2, at.offset), at.weights[i], sum);
  return sum;
}
HWY_INLINE F3 gather(const Planes3& planes, const Bilinear& at) {
  return {gather(planes[0], at), gather(planes[1], at), gather(planes[2], at)};
}

/// False of what is no number, too.
HWY_INLINE hn::Mask<Floats> is_known(const PictureMemory& prior, int x, int y) {
  return hn::Lt(load(prior.residual_variance, x, y), hn::Set(kD, 0.5f * PictureMemory::kUnknown));
}

/// What the memory has of this frame, and how far the frame is from it.
void predict_row(const DenoiseFrame& frame, const DenoisedFrame& picture, const Reprojection& moved,
                 const PictureMemory& memory, float inverse_depth_sigma, int y, PictureMemory& prior,
                 Innovation& off) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const Bilinear at = place_before(moved, memory.depth_mm, inverse_depth_sigma, x, y);
    const auto known = hn::Gt(
        hn::Add(hn::Add(at.weights[0], at.weights[1]), hn::Add(at.weights[2], at.weights[3])), hn::Zero(kD));
    const F3 filtered = gather(memory.filtered, at), residual = gather(memory.residual, at);
    store(filtered, prior.filtered, x, y, lanes);
    store(residual, prior.residual, x, y, lanes);
    store(gather(memory.alpha, at), prior.alpha, x, y, lanes);
    store(gather(memory.alpha_residual, at), prior.alpha_residual, x, y, lanes);
    const F unknown = hn::Set(kD, PictureMemory::kUnknown);
    store(hn::IfThenElse(known, gather(memory.filtered_variance, at), unknown), prior.filtered_variance, x, y,
          lanes);
    store(hn::IfThenElse(known, gather(memory.residual_variance, at), unknown), prior.residual_variance, x, y,
          lanes);
    const F3 now = load_filtered(frame, picture, x, y);
    const F3 off_filtered = choose(known, sub(now, filtered), zero3());
    const F3 residual_now = sub(load(frame.radiance, x, y), now);
    const F off_residual = hn::IfThenElseZero(known, luminance(sub(residual_now, residual)));
    store(off_filtered, off.filtered, x, y, lanes);
    store(squared(luminance(off_filtered)), off.filtered_squared, x, y, lanes);
    store(off_residual, off.residual, x, y, lanes);
    store(squared(off_residual), off.residual_squared, x, y, lanes);
  });
}

/// By how much light has changed around a pixel, as far as it is more than noise, and the mean squared
/// innovation that this does not explain.
struct LightChange {
  F3 factor;
  F unexplained;
};

HWY_INLINE LightChange light_change(const Innovation& off, const Planes3& prior_mean, F variance, int x,
                                    int y) {
  const F3 shift = load(off.filtered, x, y), level = load(prior_mean, x, y);
  const F shift_squared = squared(luminance(shift));
  const F noise = hn::Mul(variance, hn::Set(kD, kFilteredMeanVariance));
  const F share = signal_share(shift_squared, hn::Add(shift_squared, noise));
  const auto factor = [&](F by, F of) {
    const F growth = hn::Div(hn::Mul(by, share), hn::Add(of, hn::Set(kD, 1e-20f)));
    return hn::Add(hn::Set(kD, 1.0f), hn::Min(hn::Max(growth, hn::Set(kD, -0.5f)), hn::Set(kD, 1.0f)));
  };
  // Moved by share times its mean, the innovation keeps (1 - share)^2 of the mean's square.
  const F explained = hn::Mul(hn::Mul(share, hn::Sub(hn::Set(kD, 2.0f), share)), shift_squared);
  return {{factor(shift.x, level.x), factor(shift.y, level.y), factor(shift.z, level.z)},
          positive(hn::Sub(load(off.filtered_squared, x, y), explained))};
}

/// How much the present counts: p / (p + noise), with p the prediction's mean squared error.
HWY_INLINE F gain(hn::Mask<Floats> known, F prior_variance, F change, F noise, float least) {
  const F p = hn::Add(prior_variance, change);
  const F k = hn::Max(share_of(p, hn::Add(p, noise)), hn::Set(kD, least));
  return hn::IfThenElse(known, k, hn::Set(kD, 1.0f));
}

/// The memory of a frame with nothing before it; `picture` keeps its filtered part.
void begin_row(const DenoiseFrame& frame, const Plane& variance, int y, DenoisedFrame& picture,
               PictureMemory& now) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F v = load(variance, x, y), alpha = load(picture.alpha, x, y);
    const F3 filtered = load_filtered(frame, picture, x, y);
    store(filtered, now.filtered, x, y, lanes);
    store(sub(load(frame.radiance, x, y), filtered), now.residual, x, y, lanes);
    store(alpha, now.alpha, x, y, lanes);
    store(hn::Sub(load(frame.alpha, x, y), alpha), now.alpha_residual, x, y, lanes);
    store(hn::Mul(v, hn::Set(kD, kFilteredVariance)), now.filtered_variance, x, y, lanes);
    store(v, now.residual_variance, x, y, lanes);
    store(load(frame.depth_mm, x, y), now.depth_mm, x, y, lanes);
    store(filtered, picture.radiance, x, y, lanes);
  });
}

/// The memory of this frame; `picture` gets its filtered part.
void update_row(const DenoiseFrame& frame, const PictureMemory& prior, const Planes3& prior_mean,
                const Innovation& off, const Plane& variance, int y, DenoisedFrame& picture,
                PictureMemory& now) {
  for_row(frame.width, [&](int x, std::size_t lanes) {
    // Innovations that are no numbers or infinite have nothing to say of the past.
    const F all = hn::Add(hn::Add(load(off.filtered_squared, x, y), load(off.residual_squared, x, y)),
                          hn::Add(hn::Abs(luminance(load(prior.filtered, x, y))),
                                  hn::Abs(luminance(load(prior.residual, x, y)))));
    const auto known = hn::And(is_known(prior, x, y), hn::Lt(all, hn::Set(kD, PictureMemory::kUnknown)));
    const F v = load(variance, x, y), filtered_noise = hn::Mul(v, hn::Set(kD, kFilteredVariance));
    const LightChange light = light_change(off, prior_mean, v, x, y);
    const F filtered_prior = load(prior.filtered_variance, x, y);
    const F filtered_change = positive(hn::Sub(light.unexplained, hn::Add(filtered_prior, filtered_noise)));
    const F k = gain(known, filtered_prior, filtered_change, filtered_noise, kLeastFilteredGain);
    const F residual_prior = load(prior.residual_variance, x, y), expected = hn::Add(residual_prior, v);
    const F beyond_square =
        hn::NegMulAdd(expected, hn::Set(kD, kSquareMargin), load(off.residual_squared, x, y));
    const F beyond_mean =
        hn::NegMulAdd(expected, hn::Set(kD, kMeanMargin / kWindow), squared(load(off.residual, x, y)));
    const F k_residual =
        gain(known, residual_prior, positive(hn::Max(beyond_square, beyond_mean)), v, kLeastResidualGain);
    const F3 filtered = load_filtered(frame, picture, x, y);
    const F3 residual = sub(load(frame.radiance, x, y), filtered);
    const F alpha = load(picture.alpha, x, y), alpha_residual = hn::Sub(load(frame.alpha, x, y), alpha);
    const F3 filtered_before = choose(known, multiply(load(prior.filtered, x, y), light.factor), filtered);
    const F3 residual_before = choose(known, load(prior.residual, x, y), residual);
    const F alpha_before = hn::IfThenElse(known, load(prior.alpha, x, y), alpha);
    const F alpha_residual_before = hn::IfThenElse(known, load(prior.alpha_residual, x, y), alpha_residual);
    const F3 shown = add_scaled(filtered_before, sub(filtered, filtered_before), k);
    const F shown_alpha = hn::MulAdd(hn::Sub(alpha, alpha_before), k, alpha_before);
    store(shown, now.filtered, x, y, lanes);
    store(add_scaled(residual_before, sub(residual, residual_before), k_residual), now.residual, x, y, lanes);
    store(shown_alpha, now.alpha, x, y, lanes);
    store(hn::MulAdd(hn::Sub(alpha_residual, alpha_residual_before), k_residual, alpha_residual_before),
          now.alpha_residual, x, y, lanes);
    store(hn::Mul(filtered_noise, k), now.filtered_variance, x, y, lanes);
    store(hn::Mul(v, k_residual), now.residual_variance, x, y, lanes);
    store(load(frame.depth_mm, x, y), now.depth_mm, x, y, lanes);
    store(shown, picture.radiance, x, y, lanes);
    store(shown_alpha, picture.alpha, x, y, lanes);
  });
}

/// Gives back what filters took from a neighbourhood as a whole, as far as it is more than noise. `local` is
/// the residual's mean around a pixel and gets what is given back; `error`: the square of what is left.
void restore_row(const PictureMemory& now, const Plane& local_variance, int y, Planes3& local,
                 DenoisedFrame& picture, Plane& error) {
  for_row(picture.alpha.width(), [&](int x, std::size_t lanes) {
    const F3 lost = load(local, x, y);
    const F signal = squared(luminance(lost));
    const F noise = hn::Mul(load(local_variance, x, y), hn::Set(kD, 1.0f / kWindow));
    const F3 restored = scale(lost, signal_share(signal, hn::Add(signal, noise)));
    store(restored, local, x, y, lanes);
    store(add(load(picture.radiance, x, y), restored), picture.radiance, x, y, lanes);
    store(squared(luminance(sub(load(now.residual, x, y), restored))), error, x, y, lanes);
  });
}

/// Adds what is left of the residual, as far as the filters' mean squared error exceeds its variance.
void add_residual_row(const PictureMemory& now, const Planes3& restored, const Plane& error, int y,
                      DenoisedFrame& picture) {
  for_row(picture.alpha.width(), [&](int x, std::size_t lanes) {
    const F noise = load(now.residual_variance, x, y);
    const F bias_squared = positive(hn::Sub(load(error, x, y), noise));
    const F filter_error = hn::MulAdd(load(now.filtered_variance, x, y),
                                      hn::Set(kD, kFilteredError / kFilteredVariance), bias_squared);
    const F share = signal_share(filter_error, hn::Add(filter_error, noise));
    const F3 rest = sub(load(now.residual, x, y), load(restored, x, y));
    const F alpha = hn::MulAdd(load(now.alpha_residual, x, y), share, load(picture.alpha, x, y));
    store(positive(add_scaled(load(picture.radiance, x, y), rest, share)), picture.radiance, x, y, lanes);
    store(hn::Min(positive(alpha), hn::Set(kD, 1.0f)), picture.alpha, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <utility>

#include "base/parallel.h"

namespace voxlume {

HWY_EXPORT(luminance_row);
HWY_EXPORT(variance_row);
HWY_EXPORT(predict_row);
HWY_EXPORT(begin_row);
HWY_EXPORT(update_row);
HWY_EXPORT(restore_row);
HWY_EXPORT(add_residual_row);

namespace {

/// Matter that is farther away than this share of the scene's size is other matter.
constexpr float kDepthSigma = 0.03f;

template <class Body>
void for_rows(int height, const Body& body) {
  parallel_for(height, 8, [&](std::int64_t y) { body(static_cast<int>(y)); });
}

}  // namespace

void PictureMemory::resize(int width, int height) {
  filtered = residual = make_planes3(width, height);
  alpha = alpha_residual = filtered_variance = residual_variance = depth_mm = Plane(width, height);
}

void PictureHistory::resize(int width, int height) {
  if (variance_.width() != width || variance_.height() != height) {
    variance_ = error_ = Plane(width, height);
    restored_ = make_planes3(width, height);
    memory_.resize(width, height);
    now_ = prior_ = {};
    prior_mean_ = {};
    off_ = {};
    has_memory_ = false;
  }
  // Pictures of which none follows another need no more than that.
  if (!has_memory_ || off_.residual.width() == width) return;
  for (PictureMemory* memory : {&now_, &prior_}) memory->resize(width, height);
  prior_mean_ = off_.filtered = make_planes3(width, height);
  off_.filtered_squared = off_.residual = off_.residual_squared = Plane(width, height);
}

void PictureHistory::estimate_variance(const DenoiseFrame& frame) {
  for_rows(frame.height, [&](int y) { HWY_DYNAMIC_DISPATCH(luminance_row)(frame, y, error_); });
  local_mean_(error_, error_);
  for_rows(frame.height, [&](int y) { HWY_DYNAMIC_DISPATCH(variance_row)(frame, error_, y, variance_); });
  local_mean_(variance_, variance_);
}

void PictureHistory::predict(const DenoiseFrame& frame, const DenoisedFrame& picture) {
  const Reprojection& moved = reproject_(frame.camera, frame.depth_mm, camera_before_);
  for_rows(frame.height, [&](int y) {
    HWY_DYNAMIC_DISPATCH(predict_row)
    (frame, picture, moved, memory_, 1 / (kDepthSigma * frame.size_mm), y, prior_, off_);
  });
  for (int c = 0; c < 3; ++c) {
    local_mean_(prior_.filtered[c], prior_mean_[c]);
    local_mean_(off_.filtered[c], off_.filtered[c]);
  }
  for (Plane* plane : {&off_.filtered_squared, &off_.residual, &off_.residual_squared})
    local_mean_(*plane, *plane);
}

void PictureHistory::add_residual(DenoisedFrame& picture) {
  const int height = picture.alpha.height();
  for (int c = 0; c < 3; ++c) local_mean_(memory_.residual[c], restored_[c]);
  local_mean_(memory_.residual_variance, error_);
  for_rows(height, [&](int y) {
    HWY_DYNAMIC_DISPATCH(restore_row)(memory_, error_, y, restored_, picture, error_);
  });
  local_mean_(error_, error_);
  for_rows(height, [&](int y) {
    HWY_DYNAMIC_DISPATCH(add_residual_row)(memory_, restored_, error_, y, picture);
  });
}

void PictureHistory::blend(const DenoiseFrame& frame, DenoisedFrame& picture) {
  resize(frame.width, frame.height);
  estimate_variance(frame);
  if (has_memory_) {
    predict(frame, picture);
    for_rows(frame.height, [&](int y) {
      HWY_DYNAMIC_DISPATCH(update_row)(frame, prior_, prior_mean_, off_, variance_, y, picture, now_);
    });
    std::swap(memory_, now_);
  } else {
    for_rows(frame.height, [&](int y) {
      HWY_DYNAMIC_DISPATCH(begin_row)(frame, variance_, y, picture, memory_);
    });
  }
  add_residual(picture);
  camera_before_ = frame.camera;
  has_memory_ = true;
}

}  // namespace voxlume
#endif  // HWY_ONCE
