// Wrong rules are refused with the JSON path of what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/rule_volumes.h"
#include "transfer/classifier.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using test::color_point;
using test::material_point;
using test::opacity_point;
using test::row_volume;
using test::rule_of;
using testing::HasSubstr;
using enum RuleKind;

TransferPoint extinction_point(double value, double mu_t) {
  TransferPoint point;
  point.value = value;
  point.mu_t_per_mm = mu_t;
  return point;
}

class CheckRule : public testing::Test {
 protected:
  CheckRule() : volumes_(row_volume({0, 100})) {
    volumes_.add("organs", row_volume({1, 4}), Lookup::kNearest)
        .add("soft", row_volume({0, 1}), Lookup::kLinear);
    transfer_.reference_length_mm = 1;
    transfer_.points = {opacity_point(0, 0), opacity_point(100, 1)};
    materials_.resize(2);
    materials_[0].name = "bare";
    materials_[1].name = "dense";
    materials_[1].opacity = 0.5;
  }

  void expect_fine(const RuleDescription& rule) {
    transfer_.rules = {rule};
    EXPECT_NO_THROW(Classifier(transfer_, volumes_.all(), materials_));
  }
  void expect_refused(const RuleDescription& rule, const std::string& where, const std::string& said = "") {
    // Behind a rule that is fine.
    transfer_.rules = {rule_of(kCoefficientCurve, "data", {opacity_point(0, 1)}), rule};
    try {
      const Classifier classifier(transfer_, volumes_.all(), materials_);
      ADD_FAILURE() << "accepted, expected an error at " << where;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kBadParameter);
      EXPECT_EQ(error.where(), "/transfer/rules/1" + where);
      EXPECT_THAT(error.message(), HasSubstr(said));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  }

  test::RuleVolumeSet volumes_;
  TransferDescription transfer_;
  std::vector<NamedMaterialDescription> materials_;
};

TEST_F(CheckRule, Volumes) {
  expect_refused(rule_of(kCoefficientCurve, "pet", {opacity_point(0, 1)}), "/volume", "\"pet\"");
  expect_refused(rule_of(kCoefficientCurve, "pet", {opacity_point(0, 1)}), "/volume", "organs");
  expect_refused(rule_of(kCoefficientCurve, "", {opacity_point(0, 1)}), "/volume");
  expect_refused(rule_of(kCoefficientCurve, "data", "pet", ColumnForm::kCurve, {{0, {opacity_point(0, 1)}}}),
                 "/along");
}

TEST_F(CheckRule, DiscretePointsNeedNearestLookUps) {
  for (const char* volume : {"data", "soft", "opacity"}) {
    expect_refused(rule_of(kCoefficientPoints, volume, {opacity_point(1, 1)}), "/volume");
    expect_refused(rule_of(kMaterialPoints, volume, {material_point(1, "dense")}), "/volume");
    expect_refused(
        rule_of(kCoefficientCurve, "data", volume, ColumnForm::kPoints, {{1, {opacity_point(0, 1)}}}),
        "/along");
  }
  expect_fine(rule_of(kCoefficientPoints, "organs", {opacity_point(1, 1)}));
  expect_fine(rule_of(kMaterialPoints, "organs", {material_point(1, "dense")}));
}

TEST_F(CheckRule, Labels) {
  for (const double label : {0.0, 5.0, -1.0}) {
    expect_refused(rule_of(kCoefficientPoints, "organs", {opacity_point(label, 1)}), "/points/0/value",
                   "from 1 to 4");
    expect_refused(
        rule_of(kCoefficientCurve, "data", "organs", ColumnForm::kPoints, {{label, {opacity_point(0, 1)}}}),
        "/columns/0/at", "from 1 to 4");
  }
  expect_refused(
      rule_of(kMaterialPoints, "organs", {material_point(1, "dense"), material_point(2.5, "dense")}),
      "/points/1/value", "whole number");
  expect_refused(rule_of(kCoefficientCurve, "data", "organs", ColumnForm::kPoints,
                         {{1, {opacity_point(0, 1)}}, {1.5, {opacity_point(0, 1)}}}),
                 "/columns/1/at", "whole number");
}

TEST_F(CheckRule, Breakpoints) {
  for (const RuleKind kind : {kCoefficientCurve, kCoefficientSteps})
    expect_refused(rule_of(kind, "data", {opacity_point(2, 1), opacity_point(1, 1)}), "/points/1/value");
  expect_refused(rule_of(kMaterialSteps, "data", {material_point(2, "dense"), material_point(2, "dense")}),
                 "/points/1/value", "no two alike");
  expect_refused(rule_of(kCoefficientSteps, "data", {opacity_point(2, 1), opacity_point(2, 1)}),
                 "/points/1/value");
  expect_refused(rule_of(kCoefficientPoints, "organs", {opacity_point(2, 1), opacity_point(2, 1)}),
                 "/points/1/value");
  // Different numbers, but one float.
  expect_refused(rule_of(kCoefficientSteps, "data", {opacity_point(1, 1), opacity_point(1 + 1e-12, 1)}),
                 "/points/1/value");
  expect_fine(rule_of(kCoefficientCurve, "data", {opacity_point(2, 1), opacity_point(2, 0)}));
  for (const double bad : {1e300, std::numeric_limits<double>::quiet_NaN()})
    expect_refused(rule_of(kCoefficientCurve, "data", {opacity_point(bad, 1)}), "/points/0/value", "finite");
  expect_refused(rule_of(kCoefficientCurve, "data", {}), "/points");
}

TEST_F(CheckRule, Columns) {
  const std::vector<TransferPoint> points{opacity_point(0, 1)};
  const auto columns = [&](double first, double second, ColumnForm form = ColumnForm::kCurve) {
    return rule_of(kCoefficientCurve, "data", "soft", form, {{first, points}, {second, points}});
  };
  expect_fine(columns(0, 1));
  expect_refused(columns(1, 0), "/columns/1/at");
  for (const ColumnForm form : {ColumnForm::kCurve, ColumnForm::kSteps})
    expect_refused(columns(1, 1, form), "/columns/1/at", "no two alike");
  expect_refused(columns(0, std::numeric_limits<double>::infinity()), "/columns/1/at");
  expect_refused(rule_of(kCoefficientCurve, "data", "soft", ColumnForm::kCurve, {}), "/columns");
  expect_refused(rule_of(kCoefficientCurve, "data", "", ColumnForm::kCurve, {{0, points}}), "/columns",
                 "along");
  RuleDescription both = columns(0, 1);
  both.points = points;
  expect_refused(both, "/points");
  expect_refused(rule_of(kCoefficientCurve, "data", "soft", ColumnForm::kCurve,
                         {{0, points}, {1, {opacity_point(2, 1), opacity_point(1, 1)}}}),
                 "/columns/1/points/1/value");
  expect_refused(rule_of(kCoefficientCurve, "data", "soft", ColumnForm::kCurve, {{0, points}, {1, {}}}),
                 "/columns/1/points");
}

TEST_F(CheckRule, Materials) {
  TransferPoint point = opacity_point(1, 1);
  point.material = "dense";
  for (const RuleKind kind : {kCoefficientCurve, kCoefficientSteps, kCoefficientPoints})
    expect_refused(rule_of(kind, "organs", {point}), "/points/0/material", "coefficient");
  expect_refused(rule_of(kMaterialSteps, "data", {opacity_point(1, 1)}), "/points/0", "\"material\"");
  expect_refused(rule_of(kMaterialPoints, "organs", {material_point(1, "dense"), material_point(2, "gum")}),
                 "/points/1/material", "\"gum\"");
}

TEST_F(CheckRule, Extinctions) {
  TransferPoint both = opacity_point(0, 0.5);
  both.mu_t_per_mm = 1;
  for (const RuleKind kind : {kCoefficientCurve, kCoefficientSteps})
    expect_refused(rule_of(kind, "data", {both}), "/points/0", "both");
  expect_refused(rule_of(kCoefficientCurve, "data", {opacity_point(0, 0.5), extinction_point(1, 1)}),
                 "/points/1", "both");
  expect_fine(rule_of(kCoefficientSteps, "data", {opacity_point(0, 0.5), extinction_point(1, 1)}));
  // Steps and points: all of them or none.
  for (const RuleKind kind : {kCoefficientSteps, kCoefficientPoints}) {
    expect_refused(rule_of(kind, "organs", {opacity_point(1, 0.5), color_point(2, {})}), "/points/1");
    expect_refused(rule_of(kind, "organs", {color_point(1, {}), opacity_point(2, 0.5)}), "/points/1");
    expect_fine(rule_of(kind, "organs", {color_point(1, {}), color_point(2, {})}));
  }
  expect_refused(rule_of(kMaterialPoints, "organs", {material_point(1, "dense"), material_point(2, "bare")}),
                 "/points/1");
  expect_fine(rule_of(kMaterialPoints, "organs", {material_point(1, "bare"), material_point(2, "bare")}));
  // A curve goes on where a point gives none, but not from one column to another that gives none.
  expect_fine(rule_of(kCoefficientCurve, "data", {opacity_point(0, 0.5), color_point(1, {})}));
  expect_refused(rule_of(kCoefficientCurve, "data", "soft", ColumnForm::kCurve,
                         {{0, {opacity_point(0, 0.5)}}, {1, {color_point(0, {})}}}),
                 "/columns/1/points");
}

TEST_F(CheckRule, OpacityNeedsPoints) {
  const RuleDescription rule = rule_of(kCoefficientCurve, "opacity", {opacity_point(0, 1)});
  const RuleDescription along =
      rule_of(kCoefficientCurve, "data", "opacity", ColumnForm::kSteps, {{0, {opacity_point(0, 1)}}});
  expect_fine(rule);
  expect_fine(along);
  transfer_.points.clear();
  expect_refused(rule, "/volume", "points");
  expect_refused(along, "/along", "points");
}

}  // namespace
}  // namespace voxlume
