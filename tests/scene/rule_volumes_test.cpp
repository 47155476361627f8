// Proxies and materials of a scene: what they become, and what is wrong with wrong ones.
#include "scene/rule_volumes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/sample.h"
#include "scene/material_library.h"
#include "scene/materials.h"
#include "scene/scene_file.h"
#include "support/temporary_folder.h"
#include "support/volumes.h"
#include "voxlume/error.h"
#include "voxlume/volume_io.h"

namespace voxlume {
namespace {

using testing::HasSubstr;

/// Runs `body`, which is to throw at `where`.
template <class Body>
void expect_refused(const std::string& where, Body&& body, ErrorCode code = ErrorCode::kBadParameter) {
  try {
    body();
    ADD_FAILURE() << "accepted, expected an error at " << where;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    EXPECT_EQ(error.where(), where) << error.what();
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

class Proxies : public testing::Test {
 protected:
  Proxies() : main_(test::noise_volume<std::int16_t>({9, 8, 7}, 0, 100, 1)) {
    statistics_ = compute_statistics(make_grid_view(main_));
    write_volume(test::noise_volume<std::uint8_t>({9, 8, 7}, 0, 5, 2), folder_ / "organs.nrrd");
    write_volume(test::noise_volume<float>({9, 8, 7}, 0, 5, 3), folder_ / "soft.nrrd");
  }

  static ProxyDescription proxy(const std::string& name, ProxyKind kind, const std::string& of = "data") {
    ProxyDescription out;
    out.name = name;
    out.kind = kind;
    out.of = of;
    if (kind == ProxyKind::kDistance) out.labels = {1};
    return out;
  }
  ProxyDescription file(const std::string& name, const std::string& path,
                        Lookup lookup = Lookup::kLinear) const {
    ProxyDescription out = proxy(name, ProxyKind::kFile);
    out.path = folder_ / path;
    out.lookup = lookup;
    return out;
  }
  RuleVolumes read(const std::vector<ProxyDescription>& proxies) const {
    return {main_, statistics_, proxies, {4, 3, 3}};
  }
  void expect_refused_at(const std::string& where, const std::vector<ProxyDescription>& proxies) const {
    expect_refused(where, [&] { read(proxies); });
  }

  test::TemporaryFolder folder_;
  Volume main_;
  VolumeStatistics statistics_;
};

using enum ProxyKind;

TEST_F(Proxies, AreReadAndDerived) {
  const RuleVolumes read_volumes = read({file("organs", "organs.nrrd", Lookup::kNearest),
                                         proxy("steep", kGradient), proxy("depth", kDistance, "organs")});
  const auto volumes = read_volumes.volumes();
  ASSERT_EQ(volumes.size(), 4u);
  EXPECT_EQ(volumes[0].name, "data");
  EXPECT_TRUE(volumes[1].view.nearest);
  EXPECT_TRUE(volumes[1].view.is_main_grid);
  EXPECT_EQ(volumes[1].values.lower, 0.0f);
  // The gradient magnitude says nothing about directions: its surfaces are the data's.
  EXPECT_EQ(volumes[2].view.surface_volume, 0);
  EXPECT_EQ(volumes[3].view.surface_volume, 3);
  const auto* labels = static_cast<const std::uint8_t*>(volumes[1].view.grid.voxels);
  const auto* depths = static_cast<const float*>(volumes[3].view.grid.voxels);
  for (int i = 0; i < 9 * 8 * 7; ++i) ASSERT_EQ(labels[i] == 1, depths[i] > 0) << i;
}

TEST_F(Proxies, OfLabelsEndSmoothlyOrAtVoxels) {
  ProxyDescription labels = file("organs", "organs.nrrd", Lookup::kNearest);
  const RuleVolumes smooth = read({labels, file("soft", "soft.nrrd")});
  const RuleVolumeView& view = smooth.volumes()[1].view;
  ASSERT_NE(view.leads, nullptr);
  EXPECT_TRUE(std::equal(view.leads, view.leads + 9 * 8 * 7, label_leads(view.grid).begin()));
  EXPECT_EQ(smooth.volumes()[2].view.leads, nullptr);
  labels.outline = Outline::kVoxels;
  EXPECT_EQ(read({labels}).volumes()[1].view.leads, nullptr);
}

TEST_F(Proxies, LieWhereTheFilesSay) {
  test::Placement place = test::placements()[3];
  place.origin_mm = {3, 2, 1};
  const Volume other = test::noise_volume<float>({6, 5, 4}, 0, 5, 4, place);
  write_volume(other, folder_ / "other.nrrd");
  const RuleVolumes read_volumes = read({file("other", "other.nrrd")});
  const RuleVolumeView& view = read_volumes.volumes()[1].view;
  EXPECT_FALSE(view.is_main_grid);
  EXPECT_FALSE(read_volumes.volumes()[1].covers_main);
  const Affined to_world = world_from_index(main_), from_world = world_from_index(other).inverse();
  Rng rng(5, 0, 0, 0);
  for (int n = 0; n < 1000; ++n) {
    const Vec3f p = test::random_point(main_, rng), q = view.index_of(p);
    const Vec3d expected = from_world.point(to_world.point(Vec3d(p)));
    for (int a = 0; a < 3; ++a) ASSERT_NEAR(q[a], expected[a], 1e-4);
  }
}

TEST_F(Proxies, Names) {
  for (const char* name : {"", "data", "opacity"})
    expect_refused_at("/proxies/0/name", {proxy(name, kGradient)});
  expect_refused_at("/proxies/1/name", {proxy("a", kGradient), proxy("a", kSmoothed)});
}

TEST_F(Proxies, Sources) {
  expect_refused_at("/proxies/0/of", {proxy("a", kGradient, "b"), proxy("b", kGradient)});
  expect_refused_at("/proxies/0/of", {proxy("a", kGradient, "a")});
  expect_refused_at("/proxies/0/of", {proxy("a", kGradient, "opacity")});
  expect_refused_at("/proxies/0/path", {proxy("a", kFile)});
  ProxyDescription both = proxy("a", kGradient);
  both.path = "b.nrrd";
  expect_refused_at("/proxies/0/path", {both});
  expect_refused(
      "/proxies/1/path",
      [&] {
        read({file("a", "soft.nrrd"), file("b", "absent.nrrd")});
      },
      ErrorCode::kFileNotFound);
}

TEST_F(Proxies, Labels) {
  ProxyDescription empty = proxy("depth", kDistance, "organs");
  empty.labels.clear();
  expect_refused_at("/proxies/1/labels", {file("organs", "organs.nrrd", Lookup::kNearest), empty});
  expect_refused_at("/proxies/1/of", {file("soft", "soft.nrrd"), proxy("depth", kDistance, "soft")});
  const std::string soft = folder_ / "soft.nrrd";
  expect_refused(
      soft, [&] { read({file("organs", "soft.nrrd", Lookup::kNearest)}); }, ErrorCode::kBadFormat);
}

TEST_F(Proxies, ThatSayNothingAreWarnedOf) {
  const auto expect_warning = [&](const std::vector<ProxyDescription>& proxies, const std::string& text) {
    EXPECT_THAT(read(proxies).warnings(), testing::Contains(HasSubstr(text)));
  };
  test::Placement far;
  far.origin_mm = {500, 0, 0};
  write_volume(test::noise_volume<std::uint8_t>({9, 8, 7}, 0, 5, 2, far), folder_ / "far.nrrd");
  expect_warning({file("far", "far.nrrd")}, "/proxies/0: \"far\" lies nowhere in the volume");
  const auto holed = test::make_volume<float>({9, 8, 7}, [](auto i, auto, auto) { return i == 3 ? NAN : 1; });
  write_volume(holed, folder_ / "holed.nrrd");
  expect_warning({file("holed", "holed.nrrd")}, "/proxies/0: 56 voxels are not finite");
  ProxyDescription depth = proxy("depth", kDistance, "organs");
  depth.labels = {77};
  expect_warning({file("organs", "organs.nrrd", Lookup::kNearest), depth}, "/proxies/1/labels: none of them");
  depth.labels = {77, 2};
  EXPECT_THAT(read({file("organs", "organs.nrrd", Lookup::kNearest), depth}).warnings(), testing::IsEmpty());
}

TEST_F(Proxies, LabelsThatFloatsCannotTellApart) {
  // Beyond 2^23 a float has no halves, and beyond 2^24 not every whole number.
  for (const double label : {8388607.0, 8388609.0, 16777217.0, -8388609.0}) {
    write_volume(
        test::make_volume<std::int32_t>({2, 2, 2}, [&](auto i, auto, auto) { return i ? label : 0; }),
        folder_ / "many.nrrd");
    const ProxyDescription many = file("many", "many.nrrd", Lookup::kNearest);
    if (label == 8388607.0)
      EXPECT_NO_THROW(read({many}));
    else
      expect_refused(
          many.path, [&] { read({many}); }, ErrorCode::kBadFormat);
  }
}

NamedMaterialDescription named(const std::string& name, const std::string& like = "") {
  NamedMaterialDescription out;
  out.name = name;
  out.like = like;
  return out;
}

TEST(NamedMaterials, WrongOnesAreRefused) {
  expect_refused("/materials/0/name", [] { all_materials({named("")}); });
  expect_refused("/materials/1/name", [] { all_materials({named("a"), named("a")}); });
  expect_refused("/materials/1/like", [] { all_materials({named("a"), named("b", "a")}); });
  expect_refused("/materials/0/like", [] { all_materials({named("a", "unobtainium")}); });
  NamedMaterialDescription both = named("a");
  both.opacity = 0.5;
  both.mu_t_per_mm = 1;
  expect_refused("/materials/0", [&] { all_materials({both}); });
}

TEST(NamedMaterials, TakeFromTheLibrary) {
  NamedMaterialDescription own = named("shiny bone", "bone"), glass = named("glass");
  own.roughness = 0.05;
  const auto materials = all_materials({own, glass});
  const auto find = [&](const std::string& name) {
    std::vector<NamedMaterialDescription> found;
    for (const auto& one : materials)
      if (one.name == name) found.push_back(one);
    return found;
  };
  ASSERT_EQ(find("bone").size(), 1u);
  EXPECT_EQ(materials[0].roughness, 0.05);
  EXPECT_EQ(materials[0].color, find("bone")[0].color);
  EXPECT_EQ(materials[0].diffuse_roughness, find("bone")[0].diffuse_roughness);
  // The scene's own comes in place of the library's.
  ASSERT_EQ(find("glass").size(), 1u);
  EXPECT_FALSE(find("glass")[0].transmission);
  EXPECT_EQ(materials.size(), material_library().size() + 1);
  EXPECT_EQ(&materials[1] - materials.data(), 1);
}

TEST(NamedMaterials, LeaveTheRestToTheScene) {
  MaterialDescription base;
  base.roughness = 0.7;
  base.specular = 0.25;
  base.anisotropy = 0.4;
  NamedMaterialDescription own = named("a");
  own.roughness = 0.5;
  const Materials materials(base, {own});
  EXPECT_FLOAT_EQ(materials.views()[0].alpha, 0.49f);
  EXPECT_FLOAT_EQ(materials.views()[1].alpha, 0.25f);
  EXPECT_FLOAT_EQ(materials.views()[1].f0, materials.views()[0].f0);
  EXPECT_FLOAT_EQ(materials.views()[1].g, 0.4f);
  EXPECT_FLOAT_EQ(materials.views()[1].metallic, 0);
}

TEST(NamedMaterials, ShareTheTablesOfTheirGlass) {
  NamedMaterialDescription window = named("window", "glass"), diamond = named("diamond", "glass");
  diamond.ior = 2.4;
  const Materials first({}, {window, diamond}), second({}, {diamond});
  EXPECT_NE(first.views()[1].glass, first.views()[2].glass);
  EXPECT_EQ(first.views()[2].glass, second.views()[1].glass);
  EXPECT_EQ(first.views()[1].glass->ior(), 1.5f);
  EXPECT_EQ(second.views()[1].glass->ior(), 2.4f);
}

/// What parse_scene refuses by itself: the fields' own ranges and words.
TEST(RuleFields, AreChecked) {
  const auto expect_text_refused = [](const std::string& text, const std::string& where) {
    try {
      parse_scene(text, "s.json");
      ADD_FAILURE() << "accepted, expected an error at " << where;
    } catch (const Error& error) {
      EXPECT_THAT(error.what(), HasSubstr(where + ":"));
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
    }
  };
  const auto rule = [](const std::string& inside) {
    return R"({"version": 1, "transfer": {"rules": [{)" + inside + "}]}}";
  };
  expect_text_refused(rule(R"("kind": "ctf")"), "/transfer/rules/0/kind");
  expect_text_refused(rule(R"("column_form": "lines")"), "/transfer/rules/0/column_form");
  expect_text_refused(rule(R"("points": [{"value": 0, "opacity": 1.5}])"),
                      "/transfer/rules/0/points/0/opacity");
  expect_text_refused(rule(R"("columns": [{"at": 0, "points": [{"value": 0, "metallic": -1}]}])"),
                      "/transfer/rules/0/columns/0/points/0/metallic");
  expect_text_refused(rule(R"("columns": [{"points": []}])"), "/transfer/rules/0/columns/0");
  expect_text_refused(R"({"version": 1, "transfer": {"merge": "sum"}})", "/transfer/merge");
  expect_text_refused(R"({"version": 1, "transfer": {"points": [{"value": 0, "material": "gold"}]}})",
                      "/transfer/points/0/material");
  expect_text_refused(R"({"version": 1, "proxies": [{"name": "a", "kind": "sharpened"}]})",
                      "/proxies/0/kind");
  expect_text_refused(R"({"version": 1, "proxies": [{"name": "a", "sigma_mm": 0}]})", "/proxies/0/sigma_mm");
  expect_text_refused(R"({"version": 1, "proxies": [{}, {}, {}, {}]})", "/proxies");
  expect_text_refused(R"({"version": 1, "materials": [{"name": "a", "ior": 9}]})", "/materials/0/ior");
  expect_text_refused(R"({"version": 1, "material": {"self_occlusion": 0}})", "/material/self_occlusion");
}

}  // namespace
}  // namespace voxlume
