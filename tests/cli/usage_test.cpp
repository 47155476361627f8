#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "cli_fixture.h"

namespace voxlume::test {
namespace {

using testing::HasSubstr;
using Arguments = std::vector<std::string>;

TEST_F(CliTest, HelpAndVersion) {
  for (const Arguments& arguments :
       {Arguments{"--help"}, Arguments{"render", "--help"}, Arguments{"info", "-h"},
        Arguments{"convert", "--help"}, Arguments{"compare", "--help"}}) {
    const RunResult r = run(arguments);
    EXPECT_EQ(r.code, 0);
    EXPECT_THAT(r.out, HasSubstr("Example"));
    EXPECT_EQ(r.err, "");
  }
  EXPECT_THAT(run({"--version"}).out, testing::MatchesRegex("voxlume [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST_F(CliTest, SchemaAndPresets) {
  EXPECT_THAT(run({"schema"}).out, HasSubstr("json-schema.org/draft/2020-12"));
  EXPECT_THAT(run({"schema", "--markdown"}).out, testing::StartsWith("# The scene file"));
  EXPECT_THAT(run({"presets"}).out, HasSubstr("ct-bone"));
  EXPECT_THAT(run({"materials"}).out, HasSubstr("frosted-glass"));
}

/// `arguments` end in exit code 2 with one line on stderr that has `message` in it, and leave no files.
struct Refusal {
  Arguments arguments;
  const char* message;
};

class CliRefuses : public CliTest {
 protected:
  void expect_refused(const std::vector<Refusal>& refusals) const {
    const auto files = [&] {
      return std::distance(std::filesystem::directory_iterator(folder_),
                           std::filesystem::directory_iterator());
    };
    const auto before = files();
    // Most of a run's time is the loading of shared libraries: two at a time.
    std::vector<RunResult> results(refusals.size());
    std::atomic<std::size_t> next{0};
    const auto work = [&] {
      for (std::size_t i; (i = next++) < refusals.size();) results[i] = run(refusals[i].arguments);
    };
    std::thread other(work);
    work();
    other.join();
    EXPECT_EQ(files(), before);
    for (std::size_t i = 0; i < refusals.size(); ++i) {
      const Refusal& refusal = refusals[i];
      const RunResult& r = results[i];
      const std::string command = testing::PrintToString(refusal.arguments);
      EXPECT_EQ(r.code, 2) << command << r.err;
      EXPECT_EQ(r.out, "") << command;
      EXPECT_EQ(line_count(r.err), 1) << command << r.err;
      EXPECT_THAT(r.err, testing::StartsWith("error: "));
      EXPECT_THAT(r.err, HasSubstr(refusal.message)) << command;
    }
  }
  /// render ball.nrrd -o o.png and `more`.
  static Refusal flags(const Arguments& more, const char* message) {
    Arguments arguments{"render", "ball.nrrd", "-o", "o.png"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return {arguments, message};
  }
};

TEST_F(CliRefuses, Usage) {
  expect_refused({
      {{}, "no command; expected one of render, view, info"},
      {{"rendr", "x"}, "unknown command \"rendr\"; did you mean render?"},
      {{"--verzion"}, "unknown argument \"--verzion\"; did you mean --version?"},
      {{"render"}, "INPUT is required"},
      {{"render", "ball.nrrd"}, "-o: missing; expected a picture to write"},
      {{"render", "ball.nrrd", "-o"}, "--output: its value is missing"},
      {{"render", "ball.nrrd", "-o", "o.png", "--sed", "1"},
       "unknown argument \"--sed\"; did you mean --seed?"},
      {{"render", "ball.nrrd", "-o", "o.png", "--zzzzz=1"},
       "unknown argument \"--zzzzz\"; see voxlume render --help"},
      {{"render", "ball.nrrd", "extra", "-o", "o.png"}, "unknown argument \"extra\""},
      {{"render", "ball.nrrd", "-o", "o.png", "--spp", "1", "--spp", "2"}, "--spp: given more than once"},
      {{"render", "ball.nrrd", "-o", "o.png", "--spp"}, "--spp: its value is missing"},
      {{"info"}, "INPUT is required"},
      {{"convert", "ball.nrrd"}, "OUTPUT is required"},
      {{"compare", "a.png"}, "B is required"},
      {{"schema", "--xml"}, "unknown argument \"--xml\""},
  });
}

TEST_F(CliRefuses, Values) {
  expect_refused({
      flags({"--simd", "mmx"}, "--simd: found \"mmx\", expected one of auto, scalar, sse4"),
      flags({"--accel", "tree"}, "--accel: found \"tree\", expected one of auto, none, macrocell, octree"),
      flags({"--spp", "0"}, "--spp: found 0, expected a whole number in [1, "),
      flags({"--spp", "-5"}, "--spp: found -5"),
      flags({"--spp", "many"}, "--spp: found \"many\""),
      flags({"--spp", "1.5"}, "--spp: found 1.5"),
      flags({"--seconds", "0"}, "--seconds: found 0"),
      flags({"--seconds", "nan"}, "--seconds: found nan"),
      flags({"--noise", "-1"}, "--noise: found -1"),
      flags({"--seed", "-1"}, "--seed: found -1"),
      flags({"--seed", "18446744073709551616"}, "--seed: found 1.8"),
      flags({"--threads", "0"}, "--threads"),
      flags({"--size", "640"}, "--size: found \"640\", expected WxH"),
      flags({"--size", "0x10"}, "--size: found 0"),
      flags({"--size", "10x70000"}, "--size: found 70000"),
      flags({"--camera", "30"}, "--camera: found \"30\", expected azimuth,elevation[,zoom]"),
      flags({"--camera", "30,100"}, "--camera: found 100, expected a number in [-90, 90]"),
      flags({"--camera", "30,10,0"}, "--camera: found 0, expected a number in [1e-06, "),
      flags({"--shading", "phong"},
            "--shading: found \"phong\", expected one of coexistence, er, phase, brdf"),
      flags({"--projection", "fisheye"}, "--projection: found \"fisheye\""),
      flags({"--fov", "180"}, "--fov: found 180"),
      flags({"--background", "blue"}, "--background: found \"blue\", expected env, transparent"),
      flags({"--background", "1,2,3"}, "--background: found 2, expected a color"),
      flags({"--clip", "0:1,0:1"}, "--clip: found \"0:1,0:1\", expected x0:x1,y0:y1,z0:z1"),
      flags({"--clip", "1:0,:,:"}, "expected the lower end first"),
      flags({"--clip", "100:200,:,:"}, "the clip box keeps nothing"),
      {{"render", "ball.nrrd", "-o", "o.exr", "--aov", "depht"}, "found \"depht\", expected one of alpha"},
      flags({"--aov", "depth"}, "--aov: a PNG holds no layers"),
      flags({"--exposure", "inf"}, "--exposure: found inf"),
      flags({"--tone-curve", "log"}, "--tone-curve: found \"log\", expected one of filmic, srgb"),
      flags({"--max-scatter", "-1"}, "--max-scatter: found -1"),
      flags({"--light-sampling", "both"}, "--light-sampling: found \"both\", expected one of mis"),
      flags({"--reference-length", "0"}, "--reference-length: found 0"),
      flags({"--spacing", "1,1"}, "--spacing: found a list of 2, expected a list of 3 numbers"),
      flags({"--spacing", "1,1,0"}, "found 0, expected a number in (0, "),
      flags({"--raw", "16x16,i16,1,1,1"}, "--raw: raw size"),
      flags({"--preset", "ct-bonr"}, "ct-bone"),
      flags({"--env", "none.exr"}, "none.exr"),
      flags({"--labels", "none.nrrd"}, "none.nrrd"),
      flags({"--important", "300"}, "--important: found \"300\", expected LOWER:UPPER"),
      flags({"--important", "300:200"}, "expected the lower end first"),
      flags({"--important", "a:b"}, "--important: found \"a\", expected a number"),
      flags({"--important", "label:7"}, "--important: found \"7\", expected label:FILE=A,B,..."),
      flags({"--important", "label:none.nrrd=7"}, "none.nrrd"),
      flags({"--visibility", "1,70,30"}, "--visibility: found \"1,70,30\", expected p,q,r,lambda"),
      flags({"--visibility", "0,70,30,1"}, "--visibility: found 0"),
      flags({"--visibility-lights", "last"}, "--visibility-lights: found \"last\", expected one of off"),
      flags({"--set", "/image/spp"}, "--set: found \"/image/spp\", expected ADDRESS=VALUE"),
      flags({"--set", "/image/ssp=3"}, "--set /image/ssp: unknown field \"ssp\"; did you mean \"spp\"?"),
      flags({"--set", "/lights=[{\"kind\":\"point\"}]"}, "/lights/0: missing key \"position_mm\""),
  });
}

TEST_F(CliRefuses, WhatIsNotBuiltYetByName) {
  expect_refused({
      flags({"--denoise", "blur"}, "found \"blur\", expected one of none, decoupled, svgf"),
  });
  EXPECT_EQ(render("ball.nrrd", "o.png", {"--visibility-lights", "off", "--denoise", "none"}).code, 0);
}

TEST_F(CliRefuses, WaysToCompare) {
  expect_refused({
      {{"compare", "a.png", "b.png", "--metric", "flop"},
       "--metric: found \"flop\", expected some of rmse, psnr, psnr_hdr, ssim, flip, flip_hdr"},
      {{"compare", "a.png", "b.png", "--error-map", "e.png", "--error-map-kind", "ratio"},
       "--error-map-kind: found \"ratio\", expected one of difference, flip, flip_hdr"},
      {{"compare", "a.png", "b.png", "--error-map-kind", "flip"}, "--error-map-kind requires --error-map"},
  });
}

TEST_F(CliRefuses, Outputs) {
  write("halfway.png.checkpoint", "of an interrupted render");
  std::filesystem::create_directory(folder_ / "sub.png");
  expect_refused({
      {{"render", "none.nrrd", "-o", "o.jpg"}, "-o: found \"o.jpg\", expected a name ending in .png or .exr"},
      {{"render", "none.nrrd", "-o", "o"}, "expected a name ending in .png or .exr"},
      {{"render", "none.nrrd", "-o", "no/such/o.png"}, "the folder \"no/such\" does not exist"},
      {{"render", "none.nrrd", "-o", "sub.png"}, "it is a folder"},
      flags({"--stats", "no/s.json"}, "--stats: cannot write \"no/s.json\""),
      flags({"--save-scene", "no/s.json"}, "--save-scene: cannot write"),
      flags({"--stats", "./o.png"}, "has the name of the picture"),
      flags({"--save-scene", "o.png.checkpoint"}, "has the name of the picture or its checkpoint"),
      flags({"--stats", "s.json", "--save-scene", "s.json"}, "has the name of --save-scene"),
      flags({"--stats", "ball.nrrd"}, "is an input of this command"),
      flags({"--save-scene", "./ball.nrrd"}, "is an input of this command"),
      {{"render", "ball.nrrd", "-o", "halfway.png"}, "--resume goes on from it"},
      {{"convert", "ball.nrrd", "ball.nrrd"}, "is an input of this command"},
      {{"convert", "ball.nrrd", "no/ball.mha"}, "the folder \"no\" does not exist"},
      {{"render", "ball.nrrd", "--save-scene", "s.json", "--resume"}, "--resume: needs -o"},
      {{"convert", "ball.nrrd", "ball.xyz"}, "ball.xyz"},
      {{"compare", "ball.nrrd", "ball.nrrd", "--error-map", "e.exr"},
       "--error-map: expected a name ending in .png"},
  });
}

TEST_F(CliRefuses, Inputs) {
  write("empty.nrrd", "");
  write("text.nrrd", "hello\n");
  write("short.nrrd", read("ball.nrrd").substr(0, 1000));
  write("bad.json", "{\"version\": 1,\n \"image\": {\"spp\": }}");
  write("old.json", "{}");
  write("new.json", "{\"version\": 99}");
  write("none.json", "{\"version\": 1}");
  write("missing.json", "{\"version\": 1, \"volume\": {\"path\": \"gone.nrrd\"}}");
  write("preset.json", R"({"version": 1, "volume": {"path": "ball.nrrd"}, "transfer": {"preset": "none"}})");
  write("slip.json", "{\"version\": 1, \"transfer\": {\"points\": [{\"value\": 1, \"opacty\": 1}]}}");
  std::filesystem::create_directory(folder_ / "folder");
  const auto input = [](const char* name, const char* message) {
    return Refusal{{"render", name, "-o", "o.png"}, message};
  };
  expect_refused({
      input("gone.nrrd", "gone.nrrd"),
      input("gone.json", "gone.json"),
      input("folder", "folder"),
      input("empty.nrrd", "empty.nrrd"),
      input("text.nrrd", "text.nrrd"),
      input("short.nrrd", "short.nrrd"),
      input("ball.raw", "ball.raw"),
      input("bad.json", "bad.json: line 2, column 19"),
      input("old.json", "old.json: /: missing key \"version\""),
      input("new.json", "new.json: /version: found version 99, expected at most 1"),
      input("none.json", "none.json: /volume: missing key \"path\""),
      input("missing.json", "gone.nrrd"),
      input("preset.json", "preset.json: /transfer/preset: "),
      input("slip.json", "slip.json: /transfer/points/0: unknown key \"opacty\"; did you mean \"opacity\"?"),
      {{"render", "ball.raw", "--raw", "99x16x16,i16,1,1,1", "-o", "o.png"}, "ball.raw"},
      {{"render", "new\nline.nrrd", "-o", "o.png"}, "new"},
      {{"info", "gone.nrrd"}, "gone.nrrd"},
      {{"convert", "gone.nrrd", "o.nrrd"}, "gone.nrrd"},
      {{"compare", "gone.png", "gone.png"}, "gone.png"},
      {{"compare", "ball.nrrd", "ball.nrrd"}, "ball.nrrd"},
  });
}

}  // namespace
}  // namespace voxlume::test
