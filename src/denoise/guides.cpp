#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "denoise/guides.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "base/parallel.h"
#include "denoise/guides-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {

/// Depth that pixels side by side may differ by on any surface, in sizes of what is seen: the footprint of a
/// pixel in a picture of some 500 rows.
constexpr float kDepthFloor = 0.002f;
/// schied2017 section 4.4: sigma_n = 128, halved for squared distances.
constexpr float kNormalExponent = 64;
/// Squared length by which normals of single samples scatter about a surface in scanned data.
constexpr float kNormalScatter = 0.1f;

struct Features {
  F depth;
  F3 normal, albedo;
};

/// The mean around a pixel, weighted by alpha; zero without matter.
HWY_INLINE Features mean_around(const DenoiseFrame& frame, int x, int y) {
  Features sum{hn::Zero(kD), zero3(), zero3()};
  F weight = hn::Zero(kD);
  for (int dy = -2; dy <= 2; ++dy) {
    for (int dx = -2; dx <= 2; ++dx) {
      const F alpha = load(frame.alpha, x + dx, y + dy);
      weight = hn::Add(weight, alpha);
      sum.depth = hn::MulAdd(load(frame.depth_mm, x + dx, y + dy), alpha, sum.depth);
      sum.normal = add_scaled(sum.normal, load(frame.normal, x + dx, y + dy), alpha);
      sum.albedo = add_scaled(sum.albedo, load(frame.albedo, x + dx, y + dy), alpha);
    }
  }
  const auto any = hn::Gt(weight, hn::Zero(kD));
  const F part = hn::IfThenElseZero(any, hn::Div(hn::Set(kD, 1.0f), weight));
  return {hn::Mul(sum.depth, part), scale(sum.normal, part), scale(sum.albedo, part)};
}

HWY_INLINE F blend(hn::Mask<Floats> mask, F yes, F no) { return hn::IfThenElse(mask, yes, no); }
HWY_INLINE F3 blend(hn::Mask<Floats> mask, F3 yes, F3 no) {
  return {blend(mask, yes.x, no.x), blend(mask, yes.y, no.y), blend(mask, yes.z, no.z)};
}

/// The smaller difference in depth to the two neighbours along an axis that have matter; 0 without one.
HWY_INLINE F slope(const Plane& depth_mm, F centre, int x, int y, int dx, int dy) {
  const F none = hn::Set(kD, 1e30f), zero = hn::Zero(kD);
  const F before = load(depth_mm, x - dx, y - dy), after = load(depth_mm, x + dx, y + dy);
  const F least = hn::Min(blend(hn::Gt(before, zero), hn::AbsDiff(before, centre), none),
                          blend(hn::Gt(after, zero), hn::AbsDiff(after, centre), none));
  return hn::IfThenElseZero(hn::Lt(least, none), least);
}

void make_row(const DenoiseFrame& frame, int y, Guides& out) {
  const F zero = hn::Zero(kD), one = hn::Set(kD, 1.0f);
  const F floor = hn::Set(kD, kDepthFloor * frame.size_mm);
  for_row(frame.width, [&](int x, std::size_t lanes) {
    const F alpha = load(frame.alpha, x, y);
    const auto matter = hn::Gt(alpha, zero);
    Features f{load(frame.depth_mm, x, y), load(frame.normal, x, y), load(frame.albedo, x, y)};
    if (!hn::AllTrue(kD, matter)) {
      const Features around = mean_around(frame, x, y);
      f = {blend(matter, f.depth, around.depth), blend(matter, f.normal, around.normal),
           blend(matter, f.albedo, around.albedo)};
    }
    const F steeper =
        hn::Max(slope(frame.depth_mm, f.depth, x, y, 1, 0), slope(frame.depth_mm, f.depth, x, y, 0, 1));
    const F scatter = hn::Max(hn::Sub(hn::Set(kD, 1 + kNormalScatter), dot(f.normal, f.normal)), zero);
    const F count = hn::Max(hn::Mul(alpha, load(frame.samples, x, y)), one);
    const F spread = hn::MulAdd(hn::Set(kD, 2.0f), hn::Div(scatter, count), hn::Set(kD, 1 / kNormalExponent));
    store(f.depth, out.depth_mm, x, y, lanes);
    store(f.normal, out.normal, x, y, lanes);
    store(f.albedo, out.albedo, x, y, lanes);
    store(hn::Div(one, hn::Add(steeper, floor)), out.depth_rate, x, y, lanes);
    store(hn::Div(one, spread), out.feature_rate, x, y, lanes);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace voxlume {

HWY_EXPORT(make_row);

void make_guides(const DenoiseFrame& frame, Guides& out) {
  if (out.depth_mm.width() != frame.width || out.depth_mm.height() != frame.height) {
    out.normal = out.albedo = make_planes3(frame.width, frame.height);
    out.depth_mm = out.depth_rate = out.feature_rate = Plane(frame.width, frame.height);
  }
  parallel_for(frame.height, 8, [&](std::int64_t y) {
    HWY_DYNAMIC_DISPATCH(make_row)(frame, static_cast<int>(y), out);
  });
}

}  // namespace voxlume
#endif  // HWY_ONCE
