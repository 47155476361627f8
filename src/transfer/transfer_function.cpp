#include "transfer/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "transfer/curve.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kBuckets = 4096;
constexpr double kSaturatedOpacity = 0.9999;
const Vec3d kDefaultAlbedo(0.8);

[[noreturn]] void fail(std::size_t point, const std::string& message) {
  throw Error(ErrorCode::kBadParameter, "/transfer/points/" + std::to_string(point), message);
}

void validate(const TransferDescription& d) {
  if (!(d.reference_length_mm && *d.reference_length_mm > 0 && std::isfinite(*d.reference_length_mm)))
    throw Error(ErrorCode::kBadParameter, "/transfer/reference_length_mm", "expected a length above 0 mm");
  if (!(d.density_scale >= 0 && std::isfinite(d.density_scale)))
    throw Error(ErrorCode::kBadParameter, "/transfer/density_scale",
                "expected a finite number of at least 0");
  bool opacity = false, mu_t = false;
  for (std::size_t i = 0; i < d.points.size(); ++i) {
    const TransferPoint& p = d.points[i];
    if (!std::isfinite(static_cast<float>(p.value))) fail(i, "value is not a finite 32-bit float");
    if (i > 0 && p.value < d.points[i - 1].value) fail(i, "points must be sorted by value");
    if (p.opacity && !(*p.opacity >= 0 && *p.opacity <= 1)) fail(i, "opacity must be in [0,1]");
    if (p.mu_t_per_mm && !(*p.mu_t_per_mm >= 0 && std::isfinite(*p.mu_t_per_mm)))
      fail(i, "mu_t_per_mm must be finite and at least 0");
    opacity |= p.opacity.has_value();
    mu_t |= p.mu_t_per_mm.has_value();
    if (opacity && mu_t) fail(i, "a transfer function gives either opacity or mu_t_per_mm, not both");
  }
}

/// Adds the knots after (v0,o0) up to (v1,o1), so many that mu_t is linear in between to 1e-4 of itself in
/// the middle, which is 2e-4 anywhere. Knots are floats.
void refine_opacity(double v0, double o0, double v1, double o1, double reference_mm,
                    std::vector<std::pair<double, double>>& out, int depth = 0) {
  const double v = static_cast<float>(0.5 * (v0 + v1)), share = (v - v0) / (v1 - v0);
  const double o = o0 + (o1 - o0) * share;
  const double mu_t_0 = mu_t_from_opacity(o0, reference_mm), mu_t_1 = mu_t_from_opacity(o1, reference_mm);
  const double exact = mu_t_from_opacity(o, reference_mm);
  const double chord = mu_t_0 + (mu_t_1 - mu_t_0) * share;
  const bool floats_between = v0 < v && v < v1;
  if (!floats_between || depth > 24 || (depth > 0 && std::abs(chord - exact) <= 1e-4 * exact)) {
    out.emplace_back(v1, mu_t_1);
    return;
  }
  refine_opacity(v0, o0, v, o, reference_mm, out, depth + 1);
  refine_opacity(v, o, v1, o1, reference_mm, out, depth + 1);
}

/// Puts a knot where the curve passes the saturated opacity, at which mu_t has a kink.
void split_at_saturation(Curve<double>& opacity) {
  for (std::size_t i = 1; i < opacity.knots.size(); ++i) {
    const auto [v0, o0] = opacity.knots[i - 1];
    const auto [v1, o1] = opacity.knots[i];
    if (v0 == v1 || (o0 < kSaturatedOpacity) == (o1 < kSaturatedOpacity)) continue;
    const double v = static_cast<float>(v0 + (v1 - v0) * ((kSaturatedOpacity - o0) / (o1 - o0)));
    if (v <= v0 || v >= v1) continue;
    const double o = o0 + (o1 - o0) * ((v - v0) / (v1 - v0));
    opacity.knots.insert(opacity.knots.begin() + static_cast<std::ptrdiff_t>(i++), {v, o});
  }
}

Curve<double> extinction_curve(const TransferDescription& d) {
  Curve<double> mu_t = collect<double>(
      d.points, [](const auto& p) { return p.mu_t_per_mm; }, 0.0);
  Curve<double> opacity = collect<double>(
      d.points, [](const auto& p) { return p.opacity; }, 0.0);
  split_at_saturation(opacity);
  if (std::any_of(d.points.begin(), d.points.end(), [](const auto& p) { return p.opacity.has_value(); })) {
    mu_t.knots.clear();
    for (std::size_t i = 0; i < opacity.knots.size(); ++i) {
      const auto& [v1, o1] = opacity.knots[i];
      if (i == 0 || opacity.knots[i - 1].first == v1) {
        mu_t.knots.emplace_back(v1, mu_t_from_opacity(o1, *d.reference_length_mm));
      } else {
        refine_opacity(opacity.knots[i - 1].first, opacity.knots[i - 1].second, v1, o1,
                       *d.reference_length_mm, mu_t.knots);
      }
    }
  }
  for (auto& [value, y] : mu_t.knots) y *= d.density_scale;
  return mu_t;
}

}  // namespace

double mu_t_from_opacity(double opacity, double reference_length_mm) {
  return -std::log1p(-std::clamp(opacity, 0.0, kSaturatedOpacity)) / reference_length_mm;
}

TransferFunction::TransferFunction(const TransferDescription& d) {
  validate(d);
  reference_length_mm_ = static_cast<float>(d.density_scale > 0 ? *d.reference_length_mm / d.density_scale
                                                                : *d.reference_length_mm);
  const Curve<double> mu_t = extinction_curve(d);
  const Curve<Vec3d> albedo = collect<Vec3d>(
      d.points, [](const auto& p) { return to_vec(p.color); }, kDefaultAlbedo);
  const Curve<Vec3d> emission = collect<Vec3d>(
      d.points, [](const auto& p) { return to_vec(p.emission); }, Vec3d(0));

  std::vector<double> cuts;
  for (const auto& knot : mu_t.knots) cuts.push_back(knot.first);
  for (const auto& knot : albedo.knots) cuts.push_back(knot.first);
  for (const auto& knot : emission.knots) cuts.push_back(knot.first);
  std::sort(cuts.begin(), cuts.end());
  cuts.erase(std::unique(cuts.begin(), cuts.end(),
                         [](double a, double b) { return static_cast<float>(a) == static_cast<float>(b); }),
             cuts.end());

  // Piece i runs from cut i-1 to cut i; the first and last are constant.
  for (std::size_t i = 0; i <= cuts.size(); ++i) {
    const double v0 = i == 0 ? cuts.front() : cuts[i - 1];
    const double v1 = i < cuts.size() ? cuts[i] : cuts.back();
    const bool constant = i == 0 || i == cuts.size();
    const double per_unit = constant ? 0.0 : 1.0 / (v1 - v0);
    const auto slope = [&](auto lower, auto upper) { return (upper - lower) * per_unit; };
    TransferPiece piece;
    piece.start = i == 0 ? -kInfinity : static_cast<float>(v0);
    piece.anchor = static_cast<float>(v0);
    const bool above = i > 0;
    piece.mu_t = static_cast<float>(mu_t.limit(v0, above));
    piece.mu_t_slope = static_cast<float>(slope(mu_t.limit(v0, above), mu_t.limit(v1, false)));
    piece.albedo = Vec3f(albedo.limit(v0, above));
    piece.albedo_slope = Vec3f(slope(albedo.limit(v0, above), albedo.limit(v1, false)));
    piece.emission = Vec3f(emission.limit(v0, above));
    piece.emission_slope = Vec3f(slope(emission.limit(v0, above), emission.limit(v1, false)));
    pieces_.push_back(piece);
  }

  for (const TransferPiece& piece : pieces_)
    extinction_.push_back({piece.start, piece.anchor, piece.mu_t, piece.mu_t_slope});
  extinction_.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0, 0});

  fill_buckets();

  extremes_ = RangeExtremes(pieces_);
}

void TransferFunction::fill_buckets() {
  const float origin = pieces_[0].anchor, width = pieces_.back().start - origin;
  buckets_per_unit_ = width > 0 ? kBuckets / width : 0;
  // More than the rounding of a value's place among the buckets, so that look-ups need only go forward.
  const float slack = 1e-5f * (std::abs(origin) + width);
  const auto last = static_cast<std::int32_t>(pieces_.size()) - 1;
  std::int32_t piece = 0;
  for (int b = 0; b < kBuckets; ++b) {
    const float lower = origin + width * static_cast<float>(b) / kBuckets - slack;
    const float upper = origin + width * static_cast<float>(b + 1) / kBuckets + slack;
    while (b > 0 && piece < last && lower >= pieces_[piece + 1].start) ++piece;
    const bool crowded = piece + 2 <= last && (b + 1 == kBuckets || upper >= pieces_[piece + 2].start);
    bucket_piece_.push_back(crowded ? ~piece : piece);
    bucket_split_.push_back(extinction_[piece + 1].start);
  }
}

TransferView TransferFunction::view() const {
  TransferView view;
  view.pieces = pieces_.data();
  view.piece_count = static_cast<std::int32_t>(pieces_.size());
  view.extinction = extinction_.data();
  view.bucket_piece = bucket_piece_.data();
  view.bucket_split = bucket_split_.data();
  view.bucket_count = kBuckets;
  view.bucket_origin = pieces_[0].anchor;
  view.buckets_per_unit = buckets_per_unit_;
  view.reference_length_mm = reference_length_mm_;
  return view;
}

float TransferFunction::max_mu_t(float lower, float upper) const { return extremes_.maximum({lower, upper}); }

float TransferFunction::min_mu_t(float lower, float upper) const { return extremes_.minimum({lower, upper}); }

float TransferFunction::max_mu_t() const {
  return max_mu_t(-std::numeric_limits<float>::max(), std::numeric_limits<float>::max());
}

bool TransferFunction::emits() const {
  return std::any_of(pieces_.begin(), pieces_.end(), [](const TransferPiece& piece) {
    return piece.emission != Vec3f(0) || piece.emission_slope != Vec3f(0);
  });
}

}  // namespace voxlume
