// How several rules become one.
#include "rule_row.h"

namespace voxlume::test {
namespace {

TEST(MergeProduct, OpacitiesAreMultiplied) {
  Row row({0, 25, 50, 100, 100});
  row.with("gradient", {100, 100, 50, 100, 0});
  row.transfer.merge = Merge::kProduct;
  const std::vector<TransferPoint> ramp{opacity_point(0, 0), opacity_point(100, 0.8)};
  row.rule(rule_of(RuleKind::kCoefficientCurve, "data", ramp));
  row.rule(rule_of(RuleKind::kCoefficientCurve, "gradient", ramp));
  // 0.9999 counts as 1, which is 1e-4 of a factor.
  row.expect_opacities({0, 0.2 * 0.8, 0.4 * 0.4, 0.64, 0}, 6e-4);
}

TEST(MergeProduct, OfThreeRules) {
  Row row({1});
  row.with("a", {1}).with("b", {1});
  row.transfer.merge = Merge::kProduct;
  for (const char* volume : {"data", "a", "b"}) {
    TransferPoint point = opacity_point(0, 0.5);
    point.color = linear(0.5f, 1, 0.25f);
    point.roughness = 0.5;
    point.emission = linear(2, 0, 1);
    row.rule(rule_of(RuleKind::kCoefficientCurve, volume, {point}));
  }
  row.expect_opacities({0.125}, 4e-4);
  const Classified c = row.at(0);
  EXPECT_EQ(c.optics.albedo, Vec3f(0.125f, 1, 1.0f / 64));
  EXPECT_EQ(c.optics.emission, Vec3f(8, 0, 1));
  EXPECT_EQ(c.number_or(Number::kRoughness, -1), 0.125f);
}

TEST(MergeProduct, AFactorOfOneChangesNothing) {
  std::vector<float> data;
  for (int i = 0; i < 400; ++i) data.push_back(static_cast<float>(i) * 0.55f);
  Row plain(data), both(data);
  plain.rule(rule_of(RuleKind::kCoefficientCurve, "data", kCurve));
  both.transfer.merge = Merge::kProduct;
  both.with("one", std::vector<float>(data.size(), 1));
  both.rule(rule_of(RuleKind::kCoefficientCurve, "data", kCurve));
  both.rule(rule_of(RuleKind::kCoefficientSteps, "one", {opacity_point(0, 1)}));
  for (int i = 0; i < 400; ++i) EXPECT_EQ(both.at(i).optics.mu_t, plain.at(i).optics.mu_t) << i;
}

TEST(MergeProduct, WhereARuleDoesNotApplyIsNothing) {
  Row row({1, 1, 1});
  row.with("organs", {0, 1, 2}, Lookup::kNearest);
  row.transfer.merge = Merge::kProduct;
  row.transfer.points = {opacity_point(0, 0.5)};
  row.rule(rule_of(RuleKind::kCoefficientPoints, "organs", {opacity_point(1, 0.5), opacity_point(2, 0)}));
  row.expect_opacities({0, 0.25, 0}, 4e-4);
}

TEST(MergePriority, FallsToTheCurve) {
  Row row({150, 150, 150, 150});
  row.with("organs", {0, 1, 2, kNaN}, Lookup::kNearest);
  row.materials = {material("a", 0.9, 0.1), material("b", 0, 0.2)};
  row.transfer.points = {opacity_point(0, 0.4)};
  row.transfer.points[0].color = linear(0, 0, 1);
  row.rule(rule_of(RuleKind::kMaterialPoints, "organs", {material_point(1, "a"), material_point(2, "b")}));
  row.expect_opacities({0.4, 0.9, 0.4, 0.4});
  EXPECT_EQ(row.at(0).material, -1);  // not listed
  EXPECT_EQ(row.at(1).material, 0);
  EXPECT_EQ(row.at(2).material, -1);  // opacity 0
  EXPECT_EQ(row.at(2).number_or(Number::kRoughness, -1), -1.0f);
  EXPECT_EQ(row.at(1).label_volume, 1);
  EXPECT_EQ(row.at(0).label_volume, -1);
  // The colour that the material lacks is the curve's.
  EXPECT_EQ(row.at(1).optics.albedo, Vec3f(0, 0, 1));
  row.transfer.smooth_labels = false;
  EXPECT_EQ(row.at(1).label_volume, -1);
}

TEST(MergePriority, ColoursAloneColourWhatIsVisible) {
  Row row({150, 150, -10});
  row.with("organs", {0, 1, 1}, Lookup::kNearest);
  row.transfer.points = {opacity_point(0, 0), opacity_point(0, 0.4)};
  row.transfer.points[1].color = linear(0, 0, 1);
  row.rule(rule_of(RuleKind::kCoefficientPoints, "organs", {color_point(1, linear(1, 0, 0))}));
  row.expect_opacities({0.4, 0.4, 0});
  EXPECT_EQ(row.at(0).optics.albedo, Vec3f(0, 0, 1));
  EXPECT_EQ(row.at(1).optics.albedo, Vec3f(1, 0, 0));
  EXPECT_EQ(row.at(2).given, 0u);
}

TEST(MergePriority, WithoutColoursMatterIsGrey) {
  Row row({150});
  row.rule(rule_of(RuleKind::kCoefficientCurve, "data", {opacity_point(0, 0.5)}));
  EXPECT_EQ(row.at(0).optics.albedo, Vec3f(0.8f));
}

TEST(MergeMaximum, FusesTwoModalities) {
  Row row({0, 100, 0, 100, 50});
  row.with("pet", {0, 0, 10, 10, 10});
  row.transfer.merge = Merge::kMaximum;
  row.transfer.points = {opacity_point(0, 0), opacity_point(100, 0.8)};
  row.transfer.points[0].color = linear(1, 1, 1);
  row.transfer.points[0].roughness = 0.3;
  std::vector<TransferPoint> hot{opacity_point(0, 0), opacity_point(10, 0.6)};
  hot[0].color = linear(1, 0.5f, 0);
  row.rule(rule_of(RuleKind::kCoefficientCurve, "pet", hot));
  row.expect_opacities({0, 0.8, 0.6, 0.8, 0.6}, 3e-4);
  EXPECT_EQ(row.at(1).optics.albedo, Vec3f(1, 1, 1));
  EXPECT_EQ(row.at(2).optics.albedo, Vec3f(1, 0.5f, 0));
  EXPECT_EQ(row.at(3).optics.albedo, Vec3f(1, 1, 1));
  EXPECT_EQ(row.at(4).optics.albedo, Vec3f(1, 0.5f, 0));
  EXPECT_EQ(row.at(4).surface_volume, 1);
  EXPECT_EQ(row.at(3).surface_volume, 0);
  // What the greatest does not give comes from the others.
  EXPECT_EQ(row.at(4).number_or(Number::kRoughness, -1), 0.3f);
}

TEST(OpacityVolume, IsThatOfTheOwnPoints) {
  Row row({0, 24, 26, 74, 76, 100, 100, kNaN});
  row.transfer.points = {opacity_point(0, 0), opacity_point(100, 0.9)};
  row.materials = {material("glass", 0.1, 0.0), material("metal", 0.95, 0.5)};
  row.rule(rule_of(RuleKind::kMaterialSteps, "opacity",
                   {material_point(0.225, "glass"), material_point(0.675, "metal")}));
  row.expect_opacities({0, 0.216, 0.1, 0.1, 0.95, 0.95, 0, 0}, 3e-4);
  EXPECT_EQ(row.at(1).material, -1);
  EXPECT_EQ(row.at(2).material, 0);
  EXPECT_EQ(row.at(4).material, 1);
}

TEST(OpacityVolume, IsNowhereWhereTheDataIs) {
  Row row({0, 100, 100, kNaN});
  row.transfer.points = {opacity_point(0, 0), opacity_point(100, 0.9)};
  row.rule(rule_of(RuleKind::kCoefficientSteps, "opacity", {opacity_point(-1, 0.5)}));
  row.expect_opacities({0.5, 0.5, 0, 0});
}

}  // namespace
}  // namespace voxlume::test
