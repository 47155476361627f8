#include "server_fixture.h"

namespace voxlume::test {
namespace {

using testing::HasSubstr;

using SharedScene = ServerTest;

TEST_F(SharedScene, CompilingTellsHowFarItIs) {
  server::ServerOptions impatient = options();
  impatient.scene = ramp_scene();
  impatient.live.patience_s = 0;
  Page page(start(impatient));
  page.next("frame", [](const json& m) { return m["done"] == true; });
  // How many shares are told of one scene: growing, up to 1.
  const auto told = [&] {
    int count = 0;
    for (double share = 0; share < 1; ++count) {
      const double now = page.next("compiling")["share"];
      EXPECT_GT(now, share);
      EXPECT_LE(now, 1);
      share = now;
    }
    return count;
  };
  page.send(edit(1, "/visibility", {{"important", json::array({{{"range", {100, 5000}}}})}}));
  EXPECT_EQ(page.next("edited")["seq"], 1);
  EXPECT_GE(told(), 1);
  // Volumes derived from others, whose rows are told of at once.
  page.send(edit(2, "/proxies", json::array({{{"name", "g"}, {"kind", "gradient"}}})));
  EXPECT_EQ(page.next("edited")["seq"], 2);
  while (told() < 2) continue;
}

TEST_F(SharedScene, APictureIsAWholePng) {
  Page page(start_with_ramp());
  const json frame = page.next("frame", [](const json& m) { return m["done"] == true; });
  EXPECT_EQ(frame["format"], "png");
  EXPECT_EQ(frame["moving"], false);
  EXPECT_EQ(frame["full"], json({32, 24}));
  EXPECT_EQ(frame["width"], 32);
  EXPECT_EQ(frame["limit"], "nothing");
  EXPECT_EQ(frame["spp"], 2);
  EXPECT_EQ(frame["camera"]["eye_mm"].size(), 3u);
  const std::string& png = page.last_picture();
  EXPECT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
  EXPECT_EQ(png.substr(png.size() - 8, 4), "IEND");
}

TEST_F(SharedScene, MovingPicturesAreJpeg) {
  Page page(start_with_ramp());
  page.next("frame", [](const json& m) { return m["done"] == true; });
  for (int i = 0; i < 10; ++i) page.send(edit(i, "/camera/azimuth_deg", i));
  const json frame = page.next("frame", [](const json& m) { return m["moving"] == true; });
  EXPECT_EQ(frame["format"], "jpeg");
  EXPECT_EQ(page.last_picture().substr(0, 2), "\xFF\xD8");
}

TEST_F(SharedScene, AStillPictureIsDevelopedAgainWithoutMoving) {
  Page page(start_with_ramp());
  page.next("frame", [](const json& m) { return m["done"] == true; });
  for (int i = 1; i <= 5; ++i) page.send(edit(i, "/image/exposure_ev", 0.2 * i));
  const json last = page.next("edited", [](const json& m) { return m["seq"] == 5; });
  page.send({{"type", "split"}, {"at", 0.5}});
  json frame;
  do {
    frame = page.next("frame");
    EXPECT_EQ(frame["moving"], false);
    EXPECT_EQ(frame["width"], 32);
  } while (frame["done"] != true || frame["revision"] != last["revision"]);
  EXPECT_EQ(frame["format"], "png");
}

TEST_F(SharedScene, EditsAreAnsweredInOrderAndSeen) {
  Page page(start_with_ramp());
  std::uint64_t revision = page.next("scene")["revision"];
  for (int i = 1; i <= 30; ++i) page.send(edit(i, "/camera/azimuth_deg", i));
  for (int i = 1; i <= 30; ++i) {
    const json edited = page.next("edited");
    EXPECT_EQ(edited["seq"], i);
    EXPECT_EQ(edited["sections"]["camera"]["azimuth_deg"], i);
    EXPECT_EQ(edited["revision"], ++revision);
    EXPECT_EQ(edited["can_undo"], true);
  }
  const json frame = page.next("frame", [&](const json& m) { return m["revision"] == revision; });
  EXPECT_EQ(frame["revision"], revision);
}

TEST_F(SharedScene, WrongEditsAreRefusedWithTheirPlace) {
  Page page(start_with_ramp());
  page.send(edit(5, "/transfer/points/1/value", "x"));
  json refused = page.next("refused");
  EXPECT_EQ(refused["seq"], 5);
  EXPECT_EQ(refused["where"], "/transfer/points/1/value");
  EXPECT_THAT(refused["message"].get<std::string>(), HasSubstr("number"));
  page.send({{"type", "edit"}, {"seq", 6}, {"set", 5}});
  EXPECT_EQ(page.next("refused")["seq"], 6);
  page.send(edit(7, "/camera/zoom", 2));
  EXPECT_EQ(page.next("edited")["seq"], 7);
}

TEST_F(SharedScene, EditsWhileNothingIsOpenAreRefused) {
  Page page(start());
  page.send(edit(1, "/camera/zoom", 2));
  EXPECT_EQ(page.next("refused")["seq"], 1);
  for (const char* type : {"undo", "redo"}) {
    page.send({{"type", type}});
    EXPECT_TRUE(page.next("refused")["seq"].is_null());
  }
  page.send({{"type", "probe"}, {"id", 4}, {"x", 0.5}, {"y", 0.5}});
  EXPECT_EQ(page.next("probe"), json({{"type", "probe"}, {"id", 4}, {"hit", false}}));
  page.send({{"type", "probe"}, {"id", 5}, {"position_mm", {0, 0, 0}}});
  EXPECT_EQ(page.next("probe"), json({{"type", "probe"}, {"id", 5}, {"hit", false}}));
}

TEST_F(SharedScene, TwoPagesSeeTheSame) {
  const Address& at = start_with_ramp();
  Page one(at);
  one.next("scene");
  Page two(at);
  two.next("scene");
  EXPECT_EQ(one.next("viewers", [](const json& m) { return m["count"] == 2; })["count"], 2);
  one.send(edit(1, "/camera/zoom", 2));
  const json told = two.next("edited");
  EXPECT_EQ(told["sections"]["camera"]["zoom"], 2);
  EXPECT_FALSE(told.contains("seq"));
  EXPECT_EQ(one.next("edited")["seq"], 1);
  two.send({{"type", "undo"}});
  EXPECT_EQ(one.next("scene")["scene"]["camera"]["zoom"], 1);
  EXPECT_EQ(two.next("scene")["can_redo"], true);
  two.send({{"type", "split"}, {"at", 0.25}});
  EXPECT_EQ(one.next("split")["at"], 0.25);
  two.cut();
  one.next("viewers", [](const json& m) { return m["count"] == 1; });
}

TEST_F(SharedScene, GesturesOfTwoPagesAreStepsOfTheirOwn) {
  const Address& at = start_with_ramp();
  Page one(at), two(at);
  one.send(edit(1, "/camera/zoom", 2, "drag"));
  one.next("edited");
  two.send(edit(1, "/camera/azimuth_deg", 50, "drag"));
  two.next("edited", [](const json& m) { return m.contains("seq"); });
  one.send({{"type", "undo"}});
  const json scene = one.next("scene", [](const json& m) { return m["can_redo"] == true; });
  EXPECT_EQ(scene["scene"]["camera"]["azimuth_deg"], 0);
  EXPECT_EQ(scene["scene"]["camera"]["zoom"], 2);
}

TEST_F(SharedScene, WhatNobodyMayExpectOfASceneIsTold) {
  write_volume(
      make_volume<std::uint8_t>({4, 4, 4}, [](auto, auto, auto) { return 1; }, {.origin_mm = {500, 0, 0}}),
      files_ / "far.nrrd");
  Page page(start_with_ramp());
  EXPECT_EQ(page.next("warnings")["lines"], json::array());
  const json far{{"name", "far"}, {"kind", "file"}, {"path", "far.nrrd"}, {"lookup", "nearest"}};
  page.send(edit(1, "/proxies", json::array({far})));
  const auto lines = [&] { return page.next("warnings")["lines"].dump(); };
  EXPECT_THAT(lines(), HasSubstr("lies nowhere in the volume"));
  EXPECT_THAT(Page(*address_).next("warnings")["lines"].dump(), HasSubstr("lies nowhere"));
  page.send(edit(2, "/transfer/density_scale", 0));
  EXPECT_THAT(lines(), testing::AllOf(HasSubstr("lies nowhere"), HasSubstr("nothing is visible")));
  page.send({{"type", "undo"}});
  EXPECT_THAT(lines(), testing::Not(HasSubstr("nothing is visible")));
  page.send({{"type", "undo"}});
  EXPECT_EQ(lines(), "[]");
}

TEST_F(SharedScene, SeekingShowsATimeAndChangesNothing) {
  Page page(start_with_ramp());
  const json before = page.next("scene");
  page.send(edit(1, "/animation", {{"turntable", {{"seconds", 4}}}}));
  page.next("edited");
  const json still =
      page.next("frame", [](const json& m) { return m["done"] == true && m["revision"] == 2; });
  page.send({{"type", "seek"}, {"time_s", 2}});
  const json behind = page.next("frame", [](const json& m) { return m["revision"] == 3; });
  EXPECT_NEAR(behind["camera"]["eye_mm"][1].get<double>(), -still["camera"]["eye_mm"][1].get<double>(), 0.01);
  page.send({{"type", "seek"}, {"time_s", nullptr}});
  const json back = page.next("frame", [](const json& m) { return m["revision"] == 4; });
  EXPECT_EQ(back["camera"], still["camera"]);
  EXPECT_EQ(Page(*address_).next("scene")["scene"]["camera"], before["scene"]["camera"]);
}

TEST_F(SharedScene, APageThatGoesEndsItsSeeking) {
  Page page(start_with_ramp());
  page.send(edit(1, "/animation", {{"turntable", {{"seconds", 4}}}}));
  const json still =
      page.next("frame", [](const json& m) { return m["done"] == true && m["revision"] == 2; });
  {
    Page other(*address_);
    other.send({{"type", "seek"}, {"time_s", 2}});
    page.next("frame", [](const json& m) { return m["revision"] == 3; });
    other.cut();
  }
  const json back = page.next("frame", [](const json& m) { return m["revision"] == 4; });
  EXPECT_EQ(back["camera"], still["camera"]);
}

json passing(int seq, const std::vector<std::pair<std::string, json>>& fields) {
  json message = edit(seq, fields);
  message["type"] = "passing";
  return message;
}

TEST_F(SharedScene, WhatIsSetInPassingIsSeenAndNotKept) {
  Page page(start_with_ramp());
  const json still = page.next("frame", [](const json& m) { return m["done"] == true; });
  page.send(passing(1, {{"/camera/azimuth_deg", 180}}));
  const json answer = page.next("edited");
  EXPECT_EQ(answer["seq"], 1);
  EXPECT_EQ(answer["sections"], json::object());
  EXPECT_EQ(answer["can_undo"], false);
  const json behind = page.next("frame", [&](const json& m) { return m["revision"] == answer["revision"]; });
  EXPECT_NEAR(behind["camera"]["eye_mm"][1].get<double>(), -still["camera"]["eye_mm"][1].get<double>(), 0.01);
  EXPECT_EQ(json::parse(get(*address_, "/api/scene.json").body)["camera"].value("azimuth_deg", 0.0), 0);
  {
    Page other(*address_);
    EXPECT_EQ(other.next("scene")["scene"]["camera"]["azimuth_deg"], 0);
    EXPECT_EQ(other.next("frame")["camera"], behind["camera"]);
    // It stays with the edits of others.
    other.send(edit(1, "/camera/zoom", 2));
    other.next("edited");
  }
  const json edited = page.next("edited", [](const json& m) { return !m["sections"].empty(); });
  const json both = page.next("frame", [&](const json& m) { return m["revision"] == edited["revision"]; });
  const double behind_mm = behind["camera"]["eye_mm"][1];
  EXPECT_NEAR(both["camera"]["eye_mm"][1].get<double>(), behind_mm / 2, 0.01);
  page.send(passing(2, {}));
  const json after = page.next("edited");
  const json back = page.next("frame", [&](const json& m) { return m["revision"] == after["revision"]; });
  EXPECT_NEAR(back["camera"]["eye_mm"][1].get<double>(), -behind_mm / 2, 0.01);
}

TEST_F(SharedScene, APageThatGoesTakesAlongWhatItSetInPassing) {
  Page page(start_with_ramp());
  const json still = page.next("frame", [](const json& m) { return m["done"] == true; });
  {
    Page other(*address_);
    other.send(passing(1, {{"/camera/azimuth_deg", 90}}));
    const json turned = page.next("frame", [&](const json& m) { return m["camera"] != still["camera"]; });
    page.send(passing(1, {}));  // what is another's is not ended
    EXPECT_EQ(page.next("edited")["revision"], turned["revision"]);
    other.cut();
  }
  page.next("frame", [&](const json& m) { return m["camera"] == still["camera"]; });
}

TEST_F(SharedScene, WhatDoesNotFitIsNotSetInPassing) {
  Page page(start_with_ramp());
  page.next("scene");
  page.send(passing(1, {{"/lights/7/intensity", 2}}));
  EXPECT_EQ(page.next("refused")["seq"], 1);
  page.send(passing(2, {{"/volume/path", "labels.nrrd"}}));
  EXPECT_EQ(page.next("refused")["seq"], 2);
  // A light that is taken away meanwhile.
  page.send(edit(3, "/lights/-", {{"kind", "point"}, {"position_mm", {0, -50, 0}}}));
  const json lights = page.next("edited")["sections"]["lights"];
  const std::string last = "/lights/" + std::to_string(lights.size() - 1);
  page.send(passing(4, {{last + "/intensity", 2}}));
  EXPECT_EQ(page.next("edited")["seq"], 4);
  page.send(edit(5, last, nullptr));
  const json gone = page.next("edited");
  EXPECT_EQ(gone["seq"], 5);
  page.next("frame", [&](const json& m) { return m["revision"] == gone["revision"] && m["done"] == true; });
}

TEST_F(SharedScene, ProbesFindPlaceValueAndLabel) {
  Page page(start_with_ramp());
  page.send(edit(1, "/labels", {{"path", "labels.nrrd"}}));
  page.next("frame", [](const json& m) { return m["done"] == true && m["revision"] == 2; });
  page.send({{"type", "probe"}, {"id", 7}, {"x", 0.52}, {"y", 0.5}});
  const json hit = page.next("probe");
  ASSERT_EQ(hit["hit"], true);
  EXPECT_EQ(hit["id"], 7);
  const auto place = hit["position_mm"].get<std::array<double, 3>>();
  // The camera looks along +y at a nearly opaque cube: its front face.
  EXPECT_LT(place[1], -6);
  EXPECT_NEAR(place[2], 0, 0.6);
  const auto index = [&](int a) { return std::clamp(place[static_cast<std::size_t>(a)] + 7.5, 0.0, 15.0); };
  EXPECT_NEAR(hit["value"].get<double>(), index(0) + 20 * index(1) + 400 * index(2), 1);
  EXPECT_NEAR(hit["voxel"][0].get<double>(), index(0), 0.51);
  const int label = place[0] < 0 ? 1 : 2;
  EXPECT_EQ(hit["labels"],
            json::array({{{"of", "labels"}, {"value", label}, {"name", label == 1 ? "left" : "right"}}}));
  page.send({{"type", "probe"}, {"id", 8}, {"x", 0}, {"y", 0}});
  EXPECT_EQ(page.next("probe"), json({{"type", "probe"}, {"id", 8}, {"hit", false}}));
  // The same place by its position, and one between voxels that the picture does not show.
  page.send({{"type", "probe"}, {"id", 9}, {"position_mm", place}});
  json again = page.next("probe");
  again["id"] = 7;
  EXPECT_EQ(again, hit);
  page.send({{"type", "probe"}, {"id", 10}, {"position_mm", {-1.25, 2.5, 0.75}}});
  const json deep = page.next("probe");
  EXPECT_NEAR(deep["value"].get<double>(), 6.25 + 20 * 10 + 400 * 8.25, 0.01);
  EXPECT_EQ(deep["labels"][0]["value"], 1);
  page.send({{"type", "probe"}, {"id", 11}, {"position_mm", {0, 0, 8.1}}});
  EXPECT_EQ(page.next("probe"), json({{"type", "probe"}, {"id", 11}, {"hit", false}}));
}

TEST_F(SharedScene, LabelsOfTheLongestNameAreProbedToo) {
  // That of the file of their names would be too long for the disk.
  const std::string longest = std::string(250, 'x') + ".nrrd";
  std::filesystem::copy(files_ / "labels.nrrd", files_ / longest);
  Page page(start_with_ramp());
  page.send(edit(1, "/labels", {{"path", longest}}));
  EXPECT_EQ(page.next("edited")["seq"], 1);
  page.send({{"type", "probe"}, {"id", 1}, {"position_mm", {-3, 0, 0}}});
  const json labels = page.next("probe")["labels"];
  ASSERT_EQ(labels.size(), 1u);
  EXPECT_EQ(labels[0]["value"], 1);
}

TEST_F(SharedScene, TroubleIsToldAndTheLastGoodPictureStays) {
  Page page(start_with_ramp());
  write_bytes(files_ / "broken.exr", "no picture");
  page.send(edit(1, "/environment/image", "broken.exr"));
  page.next("edited");
  EXPECT_NE(page.next("trouble")["message"], "");
  page.send({{"type", "undo"}});
  const json scene = page.next("scene", [](const json& m) { return m["can_redo"] == true; });
  page.next("frame", [&](const json& m) { return m["revision"] == scene["revision"]; });
}

}  // namespace
}  // namespace voxlume::test
