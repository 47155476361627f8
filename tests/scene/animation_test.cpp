#include "scene/animation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <numbers>
#include <sstream>

#include "scene/scene_file.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A scene with one light of each kind, a clip box and two transfer points, and this animation.
SceneDescription scene_with(const std::string& animation) {
  return parse_scene(R"({
    "version": 1,
    "transfer": {"points": [{"value": 0, "opacity": 0}, {"value": 100, "opacity": 0.5, "color": "#ffffff"}]},
    "lights": [{"kind": "directional", "direction": [0, 0, 1]},
               {"kind": "point", "position_mm": [0, 0, 100]},
               {"kind": "rect", "position_mm": [0, -300, 0]}],
    "environment": {}, "background": {"kind": "color"}, "clip": {"x_mm": [-50, 50]},
    "camera": {"target_mm": [1, 2, 3]},
    "animation": )" + animation +
                         "}",
                     "s.json");
}

SceneDescription at(const std::string& tracks, double time_s) {
  return scene_at(scene_with(R"({"tracks": [)" + tracks + "]}"), time_s);
}

TEST(SceneAt, NumbersOfEverySection) {
  const SceneDescription s = at(R"({"field": "/camera/azimuth_deg", "keys": [[0, 0], [4, 360]]},
    {"field": "/camera/zoom", "interpolation": "step", "keys": [[0, 1], [1, 2], [2, 3]]},
    {"field": "/lights/1/intensity", "keys": [[0, 10], [1, 20], [2, 0]]},
    {"field": "/environment/rotation_deg", "keys": [[1, -10]]},
    {"field": "/transfer/density_scale", "interpolation": "smooth", "keys": [[0, 0], [4, 1]]},
    {"field": "/transfer/points/1/opacity", "keys": [[1, 0.5], [2, 0.9]]},
    {"field": "/material/anisotropy", "keys": [[0, 0], [3, 0.3]]},
    {"field": "/clip/x_mm/0", "keys": [[0, -50], [2, 10]]},
    {"field": "/image/exposure_ev", "keys": [[1, 0], [2, 3]]})",
                                1.5);
  EXPECT_FALSE(s.animation);
  EXPECT_EQ(s.camera.azimuth_deg, 135);
  EXPECT_EQ(s.camera.zoom, 2);
  EXPECT_EQ((*s.lights)[1].intensity, 10);
  EXPECT_EQ(s.environment->rotation_deg, -10);
  EXPECT_EQ(s.transfer.density_scale, 0.31640625);  // s^2 (3 - 2s) at 3/8
  EXPECT_DOUBLE_EQ(*s.transfer.points[1].opacity, 0.7);
  EXPECT_DOUBLE_EQ(s.material.anisotropy, 0.15);
  EXPECT_EQ(s.clip->x_mm[0], -5);
  EXPECT_EQ(s.image.exposure_ev, 1.5);
}

TEST(SceneAt, VectorsColorsWordsAndSwitches) {
  const std::string tracks =
      R"({"field": "/lights/1/position_mm", "keys": [[0, [0, 0, 100]], [2, [20, 40, -100]]]},
    {"field": "/lights/0/direction", "keys": [[0, [0, 0, 5]], [2, [1, 0, 0]]]},
    {"field": "/lights/2/size_mm", "keys": [[0, [10, 20]], [2, [30, 20]]]},
    {"field": "/lights/2/color", "keys": [[0, "#ff0000"], [2, {"linear": [0, 0, 4]}]]},
    {"field": "/lights/2/two_sided", "keys": [[0, false], [1, true]]},
    {"field": "/background/color", "keys": [[0, [0, 0, 0]], [2, [1, 1, 1]]]},
    {"field": "/camera/eye_mm", "keys": [[0, [0, -500, 0]]]},
    {"field": "/material/shading", "keys": [[0, "phase"], [1, "brdf"]]})";
  const SceneDescription s = at(tracks, 0.5);
  EXPECT_EQ((*s.lights)[1].position_mm, (Double3{5, 10, 50}));
  EXPECT_NEAR((*(*s.lights)[0].direction)[0], std::sin(std::numbers::pi / 8), 1e-15);
  EXPECT_NEAR((*(*s.lights)[0].direction)[2], std::cos(std::numbers::pi / 8), 1e-15);
  EXPECT_THAT((*s.lights)[2].size_mm, ElementsAre(15, 20));
  EXPECT_THAT((*s.lights)[2].color.linear, ElementsAre(0.75f, 0, 1));
  EXPECT_FALSE((*s.lights)[2].two_sided);
  EXPECT_EQ(s.background->color.linear[1], 0.25f);  // halfway in light, not in the file's sRGB
  EXPECT_EQ(*s.camera.eye_mm, (Double3{0, -500, 0}));
  EXPECT_EQ(s.material.shading, Shading::kPhase);
  EXPECT_EQ(at(tracks, 1).material.shading, Shading::kBrdf);
  EXPECT_TRUE((*at(tracks, 1).lights)[2].two_sided);
}

TEST(SceneAt, PointListsGoPointByPointOrStep) {
  const std::string alike = R"({"field": "/transfer/points", "keys":
    [[0, [{"value": 0, "opacity": 0}, {"value": 100, "opacity": 0.5, "color": "#000000"}]],
     [2, [{"value": 50, "opacity": 0}, {"value": 300, "opacity": 1, "color": "#ffffff"}]]]})";
  const auto points = at(alike, 0.5).transfer.points;
  ASSERT_EQ(points.size(), 2u);
  EXPECT_EQ(points[0].value, 12.5);
  EXPECT_EQ(points[1].value, 150);
  EXPECT_EQ(points[1].opacity, 0.625);
  EXPECT_EQ(points[1].color->linear[0], 0.25f);
  EXPECT_FALSE(points[0].color);
  const std::string unlike = R"({"field": "/transfer/points", "keys":
    [[0, [{"value": 0, "opacity": 0}, {"value": 100, "opacity": 0.5}]], [2, [{"value": 50, "opacity": 1}]]]})";
  EXPECT_EQ(at(unlike, 1.9).transfer.points[1].value, 100);
  EXPECT_EQ(at(unlike, 2).transfer.points.size(), 1u);
}

TEST(SceneAt, APresetTakesThePlaceOfThePoints) {
  const SceneDescription s = at(R"({"field": "/transfer/preset", "keys": [[0, "fog"], [1, "ct-skin"]]})", 1);
  EXPECT_EQ(s.transfer.preset, "ct-skin");
  EXPECT_TRUE(s.transfer.points.empty());
}

TEST(SceneAt, StandsStillOutsideTheKeysAndJumpsAtEqualTimes) {
  const std::string track = R"({"field": "/camera/roll_deg", "keys": [[1, 10], [2, 20], [2, 50], [3, 60]])";
  for (const char* how : {"linear", "smooth"}) {
    const auto roll = [&](double time_s) {
      return at(track + R"(, "interpolation": ")" + how + "\"}", time_s).camera.roll_deg;
    };
    EXPECT_EQ(roll(-5), 10);
    EXPECT_EQ(roll(1), 10);
    EXPECT_EQ(roll(1.5), 15);
    EXPECT_LT(roll(1.999), 20);
    EXPECT_EQ(roll(2), 50);
    EXPECT_EQ(roll(2.5), 55);
    EXPECT_EQ(roll(3), 60);
    EXPECT_EQ(roll(1e5), 60);
  }
}

TEST(SceneAt, IsTheSceneItselfWithoutAnimation) {
  SceneDescription s = scene_with("{}");
  SceneDescription still = s;
  still.animation.reset();
  EXPECT_EQ(scene_at(s, 3), still);
  EXPECT_EQ(scene_at(still, 3), still);
}

TEST(SceneAt, TheTurntableTurnsAnglesAndEyes) {
  SceneDescription s = scene_with(R"({"turntable": {"seconds": 8}})");
  s.camera.azimuth_deg = 30;
  EXPECT_EQ(scene_at(s, 2).camera.azimuth_deg, 120);
  EXPECT_EQ(scene_at(s, 8).camera, scene_at(s, 0).camera);
  s.camera.eye_mm = Double3{1, -98, 13};  // at azimuth 0 of the target
  s.camera.up = Double3{0, -1, 5};
  const CameraDescription turned = scene_at(s, 2).camera;
  EXPECT_NEAR((*turned.eye_mm)[0], 101, 1e-12);  // azimuth 90 is on the patient's left
  EXPECT_NEAR((*turned.eye_mm)[1], 2, 1e-12);
  EXPECT_EQ((*turned.eye_mm)[2], 13);
  EXPECT_NEAR((*turned.up)[0], 1, 1e-12);
  s.animation->turntable->turns = -2;
  EXPECT_NEAR((*scene_at(s, 1).camera.eye_mm)[0], -99, 1e-12);
}

TEST(FrameCount, FollowsTurntableKeysAndFrames) {
  const auto count = [](const std::string& animation) {
    return frame_count(*scene_with(animation).animation);
  };
  EXPECT_EQ(count(R"({"turntable": {"seconds": 6}})"), 180);
  EXPECT_EQ(count(R"({"turntable": {}, "fps": 25})"), 150);
  EXPECT_EQ(count(R"({"fps": 10, "tracks": [{"field": "/camera/zoom", "keys": [[0, 1], [2, 2]]}]})"), 21);
  EXPECT_EQ(count(R"({"frames": 7})"), 7);
  EXPECT_EQ(count(R"({"turntable": {"seconds": 0.001}})"), 1);
  EXPECT_THROW(count("{}"), Error);
  EXPECT_THROW(count(R"({"turntable": {"seconds": 1e6}, "fps": 1000})"), Error);
}

TEST(SceneOfFrame, HasItsTimeAndItsRandomNumbers) {
  SceneDescription s = scene_with(R"({"turntable": {"seconds": 6}, "fps": 10})");
  s.render.frame = 100;
  const SceneDescription third = scene_of_frame(s, 3);
  EXPECT_EQ(third.render.frame, 103u);
  EXPECT_EQ(third.camera.azimuth_deg, 18);
  EXPECT_NE(scene_of_frame(s, 59).camera, scene_of_frame(s, 0).camera);
}

TEST(Animation, FilesKeepIt) {
  const SceneDescription s = scene_with(R"({"turntable": {"seconds": 2, "turns": -1}, "tracks": [
    {"field": "/lights/1/color", "interpolation": "smooth", "keys": [[0, "#102030"], [0.1, [0.5, 0, 1]]]},
    {"field": "/lights/0/direction", "keys": [[0, [0, 0, 1]], [1, [1, 0, 0.1]]]}]})");
  EXPECT_EQ(parse_scene(write_scene(s), "again"), s);
  SceneDescription empty = scene_with("{}");
  EXPECT_EQ(parse_scene(write_scene(empty), "again"), empty);
}

TEST(Animation, ThePagesExamplesAreScenes) {
  std::ifstream file(VOXLUME_SOURCE_DIR "/docs/animation.md");
  std::stringstream stream;
  stream << file.rdbuf();
  const std::string page = stream.str();
  int examples = 0;
  for (std::size_t at = 0; (at = page.find("```json\n", at)) != std::string::npos; ++examples) {
    at += 8;
    const std::size_t end = page.find("```", at);
    const SceneDescription s = parse_scene(page.substr(at, end - at), "example " + std::to_string(examples));
    const int last = frame_count(*s.animation) - 1;
    EXPECT_NE(scene_of_frame(s, last / 3).render, scene_of_frame(s, last).render);
    at = end + 3;
  }
  EXPECT_EQ(examples, 8);
}

struct Refused {
  const char* tracks;
  const char* message;
};

class AnimationRefuses : public testing::TestWithParam<Refused> {};

TEST_P(AnimationRefuses, WithAnAddressAndOneLine) {
  try {
    at(GetParam().tracks, 0.5);
    ADD_FAILURE() << "took " << GetParam().tracks;
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr(GetParam().message));
    EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Tracks, AnimationRefuses,
    testing::Values(
        Refused{R"({"field": "/camera/azimut_deg", "keys": [[0, 1]]})",
                "/animation/tracks/0/field: unknown field \"azimut_deg\"; did you mean \"azimuth_deg\"?"},
        Refused{R"({"field": "camera", "keys": [[0, 1]]})",
                "/animation/tracks/0/field: found field \"camera\""},
        Refused{R"({"field": "/camera", "keys": [[0, 1]]})", "\"/camera\" cannot be animated"},
        Refused{R"({"field": "/image/width", "keys": [[0, 1]]})", "\"/image/width\" cannot be animated"},
        Refused{R"({"field": "/render/seed", "keys": [[0, 1]]})", "\"/render/seed\" cannot be animated"},
        Refused{R"({"field": "/environment/image", "keys": [[0, "a.exr"]]})", "cannot be animated"},
        Refused{R"({"field": "/animation/fps", "keys": [[0, 1]]})", "cannot be animated"},
        Refused{R"({"field": "/camera/zoom", "keys": []})",
                "/animation/tracks/0/keys: found no key, expected at least one"},
        Refused{R"({"field": "/camera/zoom", "keys": [[1, 1], [0.5, 2]]})",
                "/animation/tracks/0/keys/1: found time 0.5 after 1, expected keys sorted by time"},
        Refused{R"({"field": "/camera/zoom", "keys": [[0, 1], [1, 0]]})",
                "/animation/tracks/0/keys/1/1: found 0, expected a number in [1e-06, 1000000]"},
        Refused{R"({"field": "/camera/zoom", "keys": [[0, "fast"]]})",
                "/animation/tracks/0/keys/0/1: found \"fast\", expected a number"},
        Refused{R"({"field": "/camera/zoom", "keys": [[0]]})", "/keys/0: found a list of 1, expected a key"},
        Refused{R"({"field": "/camera/zoom", "keys": [["0", 1]]})",
                "/keys/0/0: found \"0\", expected a number"},
        Refused{R"({"field": "/camera/zoom", "keys": [[0, null]]})", "/keys/0/1: found null"},
        Refused{R"({"field": "/lights/0/direction", "keys": [[0, [1, 2]]]})",
                "/keys/0/1: found a list of 2, expected a list of 3 numbers"},
        Refused{R"({"field": "/lights/2/color", "keys": [[0, "red"]]})",
                "/keys/0/1: found \"red\", expected a color"},
        Refused{R"({"field": "/material/shading", "keys": [[0, "phong"]]})", "expected one of coexistence"},
        Refused{R"({"field": "/clip/x_mm/2", "keys": [[0, 1]]})",
                "found element \"2\", expected one of the list's 2"},
        Refused{R"({"field": "/camera/zoom", "keys": [[0, 1]]}, {"field": "/camera/zoom", "keys": [[0, 1]]})",
                "/animation/tracks/1/field: found a second track"},
        Refused{R"({"field": "/camera/zoom", "kees": [[0, 1]]})",
                "unknown key \"kees\"; did you mean \"keys\"?"},
        // These are seen at their time only.
        Refused{R"({"field": "/lights/7/intensity", "keys": [[0, 1]]})",
                "/animation/tracks/0: found element \"7\", expected one of the list's 3"},
        Refused{R"({"field": "/clip/x_mm/0", "keys": [[0, 0], [1, 120]]})",
                "/clip/x_mm: found [60, 50], expected lower < upper"}));

}  // namespace
}  // namespace voxlume
