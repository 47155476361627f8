#include "server_fixture.h"

namespace voxlume::test {
namespace {

using testing::HasSubstr;

using Socket = ServerTest;

TEST_F(Socket, OpensForTheRightPageAlone) {
  const Address& at = start();
  EXPECT_THROW(Page(at, {.cookie = ""}), std::runtime_error);
  EXPECT_THROW(Page(at, {.cookie = "voxlume_" + std::to_string(at.port) + "=" + std::string(32, '0')}),
               std::runtime_error);
  EXPECT_THROW(Page(at, {.origin = "http://evil.example"}), std::runtime_error);
  EXPECT_THROW(Page(at, {.origin = "null"}), std::runtime_error);
  EXPECT_THROW(Page(at, {.host = "evil.example"}), std::runtime_error);
  EXPECT_EQ(Page(at, {.origin = "http://" + at.host()}).next()["type"], "hello");
  EXPECT_EQ(Page(at, {.host = "localhost:9", .origin = "http://localhost:9"}).next()["type"], "hello");
}

TEST_F(Socket, HelloComesFirstAndSaysWhatThereIs) {
  write_bytes(files_ / "sky.exr", "x");
  Page page(start());
  const json hello = page.next();
  ASSERT_EQ(hello["type"], "hello");
  EXPECT_EQ(hello["folder"], "files");
  EXPECT_TRUE(hello["movies"].is_boolean());
  EXPECT_EQ(hello["samples"].back()["path"], "phantom");
  EXPECT_EQ(hello["environments"][0]["name"], "sky");
  for (const char* list : {"presets", "materials", "denoisers"}) {
    ASSERT_FALSE(hello[list].empty()) << list;
    EXPECT_TRUE(hello[list][0].contains("summary")) << list;
  }
  EXPECT_EQ(hello["materials"][0]["color"].get<std::string>().size(), 7u);
  const json status = page.next();
  EXPECT_EQ(status["type"], "status");
  EXPECT_EQ(status["stage"], "empty");
  EXPECT_EQ(page.next("viewers")["count"], 1);
}

TEST_F(Socket, SampleScenesAreOfferedAndOpenDenoised) {
  namespace fs = std::filesystem;
  fs::create_directories(folder_ / "program/data");
  fs::create_directories(folder_ / "program/examples");
  fs::copy(files_ / "ramp.nrrd", folder_ / "program/data/ramp.nrrd");
  write_bytes(folder_ / "program/examples/brain-regions.json",
              R"({"version":1,"volume":{"path":"../data/ramp.nrrd"}})");
  write_bytes(folder_ / "program/examples/other.json",
              R"({"version":1,"volume":{"path":"../data/ramp.nrrd"}})");
  server::ServerOptions with_samples = options();
  with_samples.samples = folder_ / "program/data";
  Page page(start(with_samples));
  const json sample = page.next("hello")["samples"][0];
  EXPECT_EQ(sample["name"], "Brain regions");
  page.send({{"type", "open"}, {"path", sample["path"]}});
  EXPECT_EQ(page.next("scene")["scene"]["render"]["denoise"], "decoupled");
  page.send({{"type", "open"}, {"path", (folder_ / "program/examples/other.json").string()}});
  EXPECT_THAT(
      page.next("status", [](const json& m) { return m["stage"] == "failed"; })["message"].get<std::string>(),
      HasSubstr("outside"));
}

TEST_F(Socket, EnvironmentsThatAreToldOfCanBeRead) {
  write_bytes(files_ / "sky.exr", "a picture");
  write_bytes(folder_ / "hidden.exr", "a picture");
  std::filesystem::create_symlink(folder_ / "hidden.exr", files_ / "link.exr");
  std::filesystem::create_symlink("nothing.hdr", files_ / "dangling.hdr");
  std::filesystem::create_symlink("sky.exr", files_ / "same.exr");
  const json environments = Page(start()).next("hello")["environments"];
  std::vector<std::string> names;
  for (const json& one : environments) names.push_back(one["name"]);
  EXPECT_THAT(names, testing::ElementsAre("same", "sky"));
  EXPECT_THAT(environments.dump(), testing::Not(HasSubstr("hidden")));
}

TEST_F(Socket, OpeningTellsItsStagesThenTheSceneThenPictures) {
  Page page(start());
  page.send({{"type", "open"}, {"path", "ramp.nrrd"}});
  const auto new_stage = [](const json& m) { return m["stage"] != "empty" && !m.contains("share"); };
  EXPECT_EQ(page.next("status", new_stage)["stage"], "reading");
  EXPECT_EQ(page.next("status", new_stage)["stage"], "preparing");
  EXPECT_EQ(page.next("status", new_stage)["stage"], "ready");
  const json scene = page.next("scene");
  EXPECT_EQ(scene["scene"]["volume"]["path"], (std::filesystem::canonical(files_) / "ramp.nrrd").string());
  EXPECT_FALSE(scene["scene"]["transfer"]["points"].empty());
  EXPECT_EQ(scene["can_undo"], false);
  const json frame = page.next("frame");
  EXPECT_EQ(frame["revision"], scene["revision"]);
}

TEST_F(Socket, OpeningTellsHowFarItIs) {
  std::uint32_t n = 1;  // noise, which takes several parts to be inflated
  const auto noise = [&](auto, auto, auto) { return (n = n * 1664525u + 1013904223u) >> 17; };
  write_volume(make_volume<std::int16_t>({110, 100, 100}, noise), files_ / "noise.nrrd");
  Page page(start());
  page.send({{"type", "open"}, {"path", "noise.nrrd"}});
  for (const std::string stage : {"reading", "preparing"}) {
    double before = 0;
    for (int i = 0; i < 4; ++i) {
      const json status = page.next("status", [](const json& m) { return m.contains("share"); });
      EXPECT_EQ(status["stage"], stage);
      EXPECT_EQ(status["what"], "noise.nrrd");
      EXPECT_GT(status["share"].get<double>(), before);
      before = status["share"].get<double>();
    }
    const auto done = [&](const json& m) { return m["stage"] == stage && m.value("share", 0.0) == 1; };
    EXPECT_GT(page.next("status", done)["share"].get<double>(), before);
  }
  EXPECT_EQ(page.next("status")["stage"], "ready");
}

TEST_F(Socket, CompilingTellsHowFarItIs) {
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

TEST_F(Socket, APictureIsAWholePng) {
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

TEST_F(Socket, MovingPicturesAreJpeg) {
  Page page(start_with_ramp());
  page.next("frame", [](const json& m) { return m["done"] == true; });
  for (int i = 0; i < 10; ++i) page.send(edit(i, "/camera/azimuth_deg", i));
  const json frame = page.next("frame", [](const json& m) { return m["moving"] == true; });
  EXPECT_EQ(frame["format"], "jpeg");
  EXPECT_EQ(page.last_picture().substr(0, 2), "\xFF\xD8");
}

TEST_F(Socket, AStillPictureIsDevelopedAgainWithoutMoving) {
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

TEST_F(Socket, EditsAreAnsweredInOrderAndSeen) {
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

TEST_F(Socket, WrongEditsAreRefusedWithTheirPlace) {
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

TEST_F(Socket, WhatIsNoMessageIsRefusedAndTheConnectionStays) {
  Page page(start_with_ramp());
  for (const std::string text : {"", "{", "[]", "5", R"({"type":"what"})", R"({"type":"probe","id":1})"}) {
    page.send_text(text);
    EXPECT_TRUE(page.next("refused")["seq"].is_null()) << text;
  }
  page.send_text(std::string(1 << 19, '['));
  page.next("refused");
  page.send(edit(1, "/camera/zoom", 2));
  EXPECT_EQ(page.next("edited")["seq"], 1);
}

TEST_F(Socket, BadTextBinaryAndTooMuchEndTheConnection) {
  const Address& at = start();
  {
    Page page(at);
    page.send_text("{\"type\":\"undo\",\"x\":\"\xFF\xFE\"}");
    EXPECT_EQ(page.read_to_close(), 1007);
  }
  {
    Page page(at);
    page.send_text("{}", true);
    EXPECT_EQ(page.read_to_close(), 1003);
  }
  {
    Page page(at);
    page.send_text(std::string((1 << 20) + 1, ' '));
    EXPECT_EQ(page.read_to_close(), 1009);
  }
  {
    Page page(at);
    for (int i = 0; i < 3000; ++i) page.send_text(R"({"type":"shown","frame":0})");
    EXPECT_EQ(page.read_to_close(), 1008);
  }
  EXPECT_EQ(Page(at).next()["type"], "hello");
}

TEST_F(Socket, EditsWhileNothingIsOpenAreRefused) {
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

TEST_F(Socket, TwoPagesSeeTheSame) {
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

TEST_F(Socket, GesturesOfTwoPagesAreStepsOfTheirOwn) {
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

TEST_F(Socket, WhoComesBackIsToldEverything) {
  const Address& at = start_with_ramp();
  {
    Page page(at);
    page.next("scene");
    page.send(edit(1, "/camera/zoom", 3));
    page.next("edited");
    page.send({{"type", "split"}, {"at", 0.5}});
    page.next("split");
    page.cut();
  }
  Page again(at);
  EXPECT_EQ(again.next("status")["stage"], "ready");
  const json scene = again.next("scene");
  EXPECT_EQ(scene["scene"]["camera"]["zoom"], 3);
  EXPECT_EQ(scene["can_undo"], true);
  EXPECT_EQ(again.next("split")["at"], 0.5);
  again.next("frame", [&](const json& m) { return m["revision"] == scene["revision"]; });
}

TEST_F(Socket, FiftyPagesSeeTheSameRevision) {
  const Address& at = start_with_ramp();
  std::vector<std::unique_ptr<Page>> pages;
  for (int i = 0; i < 50; ++i) pages.push_back(std::make_unique<Page>(at));
  for (int i = 1; i <= 20; ++i) pages[0]->send(edit(i, "/camera/azimuth_deg", i));
  const std::uint64_t revision =
      pages[0]->next("edited", [](const json& m) { return m.value("seq", 0) == 20; })["revision"];
  std::string picture;
  for (const auto& page : pages) {
    page->next("frame", [&](const json& m) { return m["revision"] == revision && m["done"] == true; });
    if (picture.empty()) picture = page->last_picture();
    EXPECT_EQ(page->last_picture(), picture);
  }
}

TEST_F(Socket, TooManyPagesAreTurnedAway) {
  const Address& at = start();
  std::vector<std::unique_ptr<Page>> pages;
  for (int i = 0; i < 64; ++i) {
    pages.push_back(std::make_unique<Page>(at));
    pages.back()->next("viewers");
  }
  EXPECT_THROW(Page another(at), std::runtime_error);
  pages.pop_back();
  pages.front()->next("viewers", [](const json& m) { return m["count"] == 63; });
  EXPECT_EQ(Page(at).next()["type"], "hello");
}

TEST_F(Socket, AtMostTwoPicturesAreUnanswered) {
  const Address& at = start_with_ramp();
  Page quiet(at, {.answers_frames = false}), busy(at);
  std::vector<std::uint64_t> seen;
  busy.next("frame");
  json last;
  for (int i = 1; i <= 20; ++i) {
    busy.send(edit(i, "/camera/azimuth_deg", i));
    const std::uint64_t revision = busy.next("edited")["revision"];
    last = busy.next(
        "frame", [&](const json& m) { return m["revision"] == revision && (i < 20 || m["done"] == true); });
  }
  // All that quiet was sent lies before the answer to this.
  quiet.send(edit(99, "/camera/zoom", "x"));
  for (json message = quiet.next(); message["type"] != "refused"; message = quiet.next())
    if (message["type"] == "frame") seen.push_back(message["frame"]);
  ASSERT_LE(seen.size(), 2u);
  // After an answer the newest comes, not the next.
  quiet.send({{"type", "shown"}, {"frame", seen.back()}});
  EXPECT_EQ(quiet.next("frame")["frame"], last["frame"]);
}

TEST_F(Socket, APageThatNeverReadsKeepsNobodyWaitingAndIsDropped) {
  const Address& at = start_with_ramp();
  auto deaf = std::make_unique<Page>(at, Page::Manners{.answers_frames = false});
  Page busy(at);
  busy.next("viewers", [](const json& m) { return m["count"] == 2; });
  // Answers that are large, and go to both.
  json points = json::array();
  for (int i = 0; i < 3000; ++i) points.push_back({{"value", i}, {"opacity", 0.5}});
  bool dropped = false;
  for (int i = 1; i <= 2000 && !dropped; ++i) {
    points[0]["opacity"] = i % 2 ? 0.25 : 0.75;
    busy.send(edit(i, "/transfer/points", points));
    for (json message = busy.next(); message["type"] != "edited"; message = busy.next())
      dropped = dropped || (message["type"] == "viewers" && message["count"] == 1);
  }
  EXPECT_TRUE(dropped);
  busy.send(edit(9999, "/camera/zoom", 2));
  const std::uint64_t revision =
      busy.next("edited", [](const json& m) { return m.value("seq", 0) == 9999; })["revision"];
  busy.next("frame", [&](const json& m) { return m["revision"] == revision; });
}

TEST_F(Socket, FailingOpensKeepWhatIsThere) {
  const Address& at = start_with_ramp();
  Page page(at);
  page.next("scene");
  write_bytes(files_ / "broken.nrrd", "NRRD0004\nnonsense");
  std::filesystem::create_symlink(folder_ / "secret.nrrd", files_ / "link.nrrd");
  write_bytes(files_ / "out.json", R"({"version":1,"volume":{"path":"../secret.nrrd"}})");
  write_bytes(files_ / "wrong.json", R"({"version":1,"what":2})");
  const auto failed = [](const json& m) { return m["stage"] == "failed"; };
  for (const std::string path : {"broken.nrrd", "link.nrrd", "../secret.nrrd", "/etc/passwd", "nothing",
                                 "out.json", "wrong.json", ""}) {
    page.send({{"type", "open"}, {"path", path}});
    const json status = page.next("status", failed);
    EXPECT_NE(status["message"], "") << path;
    EXPECT_THAT(status["message"].get<std::string>(), testing::Not(HasSubstr("\n"))) << path;
  }
  page.send(edit(1, "/camera/zoom", 2));
  EXPECT_EQ(page.next("edited")["seq"], 1);
  EXPECT_EQ(Page(at).next("status")["stage"], "ready");
}

TEST_F(Socket, PathsInEditsAndScenesStayInside) {
  Page page(start_with_ramp());
  const json scene = page.next("scene")["scene"];
  int seq = 0;
  for (const std::string path : {"/etc/passwd", "../secret.nrrd", "inside/../../secret.nrrd"}) {
    page.send(edit(++seq, "/environment/image", path));
    EXPECT_THAT(page.next("refused")["message"].get<std::string>(), HasSubstr("outside")) << path;
    page.send(edit(++seq, "/labels", {{"path", path}}));
    EXPECT_EQ(page.next("refused")["seq"], seq);
    page.send(edit(++seq, "/proxies", json::array({{{"name", "p"}, {"path", path}}})));
    EXPECT_EQ(page.next("refused")["seq"], seq);
    json other = scene;
    other["volume"]["path"] = path;
    page.send({{"type", "load"}, {"scene", other}});
    EXPECT_EQ(page.next("status", [](const json& m) { return m["stage"] == "failed"; })["stage"], "failed");
  }
}

TEST_F(Socket, FilesBesideLabelsStayInside) {
  namespace fs = std::filesystem;
  write_bytes(folder_ / "hidden.txt", "1 hidden\n");
  write_bytes(folder_ / "hidden.lut", std::string(768, '\1'));
  for (const char* name : {"a.nrrd", "b.nrrd"}) fs::copy(files_ / "labels.nrrd", files_ / "inside" / name);
  fs::create_symlink(folder_ / "hidden.txt", files_ / "inside/a.nrrd.txt");
  fs::create_symlink("../../hidden.lut", files_ / "inside/b.lut");
  Page page(start_with_ramp());
  json scene = page.next("scene")["scene"];
  int seq = 0;
  const auto refusal = [&](const char* member, const json& value) {
    page.send(edit(++seq, member, value));
    return page.next("refused")["message"].get<std::string>();
  };
  for (const std::string path : {"inside/a.nrrd", "inside/b.nrrd"}) {
    EXPECT_THAT(refusal("/labels", {{"path", path}}), HasSubstr("outside")) << path;
    const json proxies = json::array({{{"name", "p"}, {"path", path}, {"lookup", "nearest"}}});
    EXPECT_THAT(refusal("/proxies", proxies), HasSubstr("outside")) << path;
    json other = scene;
    other["labels"] = {{"path", path}};
    page.send({{"type", "load"}, {"scene", other}});
    EXPECT_THAT(page.next("status", [](const json& m) { return m["stage"] == "failed"; })["message"]
                    .get<std::string>(),
                HasSubstr("outside"));
    other["labels"]["path"] = path.substr(7);
    other["volume"]["path"] = "../ramp.nrrd";
    write_bytes(files_ / "inside/scene.json", other.dump());
    page.send({{"type", "open"}, {"path", "inside/scene.json"}});
    EXPECT_THAT(page.next("status", [](const json& m) { return m["stage"] == "failed"; })["message"]
                    .get<std::string>(),
                HasSubstr("outside"));
  }
  // Where other names are given, and by a link that stays inside, labels are as good as any.
  page.send(edit(++seq, "/labels", {{"path", "inside/a.nrrd"}, {"names", "labels.txt"}}));
  EXPECT_EQ(page.next("edited")["seq"], seq);
  EXPECT_EQ(json::parse(get(*address_, "/api/labels").body)["labels"][0]["name"], "left");
  fs::remove(files_ / "inside/b.lut");
  fs::create_symlink("../labels.txt", files_ / "inside/b.txt");
  page.send(edit(++seq, "/labels", {{"path", "inside/b.nrrd"}}));
  EXPECT_EQ(page.next("edited")["seq"], seq);
  EXPECT_EQ(json::parse(get(*address_, "/api/labels").body)["labels"][1]["name"], "right");
}

TEST_F(Socket, PathsOfTheCommandLineMayBeAnywhere) {
  server::ServerOptions elsewhere = options();
  elsewhere.folder = files_ / "inside";
  elsewhere.scene = ramp_scene();
  Page page(start(elsewhere));
  const json scene = page.next("scene")["scene"];
  page.send({{"type", "load"}, {"scene", scene}});
  page.next("scene");
  page.send(edit(1, "/labels", {{"path", (files_ / "labels.nrrd").string()}}));
  EXPECT_EQ(page.next("refused")["seq"], 1);
}

TEST_F(Socket, NumbersGoOnWhenAnotherVolumeIsOpened) {
  Page page(start_with_ramp());
  const json first = page.next("frame", [](const json& m) { return m["done"] == true; });
  page.send({{"type", "open"}, {"path", "labels.nrrd"}});
  const json scene = page.next("scene");
  EXPECT_GT(scene["revision"], first["revision"]);
  EXPECT_EQ(scene["scene"]["image"]["width"], 1024);  // no page has said its size
  const json second = page.next("frame", [&](const json& m) { return m["revision"] == scene["revision"]; });
  EXPECT_GT(second["frame"], first["frame"]);
  EXPECT_EQ(scene["can_undo"], false);
}

TEST_F(Socket, ThePagesSizeOutlivesOpening) {
  Page page(start_with_ramp());
  page.send(edit(1, {{"/image/width", 40}, {"/image/height", 30}}));
  page.next("edited");
  page.send({{"type", "open"}, {"path", "labels.nrrd"}});
  const json scene = page.next("scene", [](const json& m) { return m["can_undo"] == false; });
  EXPECT_EQ(scene["scene"]["image"]["width"], 40);
  EXPECT_EQ(scene["scene"]["image"]["height"], 30);
}

TEST_F(Socket, TheNewestOpenWins) {
  Page page(start());
  page.send({{"type", "open"}, {"path", "labels.nrrd"}});
  page.send({{"type", "open"}, {"path", "nothing.nrrd"}});
  page.send({{"type", "open"}, {"path", "ramp.nrrd"}});
  const json scene = page.next("scene");
  EXPECT_THAT(scene["scene"]["volume"]["path"].get<std::string>(), HasSubstr("ramp.nrrd"));
  EXPECT_EQ(json::parse(get(*address_, "/api/volume").body)["name"], "ramp.nrrd");
}

/// A volume that takes a while to be prepared, and no room on the disk.
void write_large(const std::filesystem::path& folder) {
  write_bytes(folder / "large.nhdr",
              "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4096 4096 1024\nencoding: raw\n"
              "spacings: 1 1 1\ndata file: large.raw\n");
  write_bytes(folder / "large.raw", "");
  std::filesystem::resize_file(folder / "large.raw", std::uintmax_t{1} << 34);
}

TEST_F(Socket, OpeningIsGivenUp) {
  write_large(files_);
  Page page(start());
  const auto begun = [](const json& m) { return m["stage"] == "preparing"; };
  page.send({{"type", "open"}, {"path", "large.nhdr"}});
  page.next("status", begun);
  page.send({{"type", "cancel_open"}});
  EXPECT_EQ(page.next("status", [](const json& m) { return !m.contains("share"); })["stage"], "empty");
  page.send({{"type", "open"}, {"path", "ramp.nrrd"}});
  const json scene = page.next("scene");
  EXPECT_THAT(scene["scene"]["volume"]["path"].get<std::string>(), HasSubstr("ramp.nrrd"));
  // Over an open volume, which stays and whose pictures go on.
  page.send({{"type", "open"}, {"path", "large.nhdr"}});
  page.next("status", begun);
  page.send({{"type", "cancel_open"}});
  const json status = page.next("status", [](const json& m) { return m["stage"] == "ready"; });
  EXPECT_EQ(status["what"], "ramp.nrrd");
  page.send(edit(1, "/camera/zoom", 2));
  const json edited = page.next("edited");
  page.next("frame", [&](const json& m) { return m["revision"] == edited["revision"]; });
  // Where nothing is being opened there is nothing to give up.
  page.send({{"type", "cancel_open"}});
  page.send({{"type", "split"}, {"at", 0.5}});
  EXPECT_EQ(page.next()["type"], "split");
}

TEST_F(Socket, WhatNobodyMayExpectOfASceneIsTold) {
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

TEST_F(Socket, SeekingShowsATimeAndChangesNothing) {
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

TEST_F(Socket, APageThatGoesEndsItsSeeking) {
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

TEST_F(Socket, WhatIsSetInPassingIsSeenAndNotKept) {
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

TEST_F(Socket, APageThatGoesTakesAlongWhatItSetInPassing) {
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

TEST_F(Socket, WhatDoesNotFitIsNotSetInPassing) {
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

TEST_F(Socket, ProbesFindPlaceValueAndLabel) {
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

TEST_F(Socket, LabelsOfTheLongestNameAreProbedToo) {
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

TEST_F(Socket, TroubleIsToldAndTheLastGoodPictureStays) {
  Page page(start_with_ramp());
  write_bytes(files_ / "broken.exr", "no picture");
  page.send(edit(1, "/environment/image", "broken.exr"));
  page.next("edited");
  EXPECT_NE(page.next("trouble")["message"], "");
  page.send({{"type", "undo"}});
  const json scene = page.next("scene", [](const json& m) { return m["can_redo"] == true; });
  page.next("frame", [&](const json& m) { return m["revision"] == scene["revision"]; });
}

TEST_F(Socket, StoppingSaysGoodbye) {
  Page page(start_with_ramp());
  page.next("frame");
  std::thread stopping([this] { stop(); });
  EXPECT_EQ(page.read_to_close(), 1001);
  stopping.join();
}

}  // namespace
}  // namespace voxlume::test
