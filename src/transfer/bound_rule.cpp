// Bounds of the extinction by one rule, in many cells at once.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "transfer/rule.h"

namespace voxlume {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// What is picked of nothing.
template <Bound kBound>
constexpr float kNothing = kBound == Bound::kUpper ? 0.0f : kInfinity;

template <Bound kBound>
float pick(float a, float b) {
  return kBound == Bound::kUpper ? (a < b ? b : a) : (b < a ? b : a);
}

/// Of a rule between two columns.
template <Bound kBound>
float between(float first, float second, float share) {
  return kBound == Bound::kUpper ? first + share * (second - first) : pick<kBound>(first, second);
}

/// A run [from, to] of what columns are along, in which two columns count, or one, or none (-1).
struct Section {
  float from, to;
  int first, second;
};

/// The sections of a rule, in order, are those of 0 .. column_count; discrete columns have nothing between.
Section section_of(const RuleView& rule, int number) {
  const int below = number - 1, last = rule.column_count - 1;
  const float from = below < 0 ? -kInfinity : rule.column_at[below];
  const float to = below == last ? kInfinity : std::nextafter(rule.column_at[number], -kInfinity);
  switch (rule.column_form) {
    case ColumnForm::kPoints:
      return {from, from, below, below};
    case ColumnForm::kSteps:
      return {from, to, below, below};
    case ColumnForm::kCurve:
      break;
  }
  return {from, to, std::max(below, 0), std::min(number, last)};
}

bool touches(const ValueRange& range, const Section& section) {
  return (range.lower <= range.upper) & (range.upper >= section.from) & (range.lower <= section.to);
}

/// Picks from what two columns, `width` apart, make of a section; a cell's ends there are the extremes.
template <Bound kBound>
void pick_slope(const Section& section, float width, const ValueRange* along, const float* first,
                const float* second, int count, float* mu_t) {
  for (int n = 0; n < count; ++n) {
    const float begin = std::max(along[n].lower, section.from);
    const float end = along[n].upper <= section.to ? along[n].upper : begin;  // else the next one's begin
    const float bound = pick<kBound>(between<kBound>(first[n], second[n], (begin - section.from) / width),
                                     between<kBound>(first[n], second[n], (end - section.from) / width));
    mu_t[n] = touches(along[n], section) ? pick<kBound>(mu_t[n], bound) : mu_t[n];
  }
}

template <Bound kBound>
void pick_plateau(const Section& section, const ValueRange* along, const float* column, int count,
                  float* mu_t) {
  for (int n = 0; n < count; ++n) {
    const float bound = pick<kBound>(mu_t[n], column[n]);
    mu_t[n] = touches(along[n], section) ? bound : mu_t[n];
  }
}

ValueRange all_of(const ValueRange* ranges, int count) {
  // Several at a time, which vectors do at once.
  constexpr int kLanes = 8;
  float lower[kLanes], upper[kLanes];
  std::fill_n(lower, kLanes, kInfinity);
  std::fill_n(upper, kLanes, -kInfinity);
  const auto add = [&](const ValueRange& range, int lane) {
    lower[lane] = pick<Bound::kLower>(lower[lane], range.lower);
    upper[lane] = pick<Bound::kUpper>(upper[lane], range.upper);
  };
  int n = 0;
  for (; n + kLanes <= count; n += kLanes)
    for (int lane = 0; lane < kLanes; ++lane) add(ranges[n + lane], lane);
  for (; n < count; ++n) add(ranges[n], 0);
  return {*std::min_element(lower, lower + kLanes), *std::max_element(upper, upper + kLanes)};
}

}  // namespace

template <Bound kBound>
void CompiledRule::bound_column(int column, const CellValues& values, int count, float* mu_t) const {
  const TransferFunction& optics = columns_[column].optics;
  if (kBound == Bound::kLower && !values.complete) {
    std::fill_n(mu_t, count, 0.0f);
  } else if (!values.sets) {
    if (kBound == Bound::kUpper)
      optics.extremes().find_maxima(values.ranges, count, 1.0f, mu_t);
    else
      optics.extremes().find_minima(values.ranges, count, mu_t);
  } else {
    const TransferView view = optics.view();
    for (int n = 0, end; n < count; n = end) {
      end = values.end_of_set(n, count);
      const std::span<const float> labels = values.sets->set(values.set_of_cell[n]);
      float bound = labels.empty() ? 0 : kNothing<kBound>;
      for (const float label : labels) bound = pick<kBound>(bound, classify_mu_t(view, label));
      std::fill(mu_t + n, mu_t + end, bound);
    }
  }
}

/// The bounds of columns in some cells, each found when it is first asked for.
template <Bound kBound>
class CompiledRule::ColumnBounds {
 public:
  ColumnBounds(const CompiledRule& rule, const CellValues& values, int count)
      : rule_(rule),
        values_(values),
        count_(count),
        known_(rule.columns_.size()),
        mu_t_(new float[rule.columns_.size() * kCellsAtOnce]) {}

  const float* operator[](int column) {
    float* const mu_t = &mu_t_[static_cast<std::size_t>(column) * kCellsAtOnce];
    if (!known_[column]) rule_.bound_column<kBound>(column, values_, count_, mu_t);
    known_[column] = true;
    return mu_t;
  }

 private:
  const CompiledRule& rule_;
  const CellValues& values_;
  const int count_;
  std::vector<bool> known_;
  const std::unique_ptr<float[]> mu_t_;
};

template <Bound kBound>
void CompiledRule::bound_along_labels(const CellValues& values, const CellValues& along, int count,
                                      float* mu_t) const {
  const RuleView rule = view();
  ColumnBounds<kBound> columns(*this, values, count);
  for (int begin = 0, end; begin < count; begin = end) {
    end = along.end_of_set(begin, count);
    const std::span<const float> labels = along.sets->set(along.set_of_cell[begin]);
    std::fill(mu_t + begin, mu_t + end, labels.empty() ? 0 : kNothing<kBound>);
    ColumnPair before{-2, -2, 0};
    for (const float label : labels) {
      const ColumnPair pair = columns_at(rule, label);
      if (pair == before) continue;
      before = pair;
      if (pair.first < 0) {
        if (kBound == Bound::kLower) std::fill(mu_t + begin, mu_t + end, 0.0f);
        continue;
      }
      const float *first = columns[pair.first], *second = columns[pair.second];
      for (int n = begin; n < end; ++n)
        mu_t[n] = pick<kBound>(mu_t[n], between<kBound>(first[n], second[n], pair.share));
    }
  }
}

template <Bound kBound>
void CompiledRule::bound_along_ranges(const CellValues& values, const ValueRange* along, int count,
                                      float* mu_t) const {
  const RuleView rule = view();
  const ValueRange all = all_of(along, count);
  ColumnBounds<kBound> columns(*this, values, count);
  std::fill_n(mu_t, count, kNothing<kBound>);
  for (int number = 0; number <= rule.column_count; ++number) {
    const Section section = section_of(rule, number);
    if (section.to < all.lower || section.from > all.upper) continue;
    if (section.first != section.second) {
      const float width = rule.column_at[section.second] - section.from;
      pick_slope<kBound>(section, width, along, columns[section.first], columns[section.second], count, mu_t);
    } else if (section.first >= 0) {
      pick_plateau<kBound>(section, along, columns[section.first], count, mu_t);
    } else if (kBound == Bound::kLower) {
      for (int n = 0; n < count; ++n) mu_t[n] = touches(along[n], section) ? 0 : mu_t[n];
    }
  }
  for (int n = 0; n < count; ++n) mu_t[n] = mu_t[n] < kInfinity ? mu_t[n] : 0;
}

template <Bound kBound>
void CompiledRule::find_bounds(const CellValues& values, const CellValues& along, int count,
                               float* mu_t) const {
  const bool discrete = column_form_ == ColumnForm::kPoints && !along.sets;
  if (along_ < 0)
    bound_column<kBound>(0, values, count, mu_t);
  else if (kBound == Bound::kLower && (!along.complete || discrete))
    std::fill_n(mu_t, count, 0.0f);  // somewhere there is no column
  else if (along.sets)
    bound_along_labels<kBound>(values, along, count, mu_t);
  else
    bound_along_ranges<kBound>(values, along.ranges, count, mu_t);
}

template void CompiledRule::find_bounds<Bound::kUpper>(const CellValues&, const CellValues&, int,
                                                       float*) const;
template void CompiledRule::find_bounds<Bound::kLower>(const CellValues&, const CellValues&, int,
                                                       float*) const;

}  // namespace voxlume
