#include "server_fixture.h"

namespace voxlume::test {
namespace {

using testing::HasSubstr;

using Opening = ServerTest;

TEST_F(Opening, SampleScenesAreOfferedAndOpenDenoised) {
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

TEST_F(Opening, OpeningTellsItsStagesThenTheSceneThenPictures) {
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

TEST_F(Opening, OpeningTellsHowFarItIs) {
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

TEST_F(Opening, FailingOpensKeepWhatIsThere) {
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

TEST_F(Opening, PathsInEditsAndScenesStayInside) {
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

TEST_F(Opening, FilesBesideLabelsStayInside) {
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

TEST_F(Opening, PathsOfTheCommandLineMayBeAnywhere) {
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

TEST_F(Opening, NumbersGoOnWhenAnotherVolumeIsOpened) {
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

TEST_F(Opening, ThePagesSizeOutlivesOpening) {
  Page page(start_with_ramp());
  page.send(edit(1, {{"/image/width", 40}, {"/image/height", 30}}));
  page.next("edited");
  page.send({{"type", "open"}, {"path", "labels.nrrd"}});
  const json scene = page.next("scene", [](const json& m) { return m["can_undo"] == false; });
  EXPECT_EQ(scene["scene"]["image"]["width"], 40);
  EXPECT_EQ(scene["scene"]["image"]["height"], 30);
}

TEST_F(Opening, TheNewestOpenWins) {
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

TEST_F(Opening, OpeningIsGivenUp) {
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
  EXPECT_EQ(status["given_up"], true);
  page.send(edit(1, "/camera/zoom", 2));
  const json edited = page.next("edited");
  page.next("frame", [&](const json& m) { return m["revision"] == edited["revision"]; });
  // Where nothing is being opened there is nothing to give up.
  page.send({{"type", "cancel_open"}});
  page.send({{"type", "split"}, {"at", 0.5}});
  json answer = page.next();
  while (answer["type"] == "frame" || answer["type"] == "progress") answer = page.next();
  EXPECT_EQ(answer["type"], "split");
}

}  // namespace
}  // namespace voxlume::test
