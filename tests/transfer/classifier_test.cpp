#include "transfer/classifier.h"

#include "rule_row.h"
#include "support/random_rules.h"

namespace voxlume::test {
namespace {

TEST(RuleKinds, CoefficientCurve) {
  Row row({-5, 0, 50, 75, below(100), 100, above(100), 150, 200, 300, 300, kNaN});
  row.rule(rule_of(RuleKind::kCoefficientCurve, "data", kCurve));
  row.expect_opacities({0, 0, 0.25, 0.375, 0.5, 0.2, 0.2, 0.5, 0.8, 0.8, 0, 0}, 3e-4);
}

TEST(RuleKinds, CoefficientSteps) {
  Row row({-5, below(10), 10, 15, below(20), 20, 1e6f, 20, kNaN});
  row.rule(rule_of(RuleKind::kCoefficientSteps, "data", {opacity_point(10, 0.3), opacity_point(20, 0.6)}));
  row.expect_opacities({0, 0, 0.3, 0.3, 0.3, 0.6, 0.6, 0, 0});
}

TEST(RuleKinds, CoefficientPoints) {
  Row row({0, 0, 0, 0, 0, 0, 0});
  row.with("organs", {0, 2, 3, 4, 5, 9, kNaN}, Lookup::kNearest);
  row.rule(rule_of(RuleKind::kCoefficientPoints, "organs", {opacity_point(3, 0.3), opacity_point(4, 0.6)}));
  row.expect_opacities({0, 0, 0.3, 0.6, 0, 0, 0});
}

TEST(RuleKinds, MaterialSteps) {
  Row row({0, below(10), 10, 19, 20, 30});
  row.materials = {material("a", 0.5, 0.1), material("b", 0.25, 0.9)};
  row.rule(rule_of(RuleKind::kMaterialSteps, "data", {material_point(10, "b"), material_point(20, "a")}));
  row.expect_opacities({0, 0, 0.25, 0.25, 0.5, 0.5});
  EXPECT_EQ(row.at(0).given, 0u);
  EXPECT_EQ(row.at(2).material, 1);
  EXPECT_EQ(row.at(3).number_or(Number::kRoughness, -1), 0.9f);
  EXPECT_EQ(row.at(4).material, 0);
  EXPECT_EQ(row.at(4).number_or(Number::kRoughness, -1), 0.1f);
}

TEST(RuleKinds, MaterialPointsHaveWhatTheyGiveBeforeTheMaterials) {
  Row row({0, 0, 0, 0});
  row.with("organs", {0, 3, 4, 7}, Lookup::kNearest);
  row.materials = {material("a", 0.5, 0.1)};
  row.materials[0].color = linear(0.1f, 0.2f, 0.3f);
  row.materials[0].metallic = 0.75;
  TransferPoint own = material_point(4, "a");
  own.mu_t_per_mm = 7;
  own.roughness = 0.6;
  row.rule(rule_of(RuleKind::kMaterialPoints, "organs", {material_point(3, "a"), own}));
  row.expect_opacities({0, 0.5});
  EXPECT_EQ(row.at(1).optics.albedo, Vec3f(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(row.at(1).number_or(Number::kRoughness, -1), 0.1f);
  EXPECT_EQ(row.at(1).label_volume, 1);
  EXPECT_FLOAT_EQ(row.at(2).optics.mu_t, static_cast<float>(7 * kScale));
  EXPECT_EQ(row.at(2).optics.albedo, Vec3f(0.1f, 0.2f, 0.3f));
  EXPECT_EQ(row.at(2).number_or(Number::kRoughness, -1), 0.6f);
  EXPECT_EQ(row.at(2).number_or(Number::kMetallic, -1), 0.75f);
  EXPECT_EQ(row.at(2).number_or(Number::kSpecular, -1), -1.0f);
  EXPECT_EQ(row.at(2).material, 0);
  EXPECT_EQ(row.at(3).given, 0u);
}

TEST(RuleKinds, NumbersHaveCurvesOfTheirOwn) {
  Row row({-10, 0, 25, 50, 75, 100, 150});
  std::vector<TransferPoint> points{opacity_point(0, 0.5), opacity_point(50, 0.5), opacity_point(100, 0.5)};
  points[0].roughness = 0.2;
  points[2].roughness = 0.8;
  points[1].metallic = 0.3;
  points[0].anisotropy = -0.5;
  points[1].anisotropy = 0.5;
  points[1].surface_share = 1;
  points[2].surface_share = 0;
  row.rule(rule_of(RuleKind::kCoefficientCurve, "data", points));
  const float roughness[] = {0.2f, 0.2f, 0.35f, 0.5f, 0.65f, 0.8f, 0.8f};
  const float anisotropy[] = {-0.5f, -0.5f, 0, 0.5f, 0.5f, 0.5f, 0.5f};
  const float share[] = {1, 1, 1, 1, 0.5f, 0, 0};
  for (int i = 0; i < 7; ++i) {
    const Classified c = row.at(i);
    EXPECT_NEAR(c.number_or(Number::kRoughness, -9), roughness[i], 1e-6) << i;
    EXPECT_NEAR(c.number_or(Number::kMetallic, -9), 0.3f, 1e-6) << i;
    EXPECT_NEAR(c.number_or(Number::kAnisotropy, -9), anisotropy[i], 1e-6) << i;
    EXPECT_NEAR(c.number_or(Number::kSurfaceShare, -9), share[i], 1e-6) << i;
    EXPECT_EQ(c.number_or(Number::kSpecular, -9), -9.0f) << i;
    EXPECT_EQ(c.material, -1) << i;
  }
}

/// Data 50 where the second volume has these values.
Row row_along(const std::vector<float>& along, Lookup lookup, RuleKind kind, ColumnForm form) {
  Row row(std::vector<float>(along.size(), 50));
  row.with("along", along, lookup);
  row.rule(rule_of(kind, "data", "along", form,
                   {{0, {opacity_point(0, 0), opacity_point(100, 0.5)}},
                    {10, {opacity_point(0, 0.4), opacity_point(100, 0.8)}}}));
  return row;
}

TEST(Columns, OfCurves) {
  const std::vector<float> along{-1, 0, 2.5f, below(10), 10, 20, 20, kNaN};
  const Row row = row_along(along, Lookup::kLinear, RuleKind::kCoefficientCurve, ColumnForm::kCurve);
  const double lower = extinction(0.25), upper = extinction(0.6);
  const double expected[] = {lower, lower, lower + 0.25 * (upper - lower), upper, upper, upper, 0, 0};
  for (int i = 0; i < 8; ++i) EXPECT_NEAR(row.at(i).optics.mu_t, expected[i], 3e-4 * expected[i]) << i;
}

TEST(Columns, OfSteps) {
  row_along({-1, below(0), 0, 5, below(10), 10, 20, 20, kNaN}, Lookup::kLinear, RuleKind::kCoefficientCurve,
            ColumnForm::kSteps)
      .expect_opacities({0, 0, 0.25, 0.25, 0.25, 0.6, 0.6, 0, 0}, 3e-4);
  row_along({-1, 0, 5, 10, 20}, Lookup::kLinear, RuleKind::kCoefficientSteps, ColumnForm::kSteps)
      .expect_opacities({0, 0, 0, 0.4, 0.4});
}

TEST(Columns, OfPoints) {
  row_along({-1, 0, 5, 9, 10, 11, kNaN}, Lookup::kNearest, RuleKind::kCoefficientCurve, ColumnForm::kPoints)
      .expect_opacities({0, 0.25, 0, 0, 0.6, 0, 0}, 3e-4);
}

TEST(Columns, OfEveryKindInterpolate) {
  Row row({10, 10, 10});
  row.with("organs", {2, 2, 2}, Lookup::kNearest).with("along", {0, 5, 10});
  row.materials = {material("a", 0.5, 0.1), material("b", 0.25, 0.9)};
  const auto columns = [](TransferPoint first, TransferPoint second) {
    return std::vector<RuleColumn>{{0, {first}}, {10, {second}}};
  };
  const auto expect_middle = [&](RuleDescription rule) {
    row.transfer.rules = {rule};
    EXPECT_NEAR(row.at(0).optics.mu_t, extinction(0.5), 1e-5);
    EXPECT_NEAR(row.at(1).optics.mu_t, 0.5 * (extinction(0.5) + extinction(0.25)), 1e-5);
    EXPECT_NEAR(row.at(2).optics.mu_t, extinction(0.25), 1e-5);
  };
  using enum RuleKind;
  const auto points = columns(opacity_point(2, 0.5), opacity_point(2, 0.25));
  const auto materials = columns(material_point(2, "a"), material_point(2, "b"));
  expect_middle(rule_of(kCoefficientCurve, "data", "along", ColumnForm::kCurve, points));
  expect_middle(rule_of(kCoefficientSteps, "data", "along", ColumnForm::kCurve, points));
  expect_middle(rule_of(kCoefficientPoints, "organs", "along", ColumnForm::kCurve, points));
  expect_middle(rule_of(kMaterialSteps, "data", "along", ColumnForm::kCurve, materials));
  expect_middle(rule_of(kMaterialPoints, "organs", "along", ColumnForm::kCurve, materials));
  EXPECT_EQ(row.at(0).material, 0);
  EXPECT_EQ(row.at(2).material, 1);
  EXPECT_NEAR(row.at(1).number_or(Number::kRoughness, -1), 0.5, 1e-6);
}

TEST(Columns, ThatGiveDifferentThings) {
  Row row({15, 15, 15, 15});
  row.with("along", {0, 2, 8, 10});
  TransferPoint painted = opacity_point(0, 0.5), bare = opacity_point(20, 0.9);
  painted.color = linear(1, 0, 0);
  painted.roughness = 0.25;
  row.rule(rule_of(RuleKind::kCoefficientSteps, "data", "along", ColumnForm::kCurve,
                   {{0, {painted}}, {10, {bare}}}));
  // The second column does not apply at 15: matter fades to nothing, and stays what it is.
  const double full = extinction(0.5);
  const double expected[] = {full, 0.8 * full, 0.2 * full, 0};
  for (int i = 0; i < 4; ++i) {
    EXPECT_NEAR(row.at(i).optics.mu_t, expected[i], 1e-5) << i;
    if (i == 3) continue;
    EXPECT_EQ(row.at(i).optics.albedo, Vec3f(1, 0, 0)) << i;
    EXPECT_EQ(row.at(i).number_or(Number::kRoughness, -1), 0.25f) << i;
  }
}

TEST(ReferenceLengthAndScale, ConvertEveryRule) {
  for (const double length : {0.5, 4.0})
    for (const double scale : {0.25, 2.0, 0.0}) {
      Row row({0, 0});
      row.with("organs", {1, 2}, Lookup::kNearest);
      row.transfer.reference_length_mm = length;
      row.transfer.density_scale = scale;
      row.materials = {material("a", 0.5, 0)};
      TransferPoint own = material_point(2, "a");
      own.mu_t_per_mm = 3;
      row.rule(rule_of(RuleKind::kMaterialPoints, "organs", {material_point(1, "a"), own}));
      EXPECT_NEAR(row.at(0).optics.mu_t, extinction(0.5, length, scale), 1e-5);
      EXPECT_NEAR(row.at(1).optics.mu_t, 3 * scale, 1e-5);
    }
}

TEST(Proxies, NothingAppliesOutside) {
  RuleVolumeSet volumes(make_volume<float>({10, 4, 4}, [](auto, auto, auto) { return 1; }));
  Placement place;
  place.origin_mm = {4, 0, 0};
  for (const Lookup lookup : {Lookup::kLinear, Lookup::kNearest})
    volumes.add(lookup == Lookup::kLinear ? "soft" : "hard",
                make_volume<std::uint8_t>(
                    {3, 4, 4}, [](auto, auto, auto) { return 5; }, place),
                lookup);
  TransferDescription transfer;
  transfer.reference_length_mm = 1;
  const auto mu_t = [&](const char* volume, float x) {
    transfer.rules = {rule_of(RuleKind::kCoefficientCurve, volume, {opacity_point(0, 0.5)})};
    const Classifier classifier(transfer, volumes.all(), {});
    return classify_mu_t(classifier.view(), Vec3f(x, 1, 1), 1.0f);
  };
  for (const char* volume : {"soft", "hard"}) {
    EXPECT_EQ(mu_t(volume, 3.4f), 0.0f);
    EXPECT_GT(mu_t(volume, 3.6f), 0.0f);
    EXPECT_GT(mu_t(volume, 6.4f), 0.0f);
    EXPECT_EQ(mu_t(volume, 6.6f), 0.0f);
  }
}

TEST(Proxies, NearestLookUpsInventNoLabels) {
  const auto place = [](double shift) {
    Placement out;
    out.origin_mm = {shift, 0, 0};
    return out;
  };
  for (const double shift : {0.0, 0.3}) {
    RuleVolumeSet volumes(make_volume<float>({20, 5, 5}, [](auto, auto, auto) { return 1; }));
    volumes.add("organs",
                make_volume<std::uint8_t>(
                    {20, 5, 5}, [](auto i, auto j, auto k) { return (i + j + k) % 2 ? 7 : 0; }, place(shift)),
                Lookup::kNearest);
    TransferDescription transfer;
    transfer.reference_length_mm = 1;
    std::vector<TransferPoint> points;
    for (int label = 0; label <= 7; ++label) points.push_back(opacity_point(label, 0.1 * (label + 1)));
    transfer.rules = {rule_of(RuleKind::kCoefficientPoints, "organs", points)};
    const Classifier classifier(transfer, volumes.all(), {});
    Rng rng(3, 0, 0, 0);
    int of[2] = {0, 0};
    for (int n = 0; n < 20000; ++n) {
      const Vec3f p = random_point(volumes.voxels(0), rng);
      const float mu_t = classify_mu_t(classifier.view(), p, 1);
      if (mu_t == 0 && p.x < 0) continue;  // outside the shifted grid
      const bool background = std::abs(mu_t - extinction(0.1, 1, 1)) < 1e-5;
      ASSERT_TRUE(background || std::abs(mu_t - extinction(0.8, 1, 1)) < 1e-5) << mu_t << " at " << p.x;
      ++of[background];
    }
    EXPECT_GT(of[0], 5000);
    EXPECT_GT(of[1], 5000);
  }
}

/// Volumes on the same grid, shifted, turned and smaller ones, with holes.
RuleVolumeSet various_volumes() {
  const Size3 size{14, 12, 10};
  RuleVolumeSet out(noise_volume<float>(size, -10, 10, 1));
  out.add("same", noise_volume<std::uint8_t>(size, 0, 6, 2), Lookup::kNearest);
  Placement place = placements()[3];
  place.spacing_mm = {0.8, 1.3, 1.1};
  place.origin_mm = {6, 3, 2};
  out.add("turned", noise_volume<std::int16_t>({9, 9, 9}, -40, 40, 3, place), Lookup::kLinear);
  place.origin_mm = {1, 10, 2};
  Rng rng(4, 0, 0, 0);
  out.add("labels",
          make_volume<float>(
              {9, 9, 9},
              [&](auto, auto, auto) { return rng.next() < 0.1f ? kNaN : std::floor(9 * rng.next()); }, place),
          Lookup::kNearest);
  return out;
}

TEST(Classify, HasTheExtinctionOfTheTrackers) {
  const RuleVolumeSet volumes = various_volumes();
  const auto materials = random_rule_materials();
  Rng rng(5, 0, 0, 0);
  int visible = 0;
  for (int set = 0; set < 200; ++set) {
    RandomRules random(volumes, rng);
    const TransferDescription transfer = random.transfer(static_cast<Merge>(set % 3), 1 + set % 5);
    const Classifier classifier(transfer, volumes.all(), materials);
    const ClassifierView view = classifier.view();
    for (int n = 0; n < 1000; ++n) {
      const Vec3f p = random_point(volumes.voxels(0), rng);
      const float data = n % 50 == 0 ? kNaN : sample_trilinear(volumes.main(), p);
      const Classified c = classify(view, p, data);
      ASSERT_EQ(c.optics.mu_t, classify_mu_t(view, p, data)) << "set " << set;
      ASSERT_LE(c.optics.mu_t, classifier.upper_mu_t() * (1 + 1e-5f)) << "set " << set;
      ASSERT_EQ(c.optics.mu_t > 0, (c.given & kGivesExtinction) != 0);
      if (!(c.optics.mu_t > 0)) continue;
      ++visible;
      ASSERT_GE(min_component(c.optics.albedo), 0);
      ASSERT_LE(max_component(c.optics.albedo), 1);
      ASSERT_GE(min_component(c.optics.emission), 0);
      ASSERT_LT(c.material, 3);
    }
  }
  EXPECT_GT(visible, 40000);
}

}  // namespace
}  // namespace voxlume::test
