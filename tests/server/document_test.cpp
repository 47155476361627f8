#include "server/document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "grid/volume_statistics.h"
#include "scene/resolve.h"
#include "scene/scene_file.h"
#include "support/volumes.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

using nlohmann::json;
using testing::HasSubstr;

class DocumentTest : public testing::Test {
 protected:
  Document make() { return Document(resolved(first_scene()), rules()); }
  SceneDescription first_scene() const {
    SceneDescription scene;
    scene.volume.path = "noise";
    scene.image.width = 100;
    scene.image.height = 80;
    return scene;
  }
  SceneDescription resolved(const SceneDescription& scene) const {
    return resolve(scene, volume_, statistics_);
  }
  Document::Rules rules() const {
    return {.resolve = [this](const SceneDescription& scene) { return resolved(scene); },
            .check_paths =
                [](SceneDescription& scene, const SceneDescription&) {
                  for_each_path(scene, [](std::string& path) {
                    if (path.starts_with("/forbidden"))
                      throw Error(ErrorCode::kBadParameter, path, "is outside");
                  });
                }};
  }
  static std::string refusal(Document& document, const std::vector<FieldEdit>& fields) {
    const json before = document.json();
    const bool could_undo = document.can_undo();
    try {
      document.edit(fields);
    } catch (const Error& error) {
      EXPECT_EQ(document.json(), before);
      EXPECT_EQ(document.can_undo(), could_undo);
      return error.what();
    }
    ADD_FAILURE() << "not refused";
    return "";
  }

  const Volume volume_ = test::noise_volume<std::int16_t>({8, 8, 8}, -1000, 1000, 1);
  const VolumeStatistics statistics_ = compute_statistics(make_grid_view(volume_));
};

TEST_F(DocumentTest, HasEveryFieldAndIsTheScene) {
  const Document document = make();
  EXPECT_EQ(parse_scene(document.json().dump(), "scene"), document.scene());
  EXPECT_TRUE(document.json()["camera"].contains("azimuth_deg"));
  EXPECT_FALSE(document.can_undo());
  EXPECT_FALSE(document.can_redo());
}

TEST_F(DocumentTest, EditGivesTheSectionsThatChanged) {
  Document document = make();
  const json changed = document.edit({{"/camera/azimuth_deg", 30}, {"/image/exposure_ev", 1.5}});
  EXPECT_EQ(changed.size(), 2u);
  EXPECT_EQ(changed["camera"]["azimuth_deg"], 30);
  EXPECT_EQ(changed["camera"], document.json()["camera"]);
  EXPECT_EQ(document.scene().camera.azimuth_deg, 30);
  EXPECT_EQ(document.scene().image.exposure_ev, 1.5);
}

TEST_F(DocumentTest, EditThatChangesNothingIsNoStep) {
  Document document = make();
  EXPECT_TRUE(document.edit({{"/camera/azimuth_deg", 0}}).empty());
  EXPECT_TRUE(document.edit({}).empty());
  EXPECT_FALSE(document.can_undo());
}

TEST_F(DocumentTest, SectionsComeAndGo) {
  Document document = make();
  const json clip{{"x_mm", {-1, 1}}};
  EXPECT_TRUE(document.edit({{"/clip", clip}}).contains("clip"));
  EXPECT_EQ(document.scene().clip->x_mm[1], 1);
  const json gone = document.edit({{"/clip", nullptr}});
  ASSERT_TRUE(gone.contains("clip"));
  EXPECT_TRUE(gone["clip"].is_null());
  EXPECT_FALSE(document.scene().clip);
  document.edit({{"/clip/blocks_light", true}});  // made on the way
  EXPECT_TRUE(document.scene().clip->blocks_light);
}

TEST_F(DocumentTest, ListsGrowShrinkAndChange) {
  Document document = make();
  const std::size_t count = document.scene().lights->size();
  document.edit({{"/lights/-", {{"kind", "point"}, {"position_mm", {1, 2, 3}}}}});
  ASSERT_EQ(document.scene().lights->size(), count + 1);
  const std::string last = "/lights/" + std::to_string(count);
  document.edit({{last + "/intensity", 42}});
  EXPECT_EQ(document.scene().lights->back().intensity, 42);
  document.edit({{last, nullptr}});
  EXPECT_EQ(document.scene().lights->size(), count);
}

TEST_F(DocumentTest, APresetBringsItsPoints) {
  Document document = make();
  const json changed = document.edit({{"/transfer/preset", "ct-skin"}, {"/transfer/points", json::array()}});
  EXPECT_EQ(changed["transfer"]["preset"], "ct-skin");
  EXPECT_GT(changed["transfer"]["points"].size(), 1u);
}

TEST_F(DocumentTest, WhatIsWrongIsRefusedWholeWithItsAddress) {
  Document document = make();
  EXPECT_THAT(refusal(document, {{"/camera/azimuth_deg", 10}, {"/camera/zoom", -1}}),
              HasSubstr("/camera/zoom: "));
  EXPECT_THAT(refusal(document, {{"/camera/zoom", "x"}}), HasSubstr("/camera/zoom: "));
  EXPECT_THAT(refusal(document, {{"/transfer/points/1/value", "x"}}), HasSubstr("/transfer/points/1/value"));
  EXPECT_THAT(refusal(document, {{"/transfer/preset", "ct-bon"}, {"/transfer/points", json::array()}}),
              HasSubstr("ct-bone"));
  EXPECT_THAT(refusal(document, {{"/nothing", 1}}), HasSubstr("nothing"));
  EXPECT_THAT(refusal(document, {{"/camera/nothing", 1}}), HasSubstr("nothing"));
  EXPECT_THAT(refusal(document, {{"/version", nullptr}}), HasSubstr("version"));
  EXPECT_THAT(refusal(document, {{"/version", 99}}), HasSubstr("version"));
  EXPECT_THAT(refusal(document, {{"/clip", {{"x_mm", {500, 600}}}}}), HasSubstr("/clip/x_mm: "));
  // What no picture can be made of.
  EXPECT_THAT(refusal(document, {{"/camera/zoom", 1e-9}}), HasSubstr("/camera/zoom: "));
  EXPECT_THAT(refusal(document, {{"/camera/target_mm", {1e9, 0, 0}}}), HasSubstr("/camera/target_mm: "));
  EXPECT_THAT(refusal(document, {{"/camera/fit_radius_mm", 1e9}}), HasSubstr("/camera/fit_radius_mm: "));
  EXPECT_THAT(refusal(document, {{"/transfer/density_scale", 1e6}}), HasSubstr("/transfer/density_scale: "));
}

TEST_F(DocumentTest, AddressesThatLeadNowhereAreRefused) {
  Document document = make();
  for (const char* pointer :
       {"", "camera", "camera/zoom", "/camera/zoom/x", "/lights/99", "/lights/x", "/lights/-/color",
        "/lights/-1", "/lights/18446744073709551616", "/camera/~2", "/camera/~", "/"})
    EXPECT_NE(refusal(document, {{pointer, 1}}), "") << pointer;
  EXPECT_NE(refusal(document, {{"/lights/-", nullptr}}), "");
  EXPECT_THAT(refusal(document, {{std::string(4000, '/'), 1}}), HasSubstr("at most 32 names"));
  EXPECT_NE(refusal(document, {{"/lights/99", nullptr}}), "");
}

TEST_F(DocumentTest, AnotherVolumeIsRefused) {
  Document document = make();
  EXPECT_THAT(refusal(document, {{"/volume/path", "other"}}), HasSubstr("/volume"));
  EXPECT_THAT(refusal(document, {{"/volume", nullptr}}), HasSubstr("/volume"));
  EXPECT_THAT(refusal(document, {{"/volume/spacing_mm", {1, 1, 2}}}), HasSubstr("/volume"));
}

TEST_F(DocumentTest, PathsAreLookedAt) {
  Document document = make();
  EXPECT_THAT(refusal(document, {{"/environment/image", "/forbidden/x.exr"}}), HasSubstr("outside"));
}

TEST_F(DocumentTest, HugePicturesAreRefused) {
  Document document = make();
  EXPECT_THAT(refusal(document, {{"/image/width", 65536}, {"/image/height", 65536}}),
              HasSubstr("/image/width"));
}

TEST_F(DocumentTest, UndoAndRedoGoThroughAllSteps) {
  Document document = make();
  std::vector<json> states{document.json()};
  for (int i = 1; i <= 5; ++i) {
    document.edit({{"/camera/azimuth_deg", i * 10}});
    if (i == 3) document.edit({{"/clip", {{"x_mm", {-1, 1}}}}}), document.undo();
    states.push_back(document.json());
  }
  for (int i = 4; i >= 0; --i) {
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(document.json(), states[static_cast<std::size_t>(i)]);
    EXPECT_EQ(parse_scene(document.json().dump(), "scene"), document.scene());
  }
  EXPECT_FALSE(document.undo());
  for (int i = 1; i <= 5; ++i) {
    ASSERT_TRUE(document.redo());
    EXPECT_EQ(document.json(), states[static_cast<std::size_t>(i)]);
  }
  EXPECT_FALSE(document.redo());
}

TEST_F(DocumentTest, AnEditAfterUndoEndsRedo) {
  Document document = make();
  document.edit({{"/camera/azimuth_deg", 10}});
  document.undo();
  document.edit({{"/camera/elevation_deg", 10}});
  EXPECT_FALSE(document.can_redo());
}

TEST_F(DocumentTest, AGestureIsOneStep) {
  Document document = make();
  const json first = document.json();
  for (int i = 1; i <= 20; ++i) document.edit({{"/camera/azimuth_deg", i}}, "orbit-1");
  document.edit({{"/camera/zoom", 2}}, "orbit-1");
  const json after = document.json();
  document.edit({{"/camera/zoom", 3}}, "zoom-2");
  document.undo();
  EXPECT_EQ(document.json(), after);
  document.undo();
  EXPECT_EQ(document.json(), first);
  document.redo();
  EXPECT_EQ(document.json(), after);
}

TEST_F(DocumentTest, EditsOutOfGesturesAndAfterUndoAreStepsOfTheirOwn) {
  Document document = make();
  document.edit({{"/camera/azimuth_deg", 1}}, "g");
  document.edit({{"/camera/azimuth_deg", 2}});
  document.edit({{"/camera/azimuth_deg", 3}}, "g");
  document.undo();
  EXPECT_EQ(document.scene().camera.azimuth_deg, 2);
  document.undo();
  EXPECT_EQ(document.scene().camera.azimuth_deg, 1);
  document.edit({{"/camera/azimuth_deg", 5}}, "g");
  document.undo();
  EXPECT_EQ(document.scene().camera.azimuth_deg, 1);
}

TEST_F(DocumentTest, InterleavedGesturesOfDifferentMembersAreAStepEach) {
  Document document = make();
  const json first = document.json();
  for (int i = 1; i <= 10; ++i) {
    document.edit({{"/camera/azimuth_deg", i}}, "1 orbit");
    document.edit({{"/image/exposure_ev", 0.1 * i}}, "2 exposure");
  }
  const json after = document.json();
  document.undo();  // the one that began last
  EXPECT_EQ(document.scene().image.exposure_ev, 0);
  EXPECT_EQ(document.scene().camera.azimuth_deg, 10);
  document.undo();
  EXPECT_EQ(document.json(), first);
  EXPECT_FALSE(document.can_undo());
  document.redo();
  document.redo();
  EXPECT_EQ(document.json(), after);
}

TEST_F(DocumentTest, AGestureTakesUpFurtherMembersUnlessTheyWereChangedInBetween) {
  Document document = make();
  const json first = document.json();
  document.edit({{"/camera/azimuth_deg", 1}}, "1 g");
  document.edit({{"/image/exposure_ev", 1}}, "2 g");
  document.edit({{"/camera/azimuth_deg", 2}, {"/clip", {{"x_mm", {-1, 1}}}}}, "1 g");  // joins
  document.edit({{"/image/exposure_ev", 2}}, "1 g");                                   // does not
  document.undo();
  EXPECT_EQ(document.scene().image.exposure_ev, 1);
  EXPECT_TRUE(document.scene().clip);
  document.undo();
  EXPECT_EQ(document.scene().image.exposure_ev, 0);
  EXPECT_EQ(document.scene().camera.azimuth_deg, 2);
  EXPECT_TRUE(document.scene().clip);
  document.undo();
  EXPECT_EQ(document.json(), first);
  EXPECT_FALSE(document.can_undo());
}

TEST_F(DocumentTest, InterleavedGesturesOfOneMemberAreStepsOfTheirOwn) {
  Document document = make();
  std::vector<json> states{document.json()};
  for (int i = 1; i <= 3; ++i) {
    document.edit({{"/camera/azimuth_deg", i}}, "1 g");
    states.push_back(document.json());
    document.edit({{"/camera/zoom", 1 + i}}, "2 g");
    states.push_back(document.json());
  }
  for (std::size_t i = states.size() - 1; i-- > 0;) {
    ASSERT_TRUE(document.undo());
    EXPECT_EQ(document.json(), states[i]);
  }
  EXPECT_FALSE(document.can_undo());
}

TEST_F(DocumentTest, ThePicturesSizeIsLeftOutOfUndo) {
  Document document = make();
  const json changed = document.edit({{"/image/width", 200}, {"/image/height", 150}});
  EXPECT_EQ(changed["image"]["width"], 200);
  EXPECT_FALSE(document.can_undo());
  document.edit({{"/image/exposure_ev", 1}}, "g");
  document.edit({{"/image/width", 300}});
  document.edit({{"/image/exposure_ev", 2}}, "g");  // the size did not end the gesture
  document.undo();
  EXPECT_EQ(document.scene().image.exposure_ev, 0);
  EXPECT_EQ(document.scene().image.width, 300);
  EXPECT_EQ(document.scene().image.height, 150);
  document.edit({{"/image/width", 400}});
  EXPECT_TRUE(document.can_redo());
  document.redo();
  EXPECT_EQ(document.scene().image.exposure_ev, 2);
  EXPECT_EQ(document.scene().image.width, 400);
}

TEST_F(DocumentTest, HistoryIsBounded) {
  Document document = make();
  for (int i = 1; i <= 300; ++i) document.edit({{"/camera/azimuth_deg", i}});
  int steps = 0;
  while (document.undo()) ++steps;
  EXPECT_EQ(steps, 200);
  EXPECT_EQ(document.scene().camera.azimuth_deg, 100);
}

TEST_F(DocumentTest, AnotherSceneIsOneStep) {
  Document document = make();
  const json before = document.json();
  SceneDescription other = first_scene();
  other.camera.azimuth_deg = 77;
  other.clip.emplace();
  document.replace(other);
  EXPECT_EQ(document.scene().camera.azimuth_deg, 77);
  document.undo();
  EXPECT_EQ(document.json(), before);
  other.volume.path = "another";
  EXPECT_THROW(document.replace(other), Error);
}

}  // namespace
}  // namespace voxlume::server
