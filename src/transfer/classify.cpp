#include "transfer/classifier_view.h"

namespace voxlume {
namespace {

Classified sample_column(const ColumnView& column, float value) noexcept {
  const auto before = [](float v, const NumberPiece& piece) { return v < piece.start; };
  const NumberPiece& piece =
      *(std::upper_bound(column.pieces + 1, column.pieces + column.piece_count, value, before) - 1);
  Classified out;
  out.given = piece.given;
  if (!out.given) return out;
  out.optics = classify(column.optics, value);
  const float offset = value - piece.anchor;
  for (int n = 0; n < kNumberCount; ++n) out.numbers[n] = piece.numbers[n] + piece.slopes[n] * offset;
  out.material = piece.material;
  return out;
}

/// Takes from `other` what `out` has not.
void fill_in(const Classified& other, Classified& out) noexcept {
  const std::uint32_t taken = other.given & ~out.given;
  if (taken & kGivesColor) out.optics.albedo = other.optics.albedo;
  if (taken & kGivesEmission) out.optics.emission = other.optics.emission;
  if (taken & kGivesMaterial) out.material = other.material;
  for (int n = 0; n < kNumberCount; ++n)
    if (taken & gives(static_cast<Number>(n))) out.numbers[n] = other.numbers[n];
  out.given |= taken;
}

/// What a rule says where its volumes have these values.
Classified sample_rule(const RuleView& rule, float value, float at) noexcept {
  if (!(value == value)) return {};
  const ColumnPair pair = columns_at(rule, at);
  if (pair.first < 0) return {};
  const Classified first = sample_column(rule.columns[pair.first], value);
  if (pair.first == pair.second) return first;
  const Classified second = sample_column(rule.columns[pair.second], value);
  // What one column alone gives is its own; extinction is interpolated in any case, as by rule_mu_t.
  Classified out = pair.share < 0.5f ? first : second;
  fill_in(pair.share < 0.5f ? second : first, out);
  const std::uint32_t both = first.given & second.given;
  const auto between = [&](auto a, auto b) { return a + (b - a) * pair.share; };
  out.optics.mu_t = between(first.optics.mu_t, second.optics.mu_t);
  // A column without matter has no colour.
  if (both & kGivesColor)
    out.optics.albedo = !(first.optics.mu_t > 0)    ? second.optics.albedo
                        : !(second.optics.mu_t > 0) ? first.optics.albedo
                                                    : between(first.optics.albedo, second.optics.albedo);
  if (both & kGivesEmission) out.optics.emission = between(first.optics.emission, second.optics.emission);
  for (int n = 0; n < kNumberCount; ++n)
    if (both & gives(static_cast<Number>(n))) out.numbers[n] = between(first.numbers[n], second.numbers[n]);
  return out;
}

/// Multiplies what both have.
void multiply(const Classified& other, Classified& out) noexcept {
  const std::uint32_t both = other.given & out.given;
  if (both & kGivesColor) out.optics.albedo *= other.optics.albedo;
  if (both & kGivesEmission) out.optics.emission *= other.optics.emission;
  for (int n = 0; n < kNumberCount; ++n)
    if (both & gives(static_cast<Number>(n))) out.numbers[n] *= other.numbers[n];
}

/// Notes which volumes make the surface of matter whose extinction is this rule's.
void note_surface(const ClassifierView& classifier, const RuleView& rule, Classified& out) noexcept {
  for (const std::int32_t volume : {rule.volume, rule.along}) {
    if (volume < 0 || volume == kOpacityVolume) continue;
    const RuleVolumeView& view = classifier.volumes[volume];
    if (!view.nearest) {
      if (volume == rule.volume) out.surface_volume = view.surface_volume;
    } else if (classifier.smooth_labels && out.label_volume < 0) {
      out.label_volume = volume;
    }
  }
}

}  // namespace

Classified classify(const ClassifierView& classifier, Vec3f p_main, float data) noexcept {
  VolumeValues values(classifier, p_main, data);
  Classified applies[kMostRules];
  const RuleView* rules[kMostRules];
  float mu_t[kMostRules];
  int count = 0, dense = 0, deciding = -1;
  for (int i = 0; i < classifier.rule_count; ++i) {
    const RuleView& rule = classifier.rules[i];
    Classified own = sample_rule(rule, values[rule.volume], rule.along < 0 ? 0.0f : values[rule.along]);
    const bool has_extinction = own.given & kGivesExtinction;
    if (!has_extinction) own.optics.mu_t = 0;
    if (rule.given & kGivesExtinction) mu_t[dense++] = own.optics.mu_t;
    if (has_extinction ? !(own.optics.mu_t > 0) : own.given == 0) continue;
    if (has_extinction && (deciding < 0 || (classifier.merge == Merge::kMaximum &&
                                            own.optics.mu_t > applies[deciding].optics.mu_t)))
      deciding = count;
    rules[count] = &rule;
    applies[count++] = own;
  }
  Classified out;
  out.optics.mu_t = merged_mu_t(classifier.merge, mu_t, dense, classifier.own_points.reference_length_mm);
  if (!(out.optics.mu_t > 0)) return {};
  out.given = kGivesExtinction;
  out.optics.albedo = Vec3f(0.8f);
  note_surface(classifier, *rules[deciding], out);
  if (classifier.merge == Merge::kMaximum) fill_in(applies[deciding], out);
  for (int i = 0; i < count; ++i) {
    if (classifier.merge == Merge::kProduct) multiply(applies[i], out);
    if (classifier.merge == Merge::kProduct && applies[i].given & kGivesExtinction)
      note_surface(classifier, *rules[i], out);
    fill_in(applies[i], out);
  }
  return out;
}

}  // namespace voxlume
