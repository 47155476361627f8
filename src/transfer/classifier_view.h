#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "grid/label_outline.h"
#include "transfer/transfer_view.h"
#include "voxlume/scene.h"

namespace voxlume {

/// The main volume and its proxies (xu2025 section 6.1: four at once).
inline constexpr int kMostVolumes = 4;
/// In the place of a volume's number: the opacity of the transfer function's own points.
inline constexpr int kOpacityVolume = kMostVolumes;
/// The rules of a scene, and its own points as the last.
inline constexpr int kMostRules = 17;

/// What a rule may give, as bits.
enum CoefficientBits : std::uint32_t {
  kGivesExtinction = 1,
  kGivesColor = 2,
  kGivesEmission = 4,
  kGivesMaterial = 8,
  kGivesFirstNumber = 16  ///< times 2^n for number n
};

/// Coefficients of the surface lobes and the phase function, then the channels of the extinction colour, in
/// the order of Classified::numbers.
enum class Number {
  kRoughness,
  kMetallic,
  kSpecular,
  kAnisotropy,
  kSurfaceShare,
  kExtinctionRed,
  kExtinctionGreen,
  kExtinctionBlue
};
inline constexpr int kNumberCount = 8;
inline constexpr int kLobeNumberCount = 5;  ///< those before the extinction colour
constexpr std::uint32_t gives(Number number) {
  return kGivesFirstNumber << static_cast<std::uint32_t>(number);
}

/// What one rule, or all of them merged, says of a point.
struct Classified {
  std::uint32_t given = 0;  ///< CoefficientBits; the members of the others mean nothing
  Coefficients optics{};
  float numbers[kNumberCount] = {};
  std::int32_t material = -1;
  /// The volume whose gradient is the surface's normal, and the one whose labels end there (-1: none): those
  /// of the rule that decides about the extinction.
  std::int32_t surface_volume = 0, label_volume = -1;

  float number_or(Number which, float otherwise) const noexcept {
    return given & gives(which) ? numbers[static_cast<int>(which)] : otherwise;
  }
  /// What multiplies mu_t channel by channel; white where nothing gives it.
  Vec3f extinction_color() const noexcept {
    return {number_or(Number::kExtinctionRed, 1), number_or(Number::kExtinctionGreen, 1),
            number_or(Number::kExtinctionBlue, 1)};
  }
};

/// The numbers and the material of a rule's column on [start, next piece's start).
struct NumberPiece {
  float start;          ///< data units; -inf for the first piece
  float anchor;         ///< data value at which the numbers hold
  std::uint32_t given;  ///< CoefficientBits; 0: the rule does not apply
  std::int32_t material;
  float numbers[kNumberCount], slopes[kNumberCount];
};

/// A rule as a function of its first volume.
struct ColumnView {
  TransferView optics;
  const NumberPiece* pieces = nullptr;
  std::int32_t piece_count = 0;
};

/// One transfer function. The five kinds differ in their pieces alone.
struct RuleView {
  std::int32_t volume = 0, along = -1;  ///< along: of a 2-D rule; -1: one column
  ColumnForm column_form = ColumnForm::kCurve;
  const ColumnView* columns = nullptr;
  const float* column_at = nullptr;
  std::int32_t column_count = 0;
  std::uint32_t given = 0;  ///< by any of its pieces
};

/// A volume as rules look it up.
struct RuleVolumeView {
  GridView grid;
  Affinef index_from_main;  ///< p_index of this volume from p_index of the main one
  bool is_main_grid = true;
  bool nearest = false;                 ///< labels: never interpolated
  const std::uint8_t* leads = nullptr;  ///< of labels with a smooth outline (label_leads)
  /// The volume whose gradient is the normal of surfaces in this one: itself, or the one that it measures.
  std::int32_t surface_volume = 0;
  float inverse_gradient_scale = 1;  ///< 1 / its usual gradient magnitude [mm per data unit]

  Vec3f index_of(Vec3f p_main) const noexcept {
    return is_main_grid ? p_main : index_from_main.point(p_main);
  }
};

/// The transfer functions of several volumes (xu2025 section 5): position in, optical properties out.
struct ClassifierView {
  const RuleView* rules = nullptr;
  std::int32_t rule_count = 0;  ///< 0: there are no rules, and the transfer function alone classifies
  Merge merge = Merge::kPriority;
  RuleVolumeView volumes[kMostVolumes];
  TransferView own_points;
  bool smooth_labels = true;  ///< whether borders of labels are surfaces
};

/// A volume's value at p_index of the main grid; NaN outside its own grid.
inline float look_up(const RuleVolumeView& volume, Vec3f p_main) noexcept {
  const Vec3f p = volume.index_of(p_main);
  if (!volume.is_main_grid && !volume.grid.index_box().contains(p))
    return std::numeric_limits<float>::quiet_NaN();
  if (!volume.nearest) return sample_trilinear(volume.grid, p);
  return volume.leads ? sample_outline(volume.grid, volume.leads, p) : sample_nearest(volume.grid, p);
}

/// The volumes' values at one point, each looked up when it is first asked for.
class VolumeValues {
 public:
  VolumeValues(const ClassifierView& classifier, Vec3f p_main, float data) noexcept
      : classifier_(classifier), p_main_(p_main) {
    values_[0] = data;
  }

  float operator[](int volume) noexcept {
    if (known_ & (1u << volume)) return values_[volume];
    known_ |= 1u << volume;
    return values_[volume] =
               volume == kOpacityVolume ? opacity() : look_up(classifier_.volumes[volume], p_main_);
  }

 private:
  /// Nowhere, as NaN says, where the data is.
  float opacity() const noexcept {
    if (!(values_[0] == values_[0])) return values_[0];
    return opacity_of(classifier_.own_points, classify_mu_t(classifier_.own_points, values_[0]));
  }

  const ClassifierView& classifier_;
  const Vec3f p_main_;
  float values_[kMostVolumes + 1];
  std::uint32_t known_ = 1;
};

/// Two columns of a rule and how much of the second; first < 0: none applies.
struct ColumnPair {
  std::int32_t first, second;
  float share;
  friend bool operator==(const ColumnPair&, const ColumnPair&) = default;
};
inline ColumnPair columns_at(const RuleView& rule, float at) noexcept {
  if (rule.along < 0) return {0, 0, 0};
  if (!(at == at)) return {-1, -1, 0};
  const float* const end = rule.column_at + rule.column_count;
  const auto beyond = static_cast<std::int32_t>(std::upper_bound(rule.column_at, end, at) - rule.column_at);
  switch (rule.column_form) {
    case ColumnForm::kPoints:
      if (beyond == 0 || rule.column_at[beyond - 1] != at) return {-1, -1, 0};
      return {beyond - 1, beyond - 1, 0};
    case ColumnForm::kSteps:
      return {beyond - 1, beyond - 1, 0};
    case ColumnForm::kCurve:
      break;
  }
  if (beyond == 0) return {0, 0, 0};
  if (beyond == rule.column_count) return {beyond - 1, beyond - 1, 0};
  const float lower = rule.column_at[beyond - 1];
  return {beyond - 1, beyond, (at - lower) / (rule.column_at[beyond] - lower)};
}

/// Extinction [1/mm] by a rule that gives one; 0 where it does not apply.
inline float rule_mu_t(const RuleView& rule, float value, float at) noexcept {
  const ColumnPair pair = columns_at(rule, at);
  if (pair.first < 0) return 0;
  const float first = classify_mu_t(rule.columns[pair.first].optics, value);
  if (pair.first == pair.second) return first;
  return first + pair.share * (classify_mu_t(rule.columns[pair.second].optics, value) - first);
}

/// Opacity 1 is an extinction of -ln(1 - 0.9999) over the reference length; such a factor changes nothing.
inline constexpr float kSaturated = 0.9999f;

/// The extinction from the product of several factors opacity / kSaturated, of which, and of whose
/// extinctions, these are the least.
inline float mu_t_of_product(float product, float least_factor, float least_mu_t,
                             float reference_length_mm) noexcept {
  if (!(least_mu_t > 0)) return 0;
  if (product == least_factor) return least_mu_t;
  return std::min(-std::log1p(-kSaturated * product) / reference_length_mm, least_mu_t);
}

/// The extinction of several rules that give one, in their order. Each of its arguments, grown, never lowers
/// the result of product and maximum.
inline float merged_mu_t(Merge merge, const float* mu_t, int count, float reference_length_mm) noexcept {
  if (merge == Merge::kPriority) {
    for (int i = 0; i < count; ++i)
      if (mu_t[i] > 0) return mu_t[i];
    return 0;
  }
  if (merge == Merge::kMaximum) {
    float most = 0;
    for (int i = 0; i < count; ++i) most = std::max(most, mu_t[i]);
    return most;
  }
  float opacity = 1, least_opacity = 1, least = std::numeric_limits<float>::infinity();
  for (int i = 0; i < count; ++i) {
    const float own = std::min(one_minus_exp(mu_t[i] * reference_length_mm) / kSaturated, 1.0f);
    opacity *= own;
    least_opacity = std::min(least_opacity, own);
    least = std::min(least, mu_t[i]);
  }
  return count == 0 ? 0 : mu_t_of_product(opacity, least_opacity, least, reference_length_mm);
}

/// Extinction [1/mm] at p_index of the main grid, where its data is `data`.
inline float classify_mu_t(const ClassifierView& classifier, Vec3f p_main, float data) noexcept {
  VolumeValues values(classifier, p_main, data);
  float mu_t[kMostRules];
  int count = 0;
  for (int i = 0; i < classifier.rule_count; ++i) {
    const RuleView& rule = classifier.rules[i];
    if (!(rule.given & kGivesExtinction)) continue;
    const float value = values[rule.volume];
    // NaN is nowhere; what it is along need not be looked up either.
    mu_t[count] = value == value ? rule_mu_t(rule, value, rule.along < 0 ? 0.0f : values[rule.along]) : 0.0f;
    if (classifier.merge == Merge::kPriority && mu_t[count] > 0) return mu_t[count];
    if (classifier.merge == Merge::kProduct && !(mu_t[count] > 0)) return 0;
    ++count;
  }
  return merged_mu_t(classifier.merge, mu_t, count, classifier.own_points.reference_length_mm);
}

/// All that the rules say of the point.
Classified classify(const ClassifierView& classifier, Vec3f p_main, float data) noexcept;

}  // namespace voxlume
