#include "scene/scene_file.h"
#include "scene/field_info.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <random>

#include "scene_examples.h"
#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// The message of the Error that parsing `text` ends in; empty when it does not.
std::string error_of(const std::string& text) {
  try {
    parse_scene(text, "scene.json");
  } catch (const Error& e) {
    return e.what();
  }
  return "";
}

/// A scene with `members` beside its version.
std::string scene(const std::string& members) { return R"({"version": 1, )" + members + "}"; }

TEST(SceneFile, TheSmallestSceneIsTheDefault) {
  EXPECT_EQ(parse_scene(R"({"version": 1})", "s"), SceneDescription{});
  EXPECT_EQ(write_scene(SceneDescription{}), "{\n  \"version\": 1\n}\n");
}

TEST(SceneFile, EveryFieldSurvivesWritingAndReading) {
  const SceneDescription full = full_scene();
  EXPECT_EQ(parse_scene(write_scene(full), "s"), full);
  EXPECT_EQ(parse_scene(write_scene(full, true), "s"), full);
  EXPECT_EQ(parse_scene(write_scene(SceneDescription{}, true), "s"), SceneDescription{});
}

TEST(SceneFile, WritingIsDeterministicAndStable) {
  const std::string text = write_scene(full_scene());
  EXPECT_EQ(write_scene(parse_scene(text, "s")), text);
}

TEST(SceneFile, MinimalWritingOmitsDefaults) {
  SceneDescription s;
  s.image.width = 640;
  EXPECT_EQ(write_scene(s), "{\n  \"version\": 1,\n  \"image\": {\"width\": 640}\n}\n");
  s.lights.emplace();  // no lights differs from the default lights
  EXPECT_THAT(write_scene(s), HasSubstr("\"lights\": []"));
  s.clip.emplace();
  EXPECT_THAT(write_scene(s), HasSubstr("\"clip\": {}"));
  EXPECT_THAT(write_scene(s, true), HasSubstr("\"max_scatter\": 2"));
}

TEST(SceneFile, NumbersRoundTripExactly) {
  std::mt19937_64 random(7);
  for (int i = 0; i < 2000; ++i) {
    SceneDescription s;
    s.render.seed = random();
    s.camera.azimuth_deg =
        std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 40) - 90);
    const auto channel = [&] { return std::ldexp(static_cast<float>(random() >> 40), -24); };
    s.background = BackgroundDescription{BackgroundKind::kColor, {{channel(), channel(), channel()}}};
    ASSERT_EQ(parse_scene(write_scene(s), "s"), s) << write_scene(s);
  }
}

TEST(SceneFile, ColorsAreReadInTheirColorSpace) {
  const auto color = [](const std::string& text) {
    return parse_scene(scene(R"("environment": {"color": )" + text + "}"), "s").environment->color.linear;
  };
  EXPECT_EQ(color("\"#ffffff\""), (std::array<float, 3>{1, 1, 1}));
  EXPECT_EQ(color("\"#FF8000\""), (std::array<float, 3>{1, linear_from_srgb(128.0f / 255.0f), 0}));
  EXPECT_EQ(color("[0.5, 0, 1]"), (std::array<float, 3>{linear_from_srgb(0.5f), 0, 1}));
  EXPECT_EQ(color(R"({"linear": [0.25, 3, 0]})"), (std::array<float, 3>{0.25f, 3, 0}));
}

TEST(SceneFile, AnOpenFaceOfTheClipBoxIsNull) {
  SceneDescription s;
  s.clip.emplace();
  s.clip->z_mm[1] = 80;
  EXPECT_THAT(write_scene(s), HasSubstr(R"("clip": {"z_mm": [null, 80]})"));
  EXPECT_THAT(write_scene(s, true), HasSubstr(R"("x_mm": [null, null])"));
  const SceneDescription read =
      parse_scene(scene(R"("clip": {"x_mm": [-5, null], "y_mm": [-1e30, 1e30], "z_mm": [null, 80]})"), "s");
  EXPECT_EQ(read.clip->x_mm, (std::array<double, 2>{-5, kOpenFace_mm}));
  EXPECT_EQ(read.clip->y_mm, ClipDescription{}.y_mm);  // as files were written before there was null
  EXPECT_EQ(read.clip->z_mm, s.clip->z_mm);
  // The same in keys of a track.
  s.animation.emplace();
  s.animation->tracks = {{"/clip/z_mm",
                          Interpolation::kLinear,
                          {{0, std::vector<double>{-kOpenFace_mm, 80}}, {1, std::vector<double>{0, 90}}}}};
  EXPECT_THAT(write_scene(s), HasSubstr("[0, [null, 80]]"));
  EXPECT_EQ(parse_scene(write_scene(s), "s"), s);
  EXPECT_THAT(error_of(scene(R"("camera": {"target_mm": [null, 0, 0]})")),
              HasSubstr("/camera/target_mm/0: found null"));
  EXPECT_THAT(
      error_of(
          scene(R"("animation": {"tracks": [{"field": "/camera/target_mm", "keys": [[0, [null, 0, 0]]]}]})")),
      HasSubstr("/animation/tracks/0/keys/0/1/0"));
}

TEST(SceneFile, TheSchemaKeyIsAllowedAtTheRoot) {
  EXPECT_EQ(error_of(scene(R"("$schema": "scene.schema.json")")), "");
  EXPECT_THAT(error_of(scene(R"("image": {"$schema": "x"})")), HasSubstr("unknown key \"$schema\""));
}

struct Refusal {
  const char* text;
  const char* message;
};

class SceneFileRefuses : public testing::TestWithParam<Refusal> {};

TEST_P(SceneFileRefuses, WithAnAddressAndOneLine) {
  const std::string message = error_of(GetParam().text);
  EXPECT_THAT(message, HasSubstr(GetParam().message)) << GetParam().text;
  EXPECT_THAT(message, testing::StartsWith("scene.json: "));
  EXPECT_EQ(message.find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(
    Structure, SceneFileRefuses,
    testing::Values(
        Refusal{"", "line 1, column 1: unexpected end of input"},
        Refusal{"{\n  \"version\": 1,\n  \"image\": {,}\n}", "line 3, column 13"},
        Refusal{"{\"version\": 1", "line 1, column 14"}, Refusal{"{\"version\": 1} x", "line 1, column 16"},
        Refusal{"{\"version\": 1, \"render\": {\"seed\": 1e999}}", "number overflow"},
        Refusal{"[]", "/: found a list of 0, expected an object"},
        Refusal{"null", "/: found null, expected an object"}, Refusal{"{}", "/: missing key \"version\""},
        Refusal{R"({"version": 2, "unheard_of": 1})", "/version: found version 2, expected at most 1"},
        Refusal{R"({"version": 0})", "/version: found 0, expected a whole number in [1, 1]"},
        Refusal{R"({"version": "1"})", "/version: found \"1\", expected a whole number"},
        Refusal{R"({"version": 1, "version": 1})", "found the key \"version\" twice"},
        Refusal{R"({"version": 1, "volume": [[[[[[[[[[[[[[[[[[[[]]]]]]]]]]]]]]]]]]]]})",
                "nested more than 16 deep"},
        Refusal{R"({"version": 1, "camra": {}})", "/: unknown key \"camra\"; did you mean \"camera\"?"},
        Refusal{R"({"version": 1, "zzzzzzzzzz": {}})",
                "/: unknown key \"zzzzzzzzzz\"; expected one of version, volume"},
        Refusal{R"({"version": 1, "ca\nm": {}})", R"(unknown key "ca\x0am")"},
        Refusal{R"({"version": 1, "camera": 3})", "/camera: found 3, expected an object"},
        Refusal{R"({"version": 1, "clip": null})", "/clip: found null, expected an object"},
        Refusal{R"({"version": 1, "lights": {}})", "/lights: found an object, expected a list"}));

INSTANTIATE_TEST_SUITE_P(
    Values, SceneFileRefuses,
    testing::Values(
        Refusal{R"({"version": 1, "image": {"width": 0}})",
                "/image/width: found 0, expected a whole number in [1, 65536]"},
        Refusal{R"({"version": 1, "image": {"width": 1.5}})",
                "/image/width: found 1.5, expected a whole number"},
        Refusal{R"({"version": 1, "image": {"width": 99999999999}})", "/image/width: found 99999999999"},
        Refusal{R"({"version": 1, "image": {"width": "640"}})", "/image/width: found \"640\""},
        Refusal{R"({"version": 1, "image": {"seconds": 0}})",
                "/image/seconds: found 0, expected a number in (0, "},
        Refusal{R"({"version": 1, "image": {"aovs": ["depth", "depht"]}})",
                "/image/aovs/1: found \"depht\", expected one of alpha"},
        Refusal{R"({"version": 1, "image": {"aovs": ["depth", "depth"]}})",
                "/image/aovs/1: found \"depth\" twice"},
        Refusal{R"({"version": 1, "image": {"filter": "Box"}})",
                "/image/filter: found \"Box\", expected one of gaussian, box"},
        Refusal{R"({"version": 1, "render": {"seed": -1}})", "/render/seed: found -1"},
        Refusal{R"({"version": 1, "render": {"frame": 4294967296}})", "/render/frame: found 4294967296"},
        Refusal{R"({"version": 1, "render": {"denoise": "blur"}})",
                "/render/denoise: found \"blur\", expected one of none, decoupled, svgf"},
        Refusal{R"({"version": 1, "render": {"simd": 4}})",
                "/render/simd: found 4, expected one of auto, scalar"},
        Refusal{R"({"version": 1, "material": {"opacity_modulated": 1}})", "expected true or false"},
        Refusal{R"({"version": 1, "material": {"anisotropy": 1}})", "found 1, expected a number in (-1, 1)"},
        Refusal{R"({"version": 1, "material": {"roughness": true}})",
                "found true, expected a number in [0, 1]"},
        Refusal{R"({"version": 1, "camera": {"target_mm": [1, 2]}})",
                "/camera/target_mm: found a list of 2, expected a list of 3 numbers"},
        Refusal{R"({"version": 1, "camera": {"target_mm": [1, 2, "3"]}})",
                "/camera/target_mm/2: found \"3\", expected a number"},
        Refusal{R"({"version": 1, "camera": {"azimuth_deg": 1e300}})", "/camera/azimuth_deg: found 1e+300"},
        Refusal{R"({"version": 1, "camera": {"focus_mm": 1e13}})", "/camera/focus_mm: found 10000000000000"},
        Refusal{R"({"version": 1, "volume": {"spacing_mm": [1, 0, 1]}})",
                "/volume/spacing_mm/1: found 0, expected a number in (0, "},
        Refusal{R"({"version": 1, "volume": {"path": "a\u0000b"}})",
                "/volume/path: found \"a\\x00b\", expected text without control"},
        Refusal{R"({"version": 1, "environment": {"intensity": 60000000000000}})",
                "/environment/intensity: found 60000000000000, expected a number in [0, 1000000000000]"},
        Refusal{R"({"version": 1, "environment": {"intensity": -1}})", "found -1, expected a number >= 0"},
        Refusal{R"({"version": 1, "environment": {"color": "red"}})",
                "/environment/color: found \"red\", expected a color"},
        Refusal{R"({"version": 1, "environment": {"color": "#12345g"}})", "expected a color"},
        Refusal{R"({"version": 1, "environment": {"color": [0, 2, 0]}})", "found 2, expected a color"},
        Refusal{R"({"version": 1, "environment": {"color": {"linear": [0, -2, 0]}}})",
                "found a linear channel of -2, expected a number >= 0"},
        Refusal{R"({"version": 1, "environment": {"color": {"lin": [0, 0, 0]}}})",
                "found an object, expected a color"}));

INSTANTIATE_TEST_SUITE_P(
    RulesBetweenFields, SceneFileRefuses,
    testing::Values(
        Refusal{R"({"version": 1, "transfer": {"points": [{"opacity": 1}]}})",
                "/transfer/points/0: missing key \"value\""},
        Refusal{R"({"version": 1, "transfer": {"points": [{"value": 1, "opacty": 1}]}})",
                "scene.json: /transfer/points/0: unknown key \"opacty\"; did you mean \"opacity\"?"},
        Refusal{R"({"version": 1, "transfer": {"points": [{"value": 5}, {"value": 1}]}})",
                "/transfer/points/1: found value 1 after 5, expected points sorted by value"},
        Refusal{R"({"version": 1, "transfer": {"points": [{"value": 1, "opacity": 0.5, "mu_t_per_mm": 1}]}})",
                "/transfer/points/0: found both opacity and mu_t_per_mm"},
        Refusal{
            R"({"version": 1, "transfer": {"points": [{"value": 1, "opacity": 0.5}, {"value": 2, "mu_t_per_mm": 1}]}})",
            "/transfer/points/1: found both"},
        Refusal{R"({"version": 1, "transfer": {"points": [{"value": 1, "opacity": 1.5}]}})",
                "/transfer/points/0/opacity: found 1.5"},
        Refusal{R"({"version": 1, "transfer": {"points": [{"value": 1, "color": {"linear": [2, 0, 0]}}]}})",
                "expected a number in [0, 1]"},
        Refusal{R"({"version": 1, "lights": [{}]})", "/lights/0: missing key \"kind\""},
        Refusal{R"({"version": 1, "lights": [{"kind": "spot"}]})",
                "/lights/0/kind: found \"spot\", expected one of directional, point, rect"},
        Refusal{R"({"version": 1, "lights": [{"kind": "directional"}]})",
                "/lights/0: missing key \"direction\""},
        Refusal{R"({"version": 1, "lights": [{"kind": "point"}]})", "/lights/0: missing key \"position_mm\""},
        Refusal{
            R"({"version": 1, "lights": [{"kind": "point", "position_mm": [0,0,0], "direction": [0,0,1]}]})",
            "/lights/0/direction: a point light has none"},
        Refusal{R"({"version": 1, "lights": [{"kind": "directional", "direction": [0,0,0]}]})",
                "found a zero vector"},
        Refusal{
            R"({"version": 1, "lights": [{"kind": "rect", "position_mm": [1,0,0], "target_mm": [1,0,0]}]})",
            "/lights/0/target_mm"},
        Refusal{R"({"version": 1, "camera": {"eye_mm": [1,0,0], "target_mm": [1,0,0]}})", "/camera/eye_mm"},
        Refusal{R"({"version": 1, "clip": {"x_mm": [5, 5]}})",
                "/clip/x_mm: found [5, 5], expected lower < upper"},
        Refusal{R"({"version": 1, "labels": {}})", "/labels: missing key \"path\""},
        Refusal{R"({"version": 1, "labels": {"path": ""}})", "/labels/path"}));

TEST(SceneFile, RefusesHugeAndDeepTexts) {
  EXPECT_THAT(error_of(std::string(kMaxSceneBytes + 1, ' ')), HasSubstr("expected a scene of at most"));
  EXPECT_THAT(error_of(std::string(1 << 20, '[')), HasSubstr("nested more than 16 deep"));
  std::string points = R"({"version": 1, "transfer": {"points": [)";
  for (int i = 0; i < 65537; ++i) points += i ? ",{\"value\":1}" : "{\"value\":1}";
  EXPECT_THAT(error_of(points + "]}}"),
              HasSubstr("/transfer/points: found a list of 65537, expected at most 65536"));
}

/// Every mutation of a valid scene is either a valid scene or one Error of one line.
TEST(SceneFile, SurvivesDamage) {
  std::mt19937 random(11);
  const std::string whole = write_scene(full_scene(), true);
  const std::string pieces[] = {"{",
                                "}",
                                "[",
                                "]",
                                ",",
                                ":",
                                "\"",
                                "null",
                                "-1",
                                "1e400",
                                "\\u0000",
                                "\xff\xfe",
                                "true",
                                "{}",
                                "[[[[[[[[[[[[[[[[[[[[",
                                "99999999999999999999",
                                "\"version\"",
                                "\n"};
  int valid = 0;
  for (int i = 0; i < 1000; ++i) {
    std::string text = whole;
    for (unsigned n = 1 + random() % 3; n > 0; --n) {
      const std::size_t at = random() % text.size();
      switch (random() % 4) {
        case 0:
          text[at] = static_cast<char>(random());
          break;
        case 1:
          text.erase(at, 1 + random() % 40);
          break;
        case 2:
          text.insert(at, pieces[random() % std::size(pieces)]);
          break;
        default:
          text.resize(at + 1);
      }
    }
    try {
      const SceneDescription s = parse_scene(text, "scene.json");
      ++valid;
      ASSERT_EQ(parse_scene(write_scene(s), "s"), s);
    } catch (const Error& e) {
      ASSERT_EQ(std::string(e.what()).find('\n'), std::string::npos) << e.what();
      ASSERT_LT(std::string(e.what()).size(), 1000u);
    }
  }
  EXPECT_GT(valid, 0);
  EXPECT_LT(valid, 500);
}

class SceneFolder : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_ / "sub"); }
  void TearDown() override { fs::remove_all(folder_); }
  const fs::path folder_ = fs::path(testing::TempDir()) / ("scene_file_test_" + std::to_string(::getpid()));
};

TEST_F(SceneFolder, PathsResolveFromTheScenesFolder) {
  std::ofstream(folder_ / "sub/s.json")
      << R"({"version": 1, "volume": {"path": "../ct.nrrd"}, "labels": {"path": "/abs/l.nii"},)"
      << R"( "environment": {"image": "sky.exr"}})";
  const SceneDescription s = read_scene(folder_ / "sub/s.json");
  EXPECT_EQ(s.volume.path, (folder_ / "ct.nrrd").string());
  EXPECT_EQ(s.labels->path, "/abs/l.nii");
  EXPECT_EQ(s.labels->names, "");
  EXPECT_EQ(s.environment->image, (folder_ / "sub/sky.exr").string());
}

TEST_F(SceneFolder, SavedScenesCanMoveWithTheirData) {
  SceneDescription s;
  s.volume.path = (folder_ / "sub/ct.nrrd").string();
  s.labels = LabelsDescription{"/elsewhere/labels.nii", "", 1};
  save_scene(s, folder_ / "s.json");
  EXPECT_EQ(read_scene(folder_ / "s.json"), s);
  std::stringstream text;
  text << std::ifstream(folder_ / "s.json").rdbuf();
  EXPECT_THAT(text.str(), HasSubstr("\"sub/ct.nrrd\""));
  EXPECT_THAT(text.str(), HasSubstr("\"/elsewhere/labels.nii\""));
}

TEST_F(SceneFolder, ThePhantomIsNoFile) {
  SceneDescription s;
  s.volume.path = kPhantomPath;
  save_scene(s, folder_ / "s.json");
  EXPECT_EQ(read_scene(folder_ / "s.json").volume.path, kPhantomPath);
  s.volume.path = (folder_ / "phantom").string();  // a file of that name
  save_scene(s, folder_ / "s.json");
  EXPECT_EQ(read_scene(folder_ / "s.json").volume.path, s.volume.path);
}

TEST_F(SceneFolder, FilesThatAreNotThere) {
  EXPECT_THROW(read_scene(folder_ / "none.json"), Error);
  EXPECT_THROW(read_scene(folder_), Error);
  EXPECT_THROW(save_scene(SceneDescription{}, folder_ / "no/s.json"), Error);
}

TEST(SceneFile, WritingRefusesTextThatIsNotUtf8) {
  SceneDescription s;
  s.volume.path = "a\xff";
  EXPECT_THROW(write_scene(s), Error);
}

}  // namespace
}  // namespace voxlume
