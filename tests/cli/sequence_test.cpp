#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

#include "cli_fixture.h"
#include "image_io/image_io.h"

namespace voxlume::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;

/// Everything that frames can change, at once.
constexpr const char* kAnimatedBall = R"({
  "version": 1, "volume": {"path": "ball.nrrd"},
  "transfer": {"points": [{"value": 0, "opacity": 0}, {"value": 900, "opacity": 0.6, "color": "#e0c0a0"}]},
  "lights": [{"kind": "rect", "position_mm": [0, -60, 30], "size_mm": [20, 20], "intensity": 9},
             {"kind": "point", "position_mm": [40, -40, 0], "intensity": 900}],
  "environment": {"intensity": 0.2},
  "image": {"width": 20, "height": 16, "spp": 4},
  "animation": {"fps": 4, "tracks": [
    {"field": "/camera/azimuth_deg", "keys": [[0, 0], [1, 90]]},
    {"field": "/lights/0/position_mm", "interpolation": "smooth", "keys": [[0, [0, -60, 30]], [1, [60, 0, 30]]]},
    {"field": "/lights/1/color", "keys": [[0, "#ff0000"], [1, "#0000ff"]]},
    {"field": "/transfer/points/1/opacity", "keys": [[0, 0.6], [0.5, 0.6], [1, 0.1]]},
    {"field": "/clip/x_mm/1", "keys": [[0, 20], [1, 1]]}]}})";

class CliSequence : public CliTest {
 protected:
  Image frame(const std::string& name) const { return read_image(folder_ / name); }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::directory_iterator(folder_)) out.push_back(entry.path().filename().string());
    std::sort(out.begin(), out.end());
    return out;
  }
  void expect_refused(const RunResult& r, const std::string& message) const {
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(line_count(r.err), 1) << r.err;
    EXPECT_THAT(r.err, HasSubstr(message));
  }
};

TEST_F(CliSequence, FramesOfATurntableAreTheStillsOfTheirScenes) {
  const std::vector<std::string> table{"--turntable", "1", "--fps", "4"};
  const RunResult r = render("phantom", "f-##.exr", table);
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err, "");
  EXPECT_THAT(names(), ElementsAre("ball.nrrd", "ball.raw", "f-00.exr", "f-01.exr", "f-02.exr", "f-03.exr"));
  const Image second = frame("f-01.exr");
  EXPECT_NE(second.rgba, frame("f-00.exr").rgba);
  EXPECT_NE(second.rgba, frame("f-03.exr").rgba);

  write("s.json", second.metadata.at("voxlume:scene"));
  ASSERT_EQ(run({"render", "s.json", "-o", "still.exr"}).code, 0);
  EXPECT_EQ(frame("still.exr").rgba, second.rgba);
  ASSERT_EQ(render("phantom", "one.exr", {"--turntable", "1", "--fps", "4", "--frames", "1"}).code, 0);
  EXPECT_EQ(frame("one.exr").rgba, second.rgba);
  EXPECT_EQ(frame("one.exr").metadata.at("voxlume:time_s"), "0.25");
}

TEST_F(CliSequence, FramesNameTheirCameraInTheVolumesSpace) {
  ASSERT_EQ(
      render("ball.nrrd", "f-#.exr",
             {"--turntable", "1", "--fps", "4", "--set", "/volume/origin_mm=2000,0,0", "--frames", "1:1"})
          .code,
      0);
  const Image image = frame("f-1.exr");
  EXPECT_EQ(image.metadata.at("voxlume:frame"), "1");
  EXPECT_EQ(image.metadata.at("voxlume:time_s"), "0.25");
  const json camera = json::parse(image.metadata.at("voxlume:camera"));
  EXPECT_NEAR(camera["target_mm"][0], 2007.5, 1e-3);
  EXPECT_NEAR(camera["eye_mm"][1], 7.5, 1e-3);  // azimuth 90: on the patient's left
  EXPECT_GT(camera["eye_mm"][0], 2030);
  EXPECT_NEAR(camera["forward"][0], -1, 1e-6);
  EXPECT_NEAR(camera["right"][1], 1, 1e-6);
  EXPECT_NEAR(camera["up"][2], 1, 1e-6);
  EXPECT_NEAR(camera["half_height"], std::tan(15 * 3.14159265358979 / 180), 1e-6);
  EXPECT_NEAR(camera["half_width"], 1.2 * camera["half_height"].get<double>(), 1e-6);
  EXPECT_EQ(camera["orthographic"], false);
  EXPECT_EQ(camera["width_px"], 24);
  EXPECT_EQ(camera["height_px"], 20);
}

TEST_F(CliSequence, EveryKindOfTrackGivesTheStillOfItsTime) {
  write("s.json", kAnimatedBall);
  ASSERT_EQ(run({"render", "s.json", "-o", "f##.exr", "--stats", "s.stats"}).code, 0);
  const json stats = json::parse(read("s.stats"));
  ASSERT_EQ(stats["frames"].size(), 5u);
  EXPECT_EQ(stats["frames"][4]["frame"], 4);
  EXPECT_EQ(stats["frames"][4]["paths"], 20 * 16 * 4);
  for (const char* k : {"0", "2", "4"}) {
    ASSERT_EQ(run({"render", "s.json", "-o", "still.exr", "--frames", k}).code, 0);
    EXPECT_EQ(frame("still.exr").rgba, frame(std::string("f0") + k + ".exr").rgba) << k;
  }
  EXPECT_NE(frame("f03.exr").rgba, frame("f04.exr").rgba);
}

TEST_F(CliSequence, APartCanBeRenderedAndTheRestLater) {
  write("s.json", kAnimatedBall);
  ASSERT_EQ(run({"render", "s.json", "-o", "f-#.png", "--frames", "1:2"}).code, 0);
  EXPECT_THAT(names(), ElementsAre("ball.nrrd", "ball.raw", "f-1.png", "f-2.png", "s.json"));
  const auto written = fs::last_write_time(folder_ / "f-1.png");
  expect_refused(run({"render", "s.json", "-o", "f-#.png"}), "\"f-1.png\" is there; --resume goes on");
  EXPECT_FALSE(exists("f-0.png"));
  ASSERT_EQ(run({"render", "s.json", "-o", "f-#.png", "--resume"}).code, 0);
  EXPECT_TRUE(exists("f-0.png") && exists("f-4.png"));
  EXPECT_EQ(fs::last_write_time(folder_ / "f-1.png"), written);
}

TEST_F(CliSequence, FramesOfAnotherSceneAreNotResumed) {
  write("s.json", kAnimatedBall);
  const auto other = [&](const char* pattern, const char* flag, const char* value) {
    expect_refused(run({"render", "s.json", "-o", pattern, "--resume", flag, value}),
                   "belongs to another scene or other settings");
  };
  ASSERT_EQ(run({"render", "s.json", "-o", "f-#.png", "--frames", ":1"}).code, 0);
  ASSERT_EQ(run({"render", "s.json", "-o", "f-#.exr", "--frames", ":0"}).code, 0);
  const std::string bytes = read("f-0.png");
  other("f-#.png", "--seed", "3");
  other("f-#.png", "--spp", "5");
  other("f-#.png", "--exposure", "1");
  other("f-#.exr", "--seed", "3");
  EXPECT_EQ(read("f-0.png"), bytes);
  EXPECT_FALSE(exists("f-2.png") || exists("f-1.exr"));
}

TEST_F(CliSequence, AnInterruptedSequenceResumesToTheSameFrames) {
  const std::vector<std::string> arguments{"render", "ball.nrrd", "-o",    "f-#.exr", "--turntable", "1",
                                           "--fps",  "4",         "--spp", "128",     "--size",      "48x48"};
  Process process(arguments, folder_);
  for (int i = 0; i < 3000 && !exists("f-0.exr"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  process.signal(SIGINT);
  const RunResult r = process.wait();
  ASSERT_EQ(r.code, 130) << r.err;
  EXPECT_THAT(r.err, HasSubstr("--resume goes on"));
  EXPECT_FALSE(exists("f-3.exr"));
  std::vector<std::string> resume = arguments, whole = arguments;
  resume.push_back("--resume");
  whole[3] = "w-#.exr";
  ASSERT_EQ(run(resume).code, 0);
  ASSERT_EQ(run(whole).code, 0);
  for (const char* k : {"0", "1", "2", "3"}) {
    EXPECT_EQ(frame(std::string("f-") + k + ".exr").rgba, frame(std::string("w-") + k + ".exr").rgba) << k;
  }
  for (const std::string& name : names()) EXPECT_EQ(name.find("checkpoint"), std::string::npos) << name;
}

TEST_F(CliSequence, RefusesWhatDoesNotGoTogether) {
  write("s.json", kAnimatedBall);
  const auto refused = [&](const std::vector<std::string>& more, const std::string& message) {
    std::vector<std::string> arguments{"render"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    expect_refused(run(arguments), message);
  };
  refused({"ball.nrrd", "-o", "f-##.png"},
          "and nothing moves; expected --turntable or a scene with an animation");
  refused({"s.json", "-o", "f.png"}, "\"f.png\" is one picture and the scene has 5 frames");
  refused({"s.json", "-o", "f-#-#.png"}, "expected one run of #");
  refused({"s.json", "-o", "f-#.png", "--frames", "3:9"}, "expected frames from 0 to 4");
  refused({"s.json", "-o", "f-#.png", "--frames", "a:b"}, "--frames: found \"a:b\", expected A:B");
  refused({"ball.nrrd", "-o", "f.png", "--frames", "1"}, "--frames: nothing moves");
  refused({"s.json", "-o", "f-#.png", "--aov", "depth"}, "a PNG holds no layers");
  refused({"s.json", "-o", "f-#.png", "--fps", "0"}, "--fps: found 0");
  refused({"s.json", "-o", "f-#.png", "--turntable", "x"}, "--turntable: found \"x\", expected a number");
  // Only the last frame is impossible: nothing is rendered.
  refused({"s.json", "-o", "f-#.png", "--set", "/clip/x_mm/0=2"}, "expected lower < upper (frame 4)");
  EXPECT_THAT(names(), ElementsAre("ball.nrrd", "ball.raw", "s.json"));
}

TEST_F(CliSequence, WhatTheVolumeBringsToLightNamesItsFrame) {
  write("s.json", R"({"version": 1, "volume": {"path": "ball.nrrd"},
    "transfer": {"rules": [{"kind": "mpctf", "points": [{"value": 0, "material": "gold"}]}],
                 "points": [{"value": 0, "opacity": 0}, {"value": 900, "opacity": 1}]},
    "image": {"width": 8, "height": 8, "spp": 1},
    "animation": {"fps": 1, "frames": 3, "tracks": [
      {"field": "/transfer/rules/0/points/0/material", "keys": [[0, "gold"], [2, "golf"]]}]}})");
  const RunResult r = run({"render", "s.json", "-o", "f-#.png"});
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(line_count(r.err), 1) << r.err;
  EXPECT_THAT(r.err, HasSubstr("/transfer/rules/0/points/0/material"));
  EXPECT_THAT(r.err, HasSubstr("(frame 2)"));
}

/// Movies, with a PATH of the test's own.
class CliMovie : public CliSequence {
 protected:
  void SetUp() override {
    CliSequence::SetUp();
    fs::create_directory(folder_ / "bin");
    if (const char* path = std::getenv("PATH")) path_ = path;
    write("s.json", kAnimatedBall);
  }
  void TearDown() override {
    ::setenv("PATH", path_.c_str(), 1);
    CliSequence::TearDown();
  }
  /// Makes this shell script the only ffmpeg there is.
  void install_ffmpeg(const std::string& script) {
    write("bin/ffmpeg", "#!/bin/sh\n" + script);
    fs::permissions(folder_ / "bin/ffmpeg", fs::perms::owner_all);
    ::setenv("PATH", (folder_ / "bin").c_str(), 1);
  }
  /// Notes its arguments, one a line, and the frames it sees, and writes a movie.
  void install_good_ffmpeg() {
    install_ffmpeg("for word; do echo \"$word\"; done > " + (folder_ / "arguments").string() + "\necho * > " +
                   (folder_ / "frames").string() + "\necho movie > \"$word\"\n");
  }
  std::string path_;
};

TEST_F(CliMovie, GoesThroughFfmpeg) {
  install_good_ffmpeg();
  const RunResult r = run({"render", "s.json", "-o", "m.mp4", "--frames", "1:3"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(read("m.mp4"), "movie\n");
  EXPECT_EQ(read("frames"), "000001.png 000002.png 000003.png\n");
  EXPECT_FALSE(exists("m.mp4.frames"));
  const std::string arguments = read("arguments");
  EXPECT_THAT(arguments, HasSubstr("-framerate\n4\n-start_number\n1\n-i\n%06d.png\n-frames:v\n3\n"));
  EXPECT_THAT(arguments, HasSubstr("libx264"));
  ASSERT_EQ(run({"render", "s.json", "-o", "m.WebM"}).code, 0);
  EXPECT_THAT(read("arguments"), HasSubstr("libvpx-vp9"));
}

TEST_F(CliMovie, KeepsItsFramesWhereFfmpegFailsAndResumes) {
  install_ffmpeg("echo 'no such encoder' >&2\nexit 1\n");
  const RunResult r = run({"render", "s.json", "-o", "m.mp4"});
  EXPECT_EQ(r.code, 1);
  EXPECT_EQ(line_count(r.err), 1) << r.err;
  EXPECT_THAT(r.err, HasSubstr("m.mp4: ffmpeg could not write it: no such encoder"));
  EXPECT_FALSE(exists("m.mp4"));
  const auto written = fs::last_write_time(folder_ / "m.mp4.frames/000004.png");
  install_good_ffmpeg();
  expect_refused(run({"render", "s.json", "-o", "m.mp4"}), "000000.png\" is there; --resume goes on");
  EXPECT_EQ(fs::last_write_time(folder_ / "m.mp4.frames/000004.png"), written);
  ASSERT_EQ(run({"render", "s.json", "-o", "m.mp4", "--resume"}).code, 0);
  EXPECT_EQ(read("m.mp4"), "movie\n");
  EXPECT_FALSE(exists("m.mp4.frames"));
}

TEST_F(CliMovie, RefusesBeforeItRenders) {
  install_good_ffmpeg();
  expect_refused(run({"render", "ball.nrrd", "-o", "m.mp4"}), "nothing moves");
  expect_refused(run({"render", "s.json", "-o", "m.mp4", "--set", "/clip/x_mm/0=2"}), "(frame 4)");
  expect_refused(run({"render", "s.json", "-o", "m.mp4", "--background", "transparent"}),
                 "a movie has no transparency");
  expect_refused(run({"render", "s.json", "-o", "m.mp4", "--aov", "depth"}), "a movie holds no layers");
  fs::remove(folder_ / "bin/ffmpeg");
  expect_refused(run({"render", "s.json", "-o", "m.mp4"}),
                 "movies are written by ffmpeg, which is not installed (Debian, Ubuntu: apt install ffmpeg)");
  EXPECT_THAT(names(), ElementsAre("ball.nrrd", "ball.raw", "bin", "s.json"));
}

TEST_F(CliMovie, RealFfmpegMakesAMovie) {
  if (std::system("ffmpeg -version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no ffmpeg here";
  for (const char* name : {"m.mp4", "m.webm"}) {
    const RunResult r = run({"render", "s.json", "-o", name, "--size", "33x31"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_THAT(read(name).substr(0, 64), HasSubstr(std::string(name) == "m.mp4" ? "ftyp" : "webm"));
  }
}

}  // namespace
}  // namespace voxlume::test
