#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "image_io/image_io.h"
#include "support/volumes.h"
#include "voxlume/volume_io.h"

namespace voxlume::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class CliRules : public CliTest {
 protected:
  void SetUp() override {
    CliTest::SetUp();
    // The left half of the ball is label 2; a grid of its own.
    Placement place;
    place.spacing_mm = {2, 2, 2};
    place.origin_mm = {-10, -10, -14};
    std::filesystem::create_directory(folder_ / "maps");
    write_volume(make_volume<std::uint8_t>(
                     {11, 11, 15}, [](auto i, auto, auto) { return i < 5 ? 2 : 0; }, place),
                 folder_ / "maps/organs.nrrd");
  }

  static json scene() {
    return json::parse(R"({
      "version": 1, "volume": {"path": "ball.nrrd"},
      "proxies": [{"name": "organs", "kind": "file", "path": "maps/organs.nrrd", "lookup": "nearest"},
                  {"name": "steep", "kind": "gradient"}],
      "materials": [{"name": "shell", "like": "gold", "opacity": 1, "color": {"linear": [1, 0, 0]}}],
      "transfer": {
        "points": [{"value": 0, "opacity": 0},
                   {"value": 900, "opacity": 0.9, "color": {"linear": [0, 0, 1]}}],
        "rules": [{"kind": "mdptf", "volume": "organs", "points": [{"value": 2, "material": "shell"}]},
                  {"kind": "cctf", "volume": "data", "along": "steep", "column_form": "curve",
                   "columns": [{"at": 0, "points": [{"value": 0, "roughness": 0.3}]}]}]},
      "background": {"kind": "color", "color": "#000000"}})");
  }
  RunResult render_scene(const json& scene, const std::string& out,
                         const std::vector<std::string>& more = {}) const {
    write("s.json", scene.dump());
    return render("s.json", out, more);
  }
  void expect_refused(const json& scene, const std::string& path) const {
    const RunResult r = render_scene(scene, "o.png");
    EXPECT_EQ(r.code, 2) << path;
    EXPECT_EQ(line_count(r.err), 1) << r.err;
    EXPECT_THAT(r.err, HasSubstr(path));
    EXPECT_FALSE(exists("o.png"));
  }
};

TEST_F(CliRules, WhatIsImportantIsKeptInView) {
  const std::vector<std::string> more{"--background", "0,0,0", "--save-scene", "kept.json"};
  const auto with = [&](std::vector<std::string> flags) {
    flags.insert(flags.end(), more.begin(), more.end());
    return flags;
  };
  ASSERT_EQ(render("ball.nrrd", "plain.exr", more).code, 0);
  const RunResult values =
      render("ball.nrrd", "values.exr", with({"--important", "950:", "--visibility", "1,700,300,1"}));
  ASSERT_EQ(values.code, 0) << values.err;
  ASSERT_EQ(render("kept.json", "again.exr", {"--threads", "1"}).code, 0);
  const RunResult labels =
      render("ball.nrrd", "labels.exr",
             with({"--important", "label:maps/organs.nrrd=2", "--visibility-lights", "all"}));
  ASSERT_EQ(labels.code, 0) << labels.err;
  const auto pixels = [&](const char* name) { return read_image(folder_ / name).rgba; };
  EXPECT_NE(pixels("values.exr"), pixels("plain.exr"));
  EXPECT_EQ(pixels("values.exr"), pixels("again.exr"));
  EXPECT_NE(pixels("labels.exr"), pixels("plain.exr"));
  EXPECT_NE(pixels("labels.exr"), pixels("values.exr"));
  // Nothing there is important: nothing fades.
  ASSERT_EQ(render("ball.nrrd", "none.exr", with({"--important", "5000:6000"})).code, 0);
  EXPECT_EQ(pixels("none.exr"), pixels("plain.exr"));
}

TEST_F(CliRules, RaysAreMarchedInStepsThatAreAskedFor) {
  const auto pixels = [&](const char* name) { return read_image(folder_ / name).rgba; };
  const auto march = [&](const char* out, std::vector<std::string> more) {
    const std::vector<std::string> all{
        "--integrator", "ray-march", "--important", "950:", "--march-jitter", "false", "--march-step"};
    more.insert(more.begin(), all.begin(), all.end());
    const RunResult r = render("ball.nrrd", out, more);
    EXPECT_EQ(r.code, 0) << r.err;
  };
  march("a.exr", {"1", "--save-scene", "a.json", "--stats", "stats.json"});
  ASSERT_EQ(render("a.json", "again.exr", {"--threads", "1"}).code, 0);
  EXPECT_EQ(pixels("a.exr"), pixels("again.exr"));
  const json stats = json::parse(read("stats.json"));
  EXPECT_GT(stats["shadow_rays"], 0) << stats.dump();
  march("short.exr", {"0.25"});
  EXPECT_NE(pixels("a.exr"), pixels("short.exr"));
  march("sums.exr", {"0.25", "--set", "/visibility/sums=discrete"});
  EXPECT_NE(pixels("sums.exr"), pixels("short.exr"));
  for (const char* denoiser : {"decoupled", "asvgf"}) {
    march("denoised.exr", {"1", "--denoise", denoiser});
    EXPECT_NE(pixels("denoised.exr"), pixels("a.exr"));
  }
  const RunResult r = render("ball.nrrd", "o.exr", {"--integrator", "ray-march", "--march-step", "0.0001"});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("--march-step"));
}

TEST_F(CliRules, RenderProxiesRulesAndMaterials) {
  const RunResult r = render_scene(scene(), "o.exr", {"--stats", "stats.json"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err.find("warning"), std::string::npos) << r.err;
  EXPECT_EQ(json::parse(read("stats.json"))["majorant_violations"], 0);
  const Image image = read_image(folder_ / "o.exr");
  // The eye looks at the face: the patient's right, where x is negative, is on the picture's left.
  const auto sum = [&](int first, int last, int channel) {
    float out = 0;
    for (int y = 0; y < image.height; ++y)
      for (int x = first; x < last; ++x) out += image.pixel(x, y)[channel];
    return out;
  };
  EXPECT_GT(sum(0, 10, 0), 4 * sum(0, 10, 2)) << "the label's half is red";
  EXPECT_GT(sum(14, 24, 2), 2 * sum(14, 24, 0)) << "the rest is blue";
}

TEST_F(CliRules, SavedScenesGiveTheIdenticalPicture) {
  std::filesystem::create_directory(folder_ / "sub");
  ASSERT_EQ(render_scene(scene(), "a.exr", {"--save-scene", "sub/t.json"}).code, 0);
  ASSERT_EQ(run({"render", "sub/t.json", "-o", "b.exr"}).code, 0);
  EXPECT_EQ(read_image(folder_ / "a.exr").rgba, read_image(folder_ / "b.exr").rgba);
}

TEST_F(CliRules, PathsOfProxiesStartFromTheScenesFolder) {
  ASSERT_EQ(render_scene(scene(), "a.exr").code, 0);
  json other = scene();
  other["volume"]["path"] = "../ball.nrrd";
  other["proxies"][0]["path"] = "organs.nrrd";
  write("maps/s.json", other.dump());
  const RunResult r = render("maps/s.json", "b.exr");
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(read_image(folder_ / "a.exr").rgba, read_image(folder_ / "b.exr").rgba);
  ASSERT_EQ(render("maps/s.json", "b.exr", {"--save-scene", "maps/t.json"}).code, 0);
  EXPECT_EQ(json::parse(read("maps/t.json"))["proxies"][0]["path"], "organs.nrrd");
}

TEST_F(CliRules, LabelsEndAtVoxelsOrSmoothly) {
  json other = scene();
  const auto picture = [&](const char* outline) {
    if (*outline) other["proxies"][0]["outline"] = outline;
    const RunResult r = render_scene(other, "o.exr", {"--stats", "stats.json"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(json::parse(read("stats.json"))["majorant_violations"], 0);
    return read_image(folder_ / "o.exr").rgba;
  };
  // A flat border lies at the voxels' faces in any case.
  const auto flat = picture("");
  EXPECT_EQ(picture("voxels"), flat);
  Placement place;
  place.spacing_mm = {2, 2, 2};
  place.origin_mm = {-10, -10, -14};
  write_volume(make_volume<std::uint8_t>(
                   {11, 11, 15}, [](auto i, auto, auto k) { return 2 * i + k < 17 ? 2 : 0; }, place),
               folder_ / "maps/organs.nrrd");
  const auto voxels = picture("voxels"), smooth = picture("smooth");
  EXPECT_NE(smooth, voxels);
  other["proxies"][0].erase("outline");
  EXPECT_EQ(picture(""), smooth);
}

TEST_F(CliRules, PicturesHoldNoPathsOfProxies) {
  ASSERT_EQ(render_scene(scene(), "o.exr").code, 0);
  EXPECT_EQ(read("o.exr").find("maps/organs"), std::string::npos);
}

TEST_F(CliRules, WrongOnesAreRefusedInOneLine) {
  json wrong = scene();
  wrong["transfer"]["rules"][0]["points"][0]["value"] = 3;
  expect_refused(wrong, "/transfer/rules/0/points/0/value");
  wrong = scene();
  wrong["transfer"]["rules"][0]["points"][0]["material"] = "gum";
  expect_refused(wrong, "/transfer/rules/0/points/0/material");
  wrong = scene();
  wrong["transfer"]["rules"][1]["along"] = "stepe";
  expect_refused(wrong, "/transfer/rules/1/along");
  wrong = scene();
  wrong["proxies"][1]["of"] = "organ";
  expect_refused(wrong, "/proxies/1/of");
  wrong = scene();
  wrong["proxies"][0]["outline"] = "round";
  expect_refused(wrong, "/proxies/0/outline");
  wrong = scene();
  wrong["materials"][0]["like"] = "silver";
  expect_refused(wrong, "/materials/0/like");
  wrong = scene();
  wrong["render"] = {{"accelerator", "octree"}};
  expect_refused(wrong, "/render/accelerator");
}

}  // namespace
}  // namespace voxlume::test
