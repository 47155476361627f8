#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "cli_fixture.h"
#include "denoise/denoiser.h"
#include "image_io/image_io.h"
#include "image_io/picture_text.h"
#include "render/file_denoiser.h"

namespace voxlume::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class CliDenoiseFiles : public CliTest {
 protected:
  /// Frames 0 to 2 of a volume seen from three sides near each other.
  void render_frames(const std::string& pattern, const std::string& volume) {
    const std::vector<std::string> arguments{"render",   volume, "-o",          pattern,  "--size", "48x32",
                                             "--spp",    "4",    "--turntable", "12",     "--fps",  "8",
                                             "--frames", "0:2",  "--aov",       "denoise"};
    const RunResult r = run(arguments);
    ASSERT_EQ(r.code, 0) << r.err;
  }
  RunResult denoise(const std::string& in, const std::string& out,
                    const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"denoise", in, "-o", out};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
  Image picture(const std::string& name) const { return read_image(folder_ / name); }
  void expect_refused(const RunResult& r, const std::string& message) const {
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(line_count(r.err), 1) << r.err;
    EXPECT_THAT(r.err, HasSubstr(message));
  }
};

TEST_F(CliDenoiseFiles, EveryMethodDoesWhatTheLibraryDoes) {
  render_frames("f-#.exr", "phantom");
  for (const DenoiserKind& kind : denoiser_kinds()) {
    if (kind.name == "oidn") continue;  // where it is installed is not known
    const std::string name(kind.name);
    SCOPED_TRACE(name);
    const RunResult r = denoise("f-#.exr", name + "-##.exr", {"--method", name});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(line_count(r.err), name == "asvgf" ? 1 : 0) << r.err;
    if (name == "asvgf") {
      EXPECT_THAT(r.err, HasSubstr("warning: pictures hold no gradient samples"));
    }
    FileDenoiser library(kind);
    for (const char* k : {"0", "1", "2"}) {
      const Image in = picture(std::string("f-") + k + ".exr");
      const Image out = picture(name + "-0" + k + ".exr");
      EXPECT_EQ(out.rgba, library.denoise(in, "").rgba);
      EXPECT_NE(out.rgba, in.rgba);
      EXPECT_TRUE(std::all_of(out.rgba.begin(), out.rgba.end(), [](float v) { return std::isfinite(v); }));
      EXPECT_TRUE(out.layers.empty());
      EXPECT_EQ(out.metadata.at("voxlume:denoiser"), name);
      EXPECT_EQ(out.metadata.at("voxlume:frame"), k);
      EXPECT_EQ(out.metadata.at("voxlume:scene"), in.metadata.at("voxlume:scene"));
    }
    ASSERT_EQ(denoise("f-1.exr", "alone.exr", {"--method", name, "--overwrite"}).code, 0);
    EXPECT_EQ(picture("alone.exr").rgba != picture(name + "-01.exr").rgba, kind.remembers);
  }
}

TEST_F(CliDenoiseFiles, LayersDoNotChangeThePicture) {
  const std::vector<std::string> frame{"--turntable", "1", "--frames", "1"};
  ASSERT_EQ(render("ball.nrrd", "plain.exr", frame).code, 0);
  std::vector<std::string> with = frame;
  with.insert(with.end(), {"--aov", "denoise,depth,alpha"});
  ASSERT_EQ(render("ball.nrrd", "layers.exr", with).code, 0);
  const Image plain = picture("plain.exr"), layers = picture("layers.exr");
  EXPECT_EQ(plain.rgba, layers.rgba);
  EXPECT_EQ(layers.layers.size(), 21u);
  EXPECT_FALSE(plain.metadata.contains("voxlume:size_mm"));
  const ImageLayer &matter = *layers.layer("matter"), &background = *layers.layer("background");
  const auto value = [](const ImageLayer& layer, std::size_t pixel, const char* channel) {
    const auto at = std::find(layer.channels.begin(), layer.channels.end(), channel) - layer.channels.begin();
    return layer.values[pixel * layer.channels.size() + static_cast<std::size_t>(at)];
  };
  for (std::size_t i = 0; i < layers.pixel_count(); ++i) {
    const float alpha = value(matter, i, "A");
    EXPECT_EQ(alpha, layers.layer("alpha")->values[i]);
    EXPECT_NEAR(value(matter, i, "G") + (1 - alpha) * value(background, i, "G"), layers.rgba[4 * i + 1],
                1e-5f);
    const float scattered = layers.layer("class0.count")->values[i] + layers.layer("class1.count")->values[i];
    EXPECT_EQ(scattered, alpha * 4);
  }
}

TEST_F(CliDenoiseFiles, APictureIsDevelopedAsItsSceneSays) {
  ASSERT_EQ(render("ball.nrrd", "f.exr", {"--aov", "denoise"}).code, 0);
  ASSERT_EQ(render("ball.nrrd", "g.exr", {"--aov", "denoise", "--exposure", "2"}).code, 0);
  for (const char* name : {"f", "g"}) {
    const std::string n(name);
    ASSERT_EQ(denoise(n + ".exr", n + ".png").code, 0);
    ASSERT_EQ(denoise(n + ".exr", n + "-clean.exr").code, 0);
  }
  EXPECT_EQ(picture("f-clean.exr").rgba, picture("g-clean.exr").rgba);
  const Image f = picture("f.png"), g = picture("g.png");
  double f_sum = 0, g_sum = 0;
  for (const float v : f.rgba) f_sum += v;
  for (const float v : g.rgba) g_sum += v;
  EXPECT_GT(g_sum, 1.2 * f_sum);
  EXPECT_EQ(picture_text(folder_ / "f.png", "voxlume:denoiser"), "decoupled");
}

TEST_F(CliDenoiseFiles, TransparentPicturesStayTransparent) {
  ASSERT_EQ(render("ball.nrrd", "f.exr", {"--aov", "denoise", "--background", "transparent"}).code, 0);
  ASSERT_EQ(denoise("f.exr", "o.exr", {"--method", "bilateral"}).code, 0);
  const Image out = picture("o.exr");
  EXPECT_EQ(out.pixel(0, 0)[3], 0);
  EXPECT_GT(out.pixel(12, 10)[3], 0.9f);
  ASSERT_EQ(denoise("f.exr", "o.png", {"--method", "bilateral"}).code, 0);
  EXPECT_EQ(picture("o.png").pixel(0, 0)[3], 0);
}

TEST_F(CliDenoiseFiles, SequencesAreThereWithoutGaps) {
  render_frames("f-##.exr", "ball.nrrd");
  fs::rename(folder_ / "f-02.exr", folder_ / "f-03.exr");
  write("f-4.exr", "of another pattern");
  write("f-xx.exr", "");
  expect_refused(denoise("f-##.exr", "o-#.exr"), "f-02.exr: is missing; frames from 0 to 3 are expected");
  expect_refused(denoise("f-##.exr", "o-#.exr", {"--frames", "1:3"}), "f-02.exr: is missing");
  expect_refused(denoise("f-##.exr", "o-#.exr", {"--frames", "1:5"}), "expected frames from 0 to 3");
  expect_refused(denoise("f-##.exr", "o-#.exr", {"--frames", "x"}), "--frames: found \"x\"");
  expect_refused(denoise("g-##.exr", "o-#.exr"), "no frame of this name is there");
  expect_refused(denoise("no/g-##.exr", "o-#.exr"), "no frame of this name is there");
  EXPECT_FALSE(exists("o-0.exr"));
  ASSERT_EQ(denoise("f-##.exr", "o-#.exr", {"--frames", ":1"}).code, 0);
  EXPECT_TRUE(exists("o-0.exr") && exists("o-1.exr") && !exists("o-3.exr"));
}

TEST_F(CliDenoiseFiles, NothingIsReplacedUnasked) {
  render_frames("f-#.exr", "ball.nrrd");
  const std::string before = read("f-1.exr");
  write("o-2.exr", "mine");
  expect_refused(denoise("f-#.exr", "o-#.exr"), "\"o-2.exr\" is there; --overwrite replaces it");
  EXPECT_FALSE(exists("o-0.exr"));
  EXPECT_EQ(denoise("f-#.exr", "o-#.exr", {"--overwrite"}).code, 0);
  EXPECT_NE(read("o-2.exr"), "mine");
  expect_refused(denoise("f-#.exr", "f-#.exr", {"--overwrite"}), "is an input of this command");
  fs::create_hard_link(folder_ / "f-1.exr", folder_ / "p-0.exr");
  expect_refused(denoise("f-#.exr", "p-#.exr", {"--overwrite"}), "\"p-0.exr\" is an input of this command");
  expect_refused(denoise("f-0.exr", "./f-0.exr", {"--overwrite"}), "is an input of this command");
  EXPECT_EQ(read("f-1.exr"), before);
}

TEST_F(CliDenoiseFiles, RefusesWhatItCannotDo) {
  ASSERT_EQ(render("ball.nrrd", "f.exr", {"--aov", "depth,normal,albedo"}).code, 0);
  expect_refused(denoise("f.exr", "o.exr"), "render the picture with --aov denoise");
  expect_refused(denoise("f.exr", "o.exr", {"--method", "wrls"}), "with --aov denoise");
  expect_refused(denoise("f.exr", "o.exr", {"--method", "dccoupled"}),
                 "--method: denoiser \"dccoupled\"; expected one of decoupled, svgf");
  expect_refused(denoise("f.exr", "o-#.exr"), "-o: has a # in it, and there is one picture");
  expect_refused(denoise("f-#.exr", "o.exr"), "-o: expected a name with #");
  expect_refused(denoise("f.exr", "o.tif"), "expected a name ending in .png or .exr");
  expect_refused(denoise("f.exr", "no/o.exr"), "the folder \"no\" does not exist");
  expect_refused(denoise("f.exr", "o.exr", {"--frames", "1"}), "--frames: there is one picture");
  expect_refused(denoise("g.exr", "o.exr"), "g.exr");
  expect_refused(run({"denoise", "f.exr"}), "-o: missing");
  expect_refused(run({"denoise", "-o", "f.exr"}), "INPUT: missing");
  EXPECT_FALSE(exists("o.exr"));
}

TEST_F(CliDenoiseFiles, DamagedPicturesAreOneLine) {
  render_frames("f-#.exr", "ball.nrrd");
  const std::string bytes = read("f-1.exr");
  write("f-1.exr", bytes.substr(0, bytes.size() / 2));
  const RunResult r = denoise("f-#.exr", "o-#.exr");
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(line_count(r.err), 1) << r.err;
  EXPECT_THAT(r.err, HasSubstr("f-1.exr"));
  EXPECT_TRUE(exists("o-0.exr"));
  EXPECT_FALSE(exists("o-1.exr"));
}

TEST_F(CliDenoiseFiles, PicturesOfOtherPrograms) {
  Image image(24, 20);
  for (std::size_t i = 0; i < image.rgba.size(); ++i)
    image.rgba[i] = i % 4 == 3 ? 1.0f : 0.5f + 0.3f * static_cast<float>(i * 7919 % 101) / 101;
  write_exr(image, folder_ / "x.exr");
  ASSERT_EQ(denoise("x.exr", "o.exr", {"--method", "wrls"}).code, 0);
  ASSERT_EQ(denoise("x.exr", "o.png", {"--method", "wrls"}).code, 0);
  EXPECT_NE(picture("o.exr").rgba, image.rgba);
  expect_refused(denoise("x.exr", "p.exr", {"--method", "svgf"}), "layer \"normal\" is missing");
  EXPECT_THAT(run({"denoise", "--help"}).out, HasSubstr("Pictures of other programs lack what decoupled"));
}

TEST_F(CliDenoiseFiles, ListsItsMethods) {
  const std::string help = run({"render", "--help"}).out;
  const RunResult r = run({"denoise", "--method", "list"});
  EXPECT_EQ(r.code, 0);
  EXPECT_EQ(line_count(r.out), static_cast<int>(denoiser_kinds().size()));
  for (const DenoiserKind& kind : denoiser_kinds()) {
    EXPECT_THAT(r.out, HasSubstr(std::string(kind.name)));
    EXPECT_THAT(r.out, HasSubstr(std::string(kind.summary)));
    EXPECT_THAT(help,
                testing::ContainsRegex("--denoise NAME[^-]+.*[ ]" + std::string(kind.name) + "(,| or)"));
  }
}

TEST_F(CliDenoiseFiles, StopsBetweenPictures) {
  render_frames("f-#.exr", "ball.nrrd");
  for (int k = 3; k < 200; ++k) {
    fs::copy_file(folder_ / "f-0.exr", folder_ / ("f-" + std::to_string(k) + ".exr"));
  }
  Process process({"denoise", "f-#.exr", "-o", "o-#.exr"}, folder_);
  for (int i = 0; i < 3000 && !exists("o-0.exr"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  process.signal(SIGINT);
  const RunResult r = process.wait();
  ASSERT_EQ(r.code, 130) << r.err;
  EXPECT_THAT(r.err, HasSubstr("of 200 pictures are written; --overwrite does all of them again"));
  EXPECT_FALSE(exists("o-199.exr"));
  for (const auto& entry : fs::directory_iterator(folder_)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("o-")) {
      EXPECT_NO_THROW(read_image(entry.path())) << name;
    }
    EXPECT_EQ(name.find("tmp"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace voxlume::test
