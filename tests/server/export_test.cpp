#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <sstream>

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

/// The processes that render an animation for this one.
std::vector<std::filesystem::path> rendering_processes() {
  std::vector<std::filesystem::path> out;
  const auto read = [](const std::filesystem::path& path) {
    try {
      return read_bytes(path);
    } catch (const std::exception&) {
      return std::string();  // it has ended
    }
  };
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    const std::string number = entry.path().filename();
    if (number.find_first_not_of("0123456789") != std::string::npos) continue;
    const std::string command = read(entry.path() / "cmdline"), stat = read(entry.path() / "stat");
    const std::size_t name_end = stat.rfind(')');  // then the state, and the parent
    if (name_end == std::string::npos || !command.starts_with(VOXLUME_BINARY)) continue;
    if (stat.substr(name_end + 4).starts_with(std::to_string(::getpid()) + " ")) out.push_back(entry.path());
  }
  return out;
}

/// Of a process or thread: the 19th field of its stat.
int nice_value(const std::filesystem::path& process) {
  const std::string stat = read_bytes(process / "stat");
  std::istringstream fields(stat.substr(stat.rfind(')') + 1));
  std::string field;
  for (int i = 3; i <= 19; ++i) fields >> field;
  return std::stoi(field);
}

TEST_F(Export, HasTheLeastPriority) {
  const auto page = open(10000, 64);
  page->send({{"type", "export"}, {"file", "long.zip"}});
  page->next("export", [](const json& m) { return m["frames_done"] >= 1; });
  const auto processes = rendering_processes();
  ASSERT_EQ(processes.size(), 1u);
  EXPECT_EQ(nice_value(processes[0]), 19);
  int threads = 0;
  for (const auto& thread : std::filesystem::directory_iterator(processes[0] / "task")) {
    EXPECT_EQ(nice_value(thread.path()), 19);
    ++threads;
  }
  EXPECT_GE(threads, 1);
  EXPECT_EQ(nice_value("/proc/self"), ::getpriority(PRIO_PROCESS, 0));  // this one's is as it was
  page->send({{"type", "cancel_export"}});
  state(*page, "cancelled");
}

/// With an ffmpeg that never comes to an end, and tells its process.
class ExportOfAMovie : public Export {
 protected:
  void SetUp() override {
    Export::SetUp();
    std::filesystem::create_directories(folder_ / "bin");
    write_bytes(folder_ / "bin/ffmpeg", "#!/bin/sh\necho $$ > " + process_.string() + ".part\nmv " +
                                            process_.string() + ".part " + process_.string() +
                                            "\nexec sleep 1000\n");
    std::filesystem::permissions(folder_ / "bin/ffmpeg", std::filesystem::perms::owner_all);
    ::setenv("PATH", ((folder_ / "bin").string() + ":/usr/bin:/bin").c_str(), 1);
  }
  void TearDown() override {
    Export::TearDown();
    ::setenv("PATH", path_.c_str(), 1);
  }
  static bool comes_true(const std::function<bool()>& what) {
    // What exports has the least priority: on a busy machine it takes a while.
    for (int i = 0; i < 3000 && !what(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    return what();
  }
  /// Begins to encode.
  void encode(Page& page) {
    page.send({{"type", "export"}, {"file", "turn.mp4"}});
    ASSERT_TRUE(comes_true([&] { return std::filesystem::exists(process_); }));
  }
  bool ffmpeg_runs() const {
    const std::string number = read_bytes(process_);
    // What ended and was not waited for has no command line.
    return !read_bytes("/proc/" + number.substr(0, number.find('\n')) + "/cmdline").empty();
  }

  const std::filesystem::path process_ = folder_ / "process";
  const std::string path_ = std::getenv("PATH");
};

TEST_F(ExportOfAMovie, CanBeCancelledWhileItIsEncoded) {
  const auto page = open(3);
  encode(*page);
  EXPECT_TRUE(ffmpeg_runs());
  page->send({{"type", "cancel_export"}});
  EXPECT_EQ(state(*page, "cancelled")["file"], "turn.mp4");
  EXPECT_TRUE(comes_true([&] { return !ffmpeg_runs(); }));
}

TEST_F(ExportOfAMovie, EndsWithTheServer) {
  const auto page = open(3);
  encode(*page);
  stop();
  EXPECT_TRUE(comes_true([&] { return !ffmpeg_runs(); }));
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
