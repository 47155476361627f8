// Bounds of one rule in many cells, against look-ups of all that a cell may hold.
#include <gtest/gtest.h>

#include "sampling/elementary.h"
#include "support/every_target.h"
#include "support/random_rules.h"
#include "transfer/opacities.h"

namespace voxlume {
namespace {

using test::RandomRules;
using test::RuleVolumeSet;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr int kCells = 301;

RuleVolumeSet volumes() {
  RuleVolumeSet out(test::row_volume({-1000, 1500, 3}));
  out.add("gradient", test::row_volume({0, 300}), Lookup::kLinear);
  out.add("organs", test::row_volume({0, 1, 2, 3, 4, 5, 6}), Lookup::kNearest);
  return out;
}

/// What cells hold of one volume, and the tables that CellValues points to.
struct Held {
  std::vector<ValueRange> ranges;
  LabelSets sets;
  CellValues cells;

  Held(bool by_labels, ValueRange all, std::vector<float> breakpoints, bool complete, Rng& rng) {
    cells.complete = complete;
    if (by_labels)
      make_sets(all, rng);
    else
      make_ranges(all, breakpoints, rng);
  }

  void make_ranges(ValueRange all, const std::vector<float>& breakpoints, Rng& rng) {
    const auto value = [&] {
      if (rng.next() < 0.3f && !breakpoints.empty())
        return breakpoints[static_cast<std::size_t>(rng.next() * static_cast<float>(breakpoints.size()))];
      return all.lower + (all.upper - all.lower) * (1.2f * rng.next() - 0.1f);
    };
    for (int n = 0; n < kCells; ++n) {
      const float a = value(), b = rng.next() < 0.2f ? a : value();
      ranges.push_back({std::min(a, b), std::max(a, b)});
      if (n % 29 == 7) ranges.back() = {1, 0};
      if (n % 29 == 8) ranges.back() = {3e38f, -3e38f};
    }
    cells.ranges = ranges.data();
  }

  void make_sets(ValueRange all, Rng& rng) {
    sets.begin = {0, 0};
    for (int s = 0; s < 40; ++s) {
      for (float label = all.lower; label <= all.upper; ++label)
        if (rng.next() < 0.3f) sets.labels.push_back(label);
      sets.begin.push_back(static_cast<std::uint32_t>(sets.labels.size()));
    }
    while (sets.set_of_cell.size() < kCells)
      sets.set_of_cell.resize(
          std::min<std::size_t>(kCells, sets.set_of_cell.size() + 1 + std::size_t(9 * rng.next())),
          static_cast<std::uint32_t>(rng.next() * 41));
    cells.sets = &sets;
    cells.set_of_cell = sets.set_of_cell.data();
  }

  /// Values in a cell, among them all at which a function with these breakpoints has its extremes.
  std::vector<float> values(int cell, const std::vector<float>& breakpoints) const {
    if (cells.sets) {
      const auto set = sets.set(sets.set_of_cell[cell]);
      return {set.begin(), set.end()};
    }
    const ValueRange range = ranges[cell];
    if (range.empty()) return {};
    std::vector<float> out{range.lower, range.upper, 0.5f * (range.lower + range.upper)};
    for (const float at : breakpoints)
      for (const float value : {at, std::nextafter(at, -kInfinity)})
        if (value >= range.lower && value <= range.upper) out.push_back(value);
    return out;
  }
};

/// A rule, and where its pieces and its columns begin.
struct Compiled {
  CompiledRule rule;
  RuleView view;
  std::vector<float> pieces, columns;

  static int number_of(const std::string& name, std::span<const RuleVolume> all) {
    if (name == "opacity") return kOpacityVolume;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (all[i].name == name) return static_cast<int>(i);
    return -1;
  }
  Compiled(const RuleDescription& from, const RuleVolumeSet& set,
           std::span<const NamedMaterialDescription> materials)
      : rule(from, number_of(from.volume, set.all()), number_of(from.along, set.all()),
             {0.7, 1.5, materials}),
        view(rule.view()),
        columns(view.column_at, view.column_at + (view.along < 0 ? 0 : view.column_count)) {
    for (int c = 0; c < view.column_count; ++c)
      for (int p = 1; p < view.columns[c].optics.piece_count; ++p)
        pieces.push_back(view.columns[c].optics.pieces[p].start);
  }
};

/// Of labels, sets or the range that they are in.
Held held(int volume, bool ranges, const RuleVolumeSet& set, const std::vector<float>& breakpoints,
          bool complete, Rng& rng) {
  if (volume == kOpacityVolume) return Held(false, {0, 1}, breakpoints, complete, rng);
  const RuleVolume& of = set.all()[static_cast<std::size_t>(std::max(volume, 0))];
  return Held(of.view.nearest && !ranges, of.values, breakpoints, complete, rng);
}

/// The bounds that find_bounds should give: of columns, then of what lies between them.
struct Expected {
  float upper = 0, lower = kInfinity;
  void add(const RuleView& rule, const ColumnPair& pair, const std::vector<float>& values) {
    if (pair.first < 0) return void(lower = 0);
    float most[2] = {0, 0}, least = values.empty() ? 0 : kInfinity;
    for (int i = 0; i < 2; ++i)
      for (const float value : values) {
        const float mu_t = classify_mu_t(rule.columns[i ? pair.second : pair.first].optics, value);
        most[i] = std::max(most[i], mu_t);
        least = std::min(least, mu_t);
      }
    upper = std::max(upper, most[0] + pair.share * (most[1] - most[0]));
    lower = std::min(lower, least);
  }
};

TEST(BoundRule, HoldsEveryLookUpAndIsNoLooserThanItsColumns) {
  const RuleVolumeSet set = volumes();
  const auto materials = test::random_rule_materials();
  Rng rng(31, 0, 0, 0);
  RandomRules random(set, rng);
  int positive = 0, hidden = 0;
  for (int n = 0; n < 400; ++n) {
    SCOPED_TRACE("rule " + std::to_string(n));
    const Compiled c(random.rule(true), set, materials);
    if (!c.rule.gives_extinction()) continue;
    const bool complete = n % 3 != 0;
    Held value = held(c.view.volume, n % 7 == 3, set, c.pieces, complete, rng);
    Held along = held(c.view.along, n % 4 == 1, set, c.columns, complete || n % 2, rng);
    const int count = n % 5 == 0 ? 1 + n % 40 : kCells;
    std::vector<float> upper(kCells + 1, -1.0f), lower(kCells + 1, -1.0f);
    c.rule.find_bounds<Bound::kUpper>(value.cells, along.cells, count, upper.data());
    c.rule.find_bounds<Bound::kLower>(value.cells, along.cells, count, lower.data());
    EXPECT_EQ(upper[count], -1.0f);
    EXPECT_EQ(lower[count], -1.0f);
    const bool two = c.view.along >= 0;
    const bool gaps =
        two && (!along.cells.complete || (c.view.column_form == ColumnForm::kPoints && !along.cells.sets));
    for (int cell = 0; cell < count; ++cell) {
      const std::vector<float> values = value.values(cell, c.pieces);
      Expected expected;
      for (const float at : two ? along.values(cell, c.columns) : std::vector<float>{0}) {
        expected.add(c.view, columns_at(c.view, at), values);
        for (const float v : values) {
          const float mu_t = rule_mu_t(c.view, v, at);
          ASSERT_LE(mu_t, upper[cell] * (1 + 1e-6f)) << "cell " << cell << ", value " << v << " at " << at;
          ASSERT_GE(mu_t, lower[cell] * (1 - 1e-6f)) << "cell " << cell << ", value " << v << " at " << at;
        }
      }
      ASSERT_LE(upper[cell], expected.upper * (1 + 1e-4f) + 1e-6f) << "cell " << cell;
      const bool nowhere = !complete || gaps || expected.lower == kInfinity;
      ASSERT_GE(lower[cell], nowhere ? 0 : expected.lower * (1 - 1e-4f) - 1e-6f) << "cell " << cell;
      ASSERT_LE(lower[cell], nowhere ? 0 : expected.lower * (1 + 1e-6f)) << "cell " << cell;
      positive += upper[cell] > 0;
      hidden += lower[cell] > 0;
    }
  }
  EXPECT_GT(positive, 20000);
  EXPECT_GT(hidden, 3000);
}

TEST(FindOpacities, GivesTheScalarNumbers) {
  Rng rng(32, 0, 0, 0);
  std::vector<float> mu_t{0, 1e-30f, 1e-6f, 9.21f, 100, 1e30f};
  while (mu_t.size() < 203) mu_t.push_back(20 * rng.next() * rng.next());
  test::for_every_target([&] {
    std::vector<float> found = mu_t;
    simd::find_opacities(found.data(), static_cast<int>(found.size()), 0.7f, found.data());
    for (std::size_t i = 0; i < found.size(); ++i)
      ASSERT_EQ(found[i], one_minus_exp(mu_t[i] * 0.7f)) << mu_t[i];
  });
}

}  // namespace
}  // namespace voxlume
