#include <algorithm>

#include "server_fixture.h"

namespace voxlume::test {
namespace {

using testing::HasSubstr;

class Export : public ServerTest {
 protected:
  /// A page with a scene that turns in `frames` frames.
  std::unique_ptr<Page> open(int frames, int spp = 1) {
    server::ServerOptions turning = options();
    turning.scene = ramp_scene();
    turning.scene->animation.emplace();
    turning.scene->animation->frames = frames;
    turning.scene->animation->turntable.emplace();
    turning.scene->image.spp = spp;
    auto page = std::make_unique<Page>(start(turning));
    page->next("scene");
    return page;
  }
  static json state(Page& page, const std::string& state) {
    return page.next("export", [&](const json& m) { return m["state"] == state; });
  }
};

TEST_F(Export, PicturesComeAsAZip) {
  const auto page = open(3);
  page->send({{"type", "export"}, {"file", "turn.zip"}});
  EXPECT_EQ(state(*page, "running")["frames"], 3);
  const json done = page->next("export", [](const json& m) { return m["state"] != "running"; });
  ASSERT_EQ(done["state"], "done") << done;
  EXPECT_EQ(done["frames_done"], 3);
  const Answer zip = get(*address_, "/api/export/turn.zip");
  ASSERT_EQ(zip.status, 200);
  EXPECT_EQ(zip.header("Content-Disposition"), "attachment; filename=\"turn.zip\"");
  EXPECT_EQ(zip.body.substr(0, 4), "PK\3\4");
  for (const char* name : {"turn-0000.png", "turn-0001.png", "turn-0002.png"})
    EXPECT_THAT(zip.body, HasSubstr(name));
  EXPECT_EQ(get(*address_, "/api/export/other.zip").status, 404);
  EXPECT_EQ(get(*address_, "/api/export/../scene.json").status, 404);
  Page later(*address_);
  EXPECT_EQ(state(later, "done")["file"], "turn.zip");
}

TEST_F(Export, CanBeCancelled) {
  const auto page = open(10000, 64);
  page->send({{"type", "export"}, {"file", "long.zip"}});
  state(*page, "running");
  page->send({{"type", "export"}, {"file", "second.zip"}});
  EXPECT_THAT(state(*page, "failed")["message"].get<std::string>(), HasSubstr("long.zip"));
  page->send({{"type", "cancel_export"}});
  EXPECT_EQ(state(*page, "cancelled")["file"], "long.zip");
  EXPECT_EQ(get(*address_, "/api/export/long.zip").status, 404);
  page->send({{"type", "cancel_export"}});  // nothing is under way: nothing happens
  page->send(edit(1, "/camera/zoom", 2));
  EXPECT_EQ(page->next("edited")["seq"], 1);
}

TEST_F(Export, OfWhatCannotBeIsRefused) {
  const auto page = open(3);
  for (const char* file : {"", "a.gif", "../a.zip", "a/b.zip", ".zip", "a"}) {
    page->send({{"type", "export"}, {"file", file}});
    EXPECT_NE(state(*page, "failed")["message"], "") << file;
  }
  page->send(edit(1, "/animation", nullptr));
  page->next("edited");
  page->send({{"type", "export"}, {"file", "a.zip"}});
  EXPECT_THAT(state(*page, "failed")["message"].get<std::string>(), HasSubstr("stands still"));
}

TEST_F(Export, FailureSaysWhy) {
  const auto page = open(3);
  std::filesystem::remove(files_ / "ramp.nrrd");
  page->send({{"type", "export"}, {"file", "a.zip"}});
  EXPECT_THAT(state(*page, "failed")["message"].get<std::string>(), HasSubstr("ramp.nrrd"));
}

}  // namespace
}  // namespace voxlume::test
