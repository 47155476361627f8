// Majorants under rules of several volumes, by brute force.
#include "accel/rule_bounds.h"

#include "accel/majorant_grid.h"
#include "hierarchy_words.h"
#include "support/random_rules.h"

namespace voxlume {
namespace {

using test::all_words;
using test::majorant_of;
using test::make_volume;
using test::mixed_volume;
using test::mu_t_function;
using test::noise_volume;
using test::opacity_point;
using test::Placement;
using test::rule_of;
using test::RuleVolumeSet;
using test::Size3;
using test::word_at;

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// Points of a volume's domain; many on faces, edges and corners of cells and of the domain.
Vec3f point_of(const Volume& main, int edge, Rng& rng, int n) {
  Vec3f p = test::random_point(main, rng);
  for (int a = 0; a < 3; ++a) {
    const float last = static_cast<float>(main.size[a]) - 0.5f;
    if (n % 3 == 0 && (n >> (3 + a) & 1)) p[a] = std::round(std::max(p[a], 0.0f) / edge) * edge;
    if (n % 5 == 0 && (n >> (6 + a) & 1)) p[a] = std::floor(p[a]) + 0.5f;  // between labels
    if (n % 7 == 0 && (n >> (6 + a) & 1)) p[a] = n & 64 ? -0.5f : last;
    p[a] = std::min(p[a], last);
  }
  return p;
}

/// Calls visit with the cells that hold p: several on faces.
template <class Visit>
void each_cell_with(Vec3f p, int edge, const std::int32_t (&count)[3], Visit&& visit) {
  int first[3], last[3];
  for (int a = 0; a < 3; ++a) {
    last[a] = std::clamp(static_cast<int>(std::floor(p[a] / edge)), 0, count[a] - 1);
    first[a] = last[a] - (last[a] > 0 && p[a] == static_cast<float>(last[a] * edge));
  }
  for (int k = first[2]; k <= last[2]; ++k)
    for (int j = first[1]; j <= last[1]; ++j)
      for (int i = first[0]; i <= last[0]; ++i) visit(i, j, k);
}

/// Both structures over one set of volumes.
struct Structures {
  Structures(const RuleVolumeSet& volumes, int cell_voxels)
      : edge(cell_voxels),
        hierarchy(volumes.main(), cell_voxels),
        grid(volumes.main(), cell_voxels),
        in_cubes(volumes.main(), cell_voxels, CellOrder::kCubes, volumes.all()),
        in_rows(volumes.main(), cell_voxels, CellOrder::kRows, volumes.all()) {}

  void update(const Classifier& classifier) {
    in_cubes.prepare(classifier);
    hierarchy.update(in_cubes);
    in_rows.prepare(classifier);
    grid.update(in_rows);
  }
  float finest(std::int32_t i, std::int32_t j, std::int32_t k) const {
    const MajorantView view = grid.view();
    return view.mu_maj[(std::int64_t{k} * view.cells[1] + j) * view.cells[0] + i];
  }

  int edge;
  MajorantHierarchy hierarchy;
  MajorantGrid grid;
  RuleBounds in_cubes, in_rows;
};

/// No mu_t at `draws` points is above the majorants of the cells that hold them. Blocks are the greatest of
/// their cells. Returns how many points have matter.
int expect_bounds(const RuleVolumeSet& volumes, const Classifier& classifier, const Structures& s, int draws,
                  std::uint64_t seed) {
  const ClassifierView view = classifier.view();
  const HierarchyView words = s.hierarchy.view();
  Rng rng(seed, 0, 0, 0);
  int visible = 0, violations = 0;
  for (int n = 0; n < draws; ++n) {
    const Vec3f p = point_of(volumes.voxels(0), s.edge, rng, n);
    const float mu_t = classify_mu_t(view, p, sample_trilinear(volumes.main(), p));
    visible += mu_t > 0;
    each_cell_with(p, s.edge, words.count, [&](int i, int j, int k) {
      const bool holds = mu_t <= majorant_of(word_at(words, i, j, k)) && mu_t <= s.finest(i, j, k);
      if (!holds && ++violations < 4)
        ADD_FAILURE() << "mu_t " << mu_t << " at " << p.x << " " << p.y << " " << p.z << ", majorants "
                      << majorant_of(word_at(words, i, j, k)) << " and " << s.finest(i, j, k);
    });
  }
  EXPECT_EQ(violations, 0);
  test::each_cell(words, [&](auto i, auto j, auto k) {
    ASSERT_GE(majorant_of(word_at(words, i, j, k)), s.finest(i, j, k)) << "of a block around " << i;
  });
  return visible;
}

/// Piecewise constant labels with some noise.
template <class T>
Volume label_volume(Size3 size, int labels, double holes, std::uint64_t seed, const Placement& place = {}) {
  Rng rng(seed, 0, 0, 0);
  return make_volume<T>(
      size,
      [&](auto i, auto j, auto k) -> double {
        const double u = static_cast<double>(rng.next());
        if (u < holes) return kNaN;
        const auto block = static_cast<std::uint32_t>(i / 4 + 5 * (j / 5) + 31 * (k / 3));
        return u < 0.95 ? block * 2654435761u % static_cast<std::uint32_t>(labels)
                        : std::floor(labels * static_cast<double>(rng.next()));
      },
      place);
}

const Size3 kSize{26, 23, 20};

/// A proxy placed in some way, and what is done with it.
struct Set {
  const char* name;
  RuleVolumeSet volumes;
};

std::vector<Set> volume_sets() {
  const auto main = [] { return mixed_volume<std::int16_t>(kSize, -1000, 1500); };
  std::vector<Set> sets;
  Placement shifted, turned = test::placements()[3], outside;
  shifted.origin_mm = {-4.3, -3.9, -2.2};
  turned.spacing_mm = {0.9, 1.3, 1.1};
  turned.origin_mm = {10, 4, 14};
  outside.origin_mm = {11.5, 9.25, 7};
  sets.push_back({"the same grid", RuleVolumeSet(main())});
  sets.back()
      .volumes.add("gradient", noise_volume<float>(kSize, 0, 300, 5), Lookup::kLinear)
      .add("organs", label_volume<std::uint8_t>(kSize, 7, 0, 6), Lookup::kNearest)
      .add("atlas", label_volume<std::uint16_t>(kSize, 900, 0, 7), Lookup::kNearest);
  sets.push_back({"shifted, and holds the main grid", RuleVolumeSet(main())});
  sets.back()
      .volumes.add("pet", noise_volume<float>({40, 40, 40}, 0, 20, 8, shifted), Lookup::kLinear)
      .add("organs", label_volume<std::uint8_t>({40, 40, 40}, 5, 0, 9, shifted), Lookup::kNearest)
      .add("atlas", label_volume<std::uint16_t>({40, 40, 40}, 600, 0, 10, shifted), Lookup::kNearest);
  sets.push_back({"turned", RuleVolumeSet(main())});
  sets.back()
      .volumes.add("pet", noise_volume<std::int16_t>({21, 19, 17}, -20, 20, 11, turned), Lookup::kLinear)
      .add("organs", label_volume<std::uint8_t>({21, 19, 17}, 5, 0, 12, turned), Lookup::kNearest)
      .add("atlas", label_volume<std::uint16_t>({21, 19, 17}, 600, 0, 13, turned), Lookup::kNearest);
  sets.push_back({"partly outside", RuleVolumeSet(main())});
  sets.back()
      .volumes.add("pet", noise_volume<float>({20, 20, 20}, 0, 20, 14, outside), Lookup::kLinear)
      .add("organs", label_volume<std::uint8_t>({20, 20, 20}, 5, 0, 15, outside), Lookup::kNearest);
  const auto with_holes = [&](Placement place) {
    Rng rng(16, 0, 0, 0);
    return make_volume<float>(
        {24, 24, 24},
        [&](auto i, auto, auto) {
          return i < 10 || rng.next() < 0.02f ? kNaN : 10 * static_cast<double>(rng.next());
        },
        place);
  };
  sets.push_back({"NaN in a proxy", RuleVolumeSet(main())});
  sets.back()
      .volumes.add("pet", with_holes(shifted), Lookup::kLinear)
      .add("organs", label_volume<float>({30, 30, 30}, 5, 0.2, 17, shifted), Lookup::kNearest);
  Rng rng(18, 0, 0, 0);
  sets.push_back({"NaN in the data", RuleVolumeSet(make_volume<float>(kSize, [&](auto i, auto, auto) {
                    return i < 9 || rng.next() < 0.01f ? kNaN : 2500 * static_cast<double>(rng.next()) - 1000;
                  }))});
  sets.back().volumes.add("organs", label_volume<std::uint8_t>(kSize, 5, 0, 19), Lookup::kNearest);
  sets.push_back({"smooth outlines", RuleVolumeSet(main())});
  sets.back()
      .volumes.add("organs", label_volume<std::uint8_t>(kSize, 7, 0, 20), Lookup::kNearest, Outline::kSmooth)
      .add("atlas", label_volume<std::uint16_t>({40, 40, 40}, 600, 0, 21, shifted), Lookup::kNearest,
           Outline::kSmooth)
      .add("turned", label_volume<float>({21, 19, 17}, 5, 0.2, 22, turned), Lookup::kNearest,
           Outline::kSmooth);
  return sets;
}

TEST(RuleBounds, HoldForRandomRules) {
  const auto materials = test::random_rule_materials();
  Rng rng(21, 0, 0, 0);
  for (const Set& set : volume_sets()) {
    SCOPED_TRACE(set.name);
    test::RandomRules random(set.volumes, rng);
    int visible = 0, points = 0;
    for (const int edge : {1, 2, 3, 8}) {
      Structures structures(set.volumes, edge);
      for (int n = 0; n < 12; ++n) {
        const Classifier classifier(random.transfer(static_cast<Merge>(n % 3), 1 + n % 4), set.volumes.all(),
                                    materials);
        structures.update(classifier);
        visible += expect_bounds(set.volumes, classifier, structures, 6000, 100 + n);
        points += 6000;
        if (HasFailure()) FAIL() << "rules " << n << ", cells of " << edge;
      }
    }
    EXPECT_GE(points, 200000);
    EXPECT_GT(visible, points / 5);
  }
}

/// Every kind alone and over a curve: random rules might leave a combination out.
TEST(RuleBounds, HoldForEveryKindAndMerge) {
  const auto materials = test::random_rule_materials();
  Rng rng(22, 0, 0, 0);
  for (const Set& set : volume_sets()) {
    SCOPED_TRACE(set.name);
    Structures structures(set.volumes, 2);
    test::RandomRules random(set.volumes, rng);
    std::array<int, 5 * 3 * 2> seen{};
    for (int n = 0; n < 2000 && std::count(seen.begin(), seen.end(), 0) > 0; ++n) {
      TransferDescription transfer = random.transfer(static_cast<Merge>(n % 3), 1);
      const RuleDescription& rule = transfer.rules[0];
      int& count =
          seen[static_cast<std::size_t>(static_cast<int>(rule.kind) * 6 + n % 3 * 2 + !rule.along.empty())];
      if (count++ > 0) continue;
      const Classifier classifier(transfer, set.volumes.all(), materials);
      structures.update(classifier);
      expect_bounds(set.volumes, classifier, structures, 4000, 200);
      if (HasFailure()) FAIL() << "kind " << static_cast<int>(rule.kind) << ", merge " << n % 3;
    }
    EXPECT_EQ(std::count(seen.begin(), seen.end(), 0), 0);
  }
}

/// The opacity has plateaus at breakpoints of the rules, steps at one value, and is opaque somewhere.
TEST(RuleBounds, HoldForRulesOfTheOpacity) {
  using enum RuleKind;
  const RuleVolumeSet volumes(mixed_volume<std::int16_t>({40, 33, 28}, -1000, 1500));
  const std::vector<TransferPoint> levels{opacity_point(0.1, 0.3), opacity_point(0.5, 0.9),
                                          opacity_point(0.5, 0.2), opacity_point(0.9999, 0.6)};
  const std::vector<TransferPoint> steps{opacity_point(0, 0.1), opacity_point(0.5, 0.8),
                                         opacity_point(0.9999, 0.3)};
  const std::vector<RuleColumn> columns{{0, levels}, {0.5, {opacity_point(0.5, 0)}}, {0.9999, levels}};
  std::vector<RuleDescription> rules{rule_of(kCoefficientCurve, "opacity", levels),
                                     rule_of(kCoefficientSteps, "opacity", steps)};
  for (const ColumnForm form : {ColumnForm::kCurve, ColumnForm::kSteps})
    for (const char* volume : {"opacity", "data"})
      rules.push_back(rule_of(kCoefficientCurve, volume, "opacity", form, columns));
  TransferDescription transfer = test::opacity_function(
      {{-800, 0}, {-200, 0.5}, {100, 0.5}, {100, 0.1}, {400, 1}, {700, 1}, {900, 0.2}, {900, 0.7}}, 0.7);
  for (const int edge : {1, 3}) {
    Structures structures(volumes, edge);
    for (std::size_t n = 0; n < 3 * rules.size(); ++n) {
      transfer.rules = {rules[n / 3]};
      transfer.merge = static_cast<Merge>(n % 3);
      const Classifier classifier(transfer, volumes.all(), {});
      structures.update(classifier);
      EXPECT_GT(expect_bounds(volumes, classifier, structures, 8000, 300 + n), 500);
      if (HasFailure()) FAIL() << "rule " << n / 3 << ", merge " << n % 3 << ", cells of " << edge;
    }
  }
}

TEST(RuleBounds, OfARuleOfTheOpacityAreThoseOfItsRange) {
  // The opacity is 0.2 and then 0.8; a step at 0.5 lies between.
  const RuleVolumeSet volumes(
      make_volume<std::int16_t>({32, 16, 16}, [](auto i, auto, auto) { return i < 16 ? 100 : 300; }));
  TransferDescription transfer = test::opacity_function({{100, 0.2}, {300, 0.8}}, 1);
  transfer.merge = Merge::kMaximum;
  transfer.rules = {
      rule_of(RuleKind::kCoefficientSteps, "opacity", {opacity_point(0.5, 0.95), opacity_point(0.9, 0.99)})};
  Structures s(volumes, 2);
  s.update(Classifier(transfer, volumes.all(), {}));
  test::each_cell(s.hierarchy.view(), [&](auto i, auto j, auto k) {
    const double opacity = i < 7 ? 0.2 : 0.95;
    ASSERT_NEAR(s.finest(i, j, k) / (mu_t_from_opacity(opacity, 1) * kMajorantSafety), 1, 1e-5) << i;
  });
}

/// More columns than a run of cells is near, and more labels than columns.
TEST(RuleBounds, HoldForManyColumnsAlongLabels) {
  RuleVolumeSet volumes(mixed_volume<std::int16_t>(kSize, -1000, 1500));
  volumes.add("atlas", label_volume<std::uint16_t>(kSize, 300, 0, 33), Lookup::kNearest);
  Rng rng(34, 0, 0, 0);
  std::vector<RuleColumn> columns;
  for (int at = 0; at < 300; at += 1 + at % 3)
    columns.push_back({static_cast<double>(at), {opacity_point(-500, 0), opacity_point(1000, rng.next())}});
  TransferDescription transfer = test::opacity_function({{-500, 0}, {1500, 0.4}}, 0.7);
  Structures structures(volumes, 2);
  for (const ColumnForm form : {ColumnForm::kCurve, ColumnForm::kSteps, ColumnForm::kPoints}) {
    transfer.rules = {rule_of(RuleKind::kCoefficientCurve, "data", "atlas", form, columns)};
    const Classifier classifier(transfer, volumes.all(), {});
    structures.update(classifier);
    EXPECT_GT(expect_bounds(volumes, classifier, structures, 20000, 400), 5000);
  }
}

TEST(RuleBounds, OfARuleOfTheDataAreThoseOfThePoints) {
  Rng rng(23, 0, 0, 0);
  for (const int edge : {1, 2, 5}) {
    const RuleVolumeSet volumes(mixed_volume<std::int16_t>({60, 41, 35}, -1000, 1500));
    for (int n = 0; n < 6; ++n) {
      TransferDescription plain = mu_t_function(test::random_curve(-1000, 1500, 5, 3 + 5 * n, rng)), ruled;
      if (n % 2) plain = test::opacity_function({{-500, 0}, {100.0 * n, 0.3}, {1200, 1}}, 0.7);
      ruled = plain;
      ruled.points.clear();
      ruled.rules = {rule_of(RuleKind::kCoefficientCurve, "data", plain.points)};
      for (const Merge merge : {Merge::kProduct, Merge::kPriority, Merge::kMaximum}) {
        ruled.merge = merge;
        Structures by_rules(volumes, edge);
        by_rules.update(Classifier(ruled, volumes.all(), {}));
        const TransferFunction function(plain);
        MajorantHierarchy hierarchy(volumes.main(), edge);
        hierarchy.update(function);
        MajorantGrid grid(volumes.main(), edge);
        grid.update(function);
        ASSERT_EQ(all_words(by_rules.hierarchy.view()), all_words(hierarchy.view()));
        const MajorantView a = by_rules.grid.view(), b = grid.view();
        const auto cells = std::int64_t{a.cells[0]} * a.cells[1] * a.cells[2];
        for (std::int64_t c = 0; c < cells; ++c) ASSERT_EQ(a.mu_maj[c], b.mu_maj[c]);
      }
    }
  }
}

TEST(RuleBounds, ACoveringRuleHidesTheCurveBelow) {
  // Data of mu_t 5 everywhere; label 1 in the lower half covers it with mu_t 0.5, label 2 is not listed.
  RuleVolumeSet volumes(make_volume<std::int16_t>({32, 16, 16}, [](auto, auto, auto) { return 100; }));
  volumes.add("organs",
              make_volume<std::uint8_t>({32, 16, 16}, [](auto i, auto, auto) { return i < 16 ? 1 : 2; }),
              Lookup::kNearest);
  TransferDescription transfer = mu_t_function({{0, 5}});
  TransferPoint cover;
  cover.value = 1;
  cover.mu_t_per_mm = 0.5;
  transfer.rules = {rule_of(RuleKind::kCoefficientPoints, "organs", {cover})};
  Structures s(volumes, 2);
  s.update(Classifier(transfer, volumes.all(), {}));
  test::each_cell(s.hierarchy.view(), [&](auto i, auto j, auto k) {
    // The cell [14, 16] touches voxel 16, which has the other label.
    const float expected = (i < 7 ? 0.5f : 5.0f) * kMajorantSafety;
    ASSERT_EQ(s.finest(i, j, k), expected) << i;
  });
  EXPECT_LE(majorant_of(word_at(s.hierarchy.view(), 2, 2, 2)), 0.5f * kMajorantSafety * (1 + 1e-6f));
  // The other way round nothing is hidden.
  transfer.merge = Merge::kMaximum;
  s.update(Classifier(transfer, volumes.all(), {}));
  EXPECT_EQ(s.finest(0, 0, 0), 5 * kMajorantSafety);
}

TEST(RuleBounds, UpdatesEqualNewTables) {
  const auto materials = test::random_rule_materials();
  const std::vector<Set> sets = volume_sets();
  const RuleVolumeSet& volumes = sets.front().volumes;
  Rng rng(24, 0, 0, 0);
  test::RandomRules random(volumes, rng);
  Structures updated(volumes, 2);
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE("edit " + std::to_string(n));
    Structures fresh(volumes, 2);
    if (n % 4 == 3) {
      const TransferFunction function(mu_t_function(test::random_curve(-1000, 1500, 5, 2 + n % 7, rng)));
      for (Structures* s : {&updated, &fresh}) {
        s->hierarchy.update(function);
        s->grid.update(function);
      }
    } else {
      const Classifier classifier(random.transfer(static_cast<Merge>(n % 3), 1 + n % 4), volumes.all(),
                                  materials);
      updated.update(classifier);
      fresh.update(classifier);
    }
    ASSERT_EQ(all_words(updated.hierarchy.view()), all_words(fresh.hierarchy.view()));
    const MajorantView a = updated.grid.view(), b = fresh.grid.view();
    for (std::int64_t c = 0; c < std::int64_t{a.cells[0]} * a.cells[1] * a.cells[2]; ++c)
      ASSERT_EQ(a.mu_maj[c], b.mu_maj[c]);
  }
}

TEST(RuleBounds, PointsFollowRulesAsIfThereHadBeenNone) {
  // The same points before, between and after rules.
  const RuleVolumeSet volumes(mixed_volume<std::int16_t>({60, 41, 35}, -1000, 1500));
  const TransferDescription plain = mu_t_function({{-500, 0}, {0, 1}, {1200, 3}});
  const TransferFunction function(plain);
  Structures s(volumes, 1);
  s.hierarchy.update(function);
  const std::vector<std::uint32_t> before = all_words(s.hierarchy.view());
  TransferDescription ruled = plain;
  ruled.rules = {
      rule_of(RuleKind::kCoefficientSteps, "data", {opacity_point(-900, 0.9), opacity_point(0, 0)})};
  s.update(Classifier(ruled, volumes.all(), {}));
  EXPECT_NE(all_words(s.hierarchy.view()), before);
  s.hierarchy.update(function);
  EXPECT_EQ(all_words(s.hierarchy.view()), before);
}

}  // namespace
}  // namespace voxlume
