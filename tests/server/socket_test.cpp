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

TEST_F(Socket, StoppingSaysGoodbye) {
  Page page(start_with_ramp());
  page.next("frame");
  std::thread stopping([this] { stop(); });
  EXPECT_EQ(page.read_to_close(), 1001);
  stopping.join();
}

}  // namespace
}  // namespace voxlume::test
