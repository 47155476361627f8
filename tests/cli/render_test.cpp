#include <gmock/gmock.h>

#include <chrono>
#include <csignal>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

#include "base/vec.h"
#include "cli_fixture.h"
#include "image_io/image_io.h"

namespace voxlume::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

/// Samples enough that a render cannot end before the test interrupts it.
const std::vector<std::string> kEndless{"render", "ball.nrrd", "-o",    "o.exr",
                                        "--size", "96x96",     "--spp", "1000000"};

TEST_F(CliTest, RendersAPictureOfTheVolume) {
  const RunResult r = render("ball.nrrd", "o.exr", {"--background", "0,0,0", "--aov", "alpha,depth,samples"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.out, "");
  const Image image = read_image(folder_ / "o.exr");
  EXPECT_EQ(image.width, 24);
  EXPECT_EQ(image.height, 20);
  EXPECT_GT(image.pixel(12, 10)[1], 0.01f);  // the ball
  EXPECT_EQ(image.pixel(0, 0)[1], 0.0f);     // the background
  ASSERT_NE(image.layer("samples"), nullptr);
  EXPECT_EQ(image.layer("samples")->values[0], 4.0f);
  EXPECT_NE(image.layer("depth"), nullptr);
  EXPECT_FALSE(exists("o.exr.checkpoint"));
}

TEST_F(CliTest, PicturesDoNotDependOnThreads) {
  ASSERT_EQ(render("ball.nrrd", "a.exr", {"--threads", "1"}).code, 0);
  ASSERT_EQ(render("ball.nrrd", "b.exr", {"--threads", "3"}).code, 0);
  EXPECT_EQ(read_image(folder_ / "a.exr").rgba, read_image(folder_ / "b.exr").rgba);
  ASSERT_EQ(render("ball.nrrd", "c.exr", {"--seed", "1"}).code, 0);
  EXPECT_NE(read_image(folder_ / "a.exr").rgba, read_image(folder_ / "c.exr").rgba);
}

TEST_F(CliTest, IntegratorsGivePicturesOfTheirOwnAndScenesOfTheirs) {
  std::vector<Image> pictures;
  for (const std::string name : {"path", "exposure-render", "rmss", "vpl-dvr", "ar2t", "ray-march"}) {
    const RunResult r =
        render("ball.nrrd", name + ".exr", {"--integrator", name, "--save-scene", name + ".json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Image image = read_image(folder_ / (name + ".exr"));
    EXPECT_GT(image.pixel(12, 10)[1], 0.01f) << name;
    for (const Image& other : pictures) EXPECT_NE(image.rgba, other.rgba) << name;
    pictures.push_back(image);
    // The scene that was saved says all.
    ASSERT_EQ(render(name + ".json", "again.exr", {"--threads", "1"}).code, 0);
    EXPECT_EQ(read_image(folder_ / "again.exr").rgba, image.rgba) << name;
  }
  const RunResult r = render("ball.nrrd", "o.exr", {"--integrator", "vpl"});
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("vpl-dvr"));
  EXPECT_EQ(line_count(r.err), 1) << r.err;
}

TEST_F(CliTest, NoiseEndsARenderWhereItIsReached) {
  constexpr int kSeeds = 8;
  constexpr double kAsked = 0.01;
  std::map<std::string, double> samples;
  for (const std::string sampler : {"sobol", "random"}) {
    std::vector<double> sums, squares;
    for (int seed = 1; seed <= kSeeds; ++seed) {
      const RunResult r =
          run({"render", "ball.nrrd", "-o", "o.exr", "--size", "40x40", "--noise", std::to_string(kAsked),
               "--aov", "samples", "--seed", std::to_string(seed), "--set", "/render/sampler=" + sampler});
      ASSERT_EQ(r.code, 0) << r.err;
      const Image image = read_image(folder_ / "o.exr");
      sums.resize(image.pixel_count());
      squares.resize(image.pixel_count());
      samples[sampler] += image.layer("samples")->values[0] / kSeeds;
      for (std::size_t i = 0; i < image.pixel_count(); ++i) {
        const float* const rgb = &image.rgba[4 * i];
        const double y = luminance(Vec3d(rgb[0], rgb[1], rgb[2]));
        sums[i] += y;
        squares[i] += y * y;
      }
    }
    // The mean of the standard deviation of eight normal numbers is 0.965 of the distribution's.
    double noise = 0;
    for (std::size_t i = 0; i < sums.size(); ++i) {
      const double mean = sums[i] / kSeeds;
      const double variance = std::max(0.0, squares[i] - mean * sums[i]) / (kSeeds - 1);
      noise += std::sqrt(variance) / 0.965 / (mean + 0.01) / static_cast<double>(sums.size());
    }
    EXPECT_NEAR(noise, kAsked, 0.15 * kAsked) << sampler << ", " << samples[sampler] << " samples";
  }
  EXPECT_LT(samples["sobol"], 0.7 * samples["random"]);
}

TEST_F(CliTest, PicturesHoldTheSceneButNoPaths) {
  std::filesystem::copy_file(folder_ / "ball.nrrd", folder_ / "doe-jane.nrrd");
  ASSERT_EQ(render("doe-jane.nrrd", "o.exr").code, 0);
  const Image image = read_image(folder_ / "o.exr");
  ASSERT_TRUE(image.metadata.contains("voxlume:scene"));
  EXPECT_EQ(json::parse(image.metadata.at("voxlume:scene"))["image"]["width"], 24);
  EXPECT_EQ(read("o.exr").find("doe-jane"), std::string::npos);
}

TEST_F(CliTest, FlagsOverrideTheScene) {
  write("s.json", R"({"version": 1, "volume": {"path": "ball.nrrd"}, "render": {"seed": 5},
                      "image": {"width": 10, "height": 10, "seconds": 100}, "camera": {"eye_mm": [0, -90, 0]}})");
  ASSERT_EQ(render("s.json", "a.exr", {"--seed", "7", "--camera", "20,10,1.5", "--stats", "a.json"}).code, 0);
  const json stats = json::parse(read("a.json"));
  EXPECT_EQ(stats["seed"], 7);
  EXPECT_EQ(stats["width"], 24);
  EXPECT_EQ(stats["spp"], 4.0);
  ASSERT_EQ(render("ball.nrrd", "b.exr", {"--seed", "7", "--camera", "20,10,1.5"}).code, 0);
  EXPECT_EQ(read_image(folder_ / "a.exr").rgba, read_image(folder_ / "b.exr").rgba);
}

TEST_F(CliTest, ASavedSceneGivesTheIdenticalPicture) {
  std::filesystem::create_directory(folder_ / "sub");
  const RunResult first =
      render("ball.nrrd", "a.exr",
             {"--camera", "-30,15", "--clip", "-3:,:,:6", "--shading", "phase", "--background", "#203040",
              "--set", "/material/anisotropy=0.3", "--save-scene", "sub/s.json"});
  ASSERT_EQ(first.code, 0) << first.err;
  EXPECT_THAT(read("sub/s.json"), HasSubstr("\"reference_length_mm\""));
  const RunResult second = run({"render", "sub/s.json", "-o", "b.exr"});
  ASSERT_EQ(second.code, 0) << second.err;
  EXPECT_EQ(read_image(folder_ / "a.exr").rgba, read_image(folder_ / "b.exr").rgba);
  ASSERT_EQ(run({"render", "sub/s.json", "--save-scene", "sub/t.json"}).code, 0);
  EXPECT_EQ(read("sub/s.json"), read("sub/t.json"));
}

TEST_F(CliTest, RawVolumesRenderAsTheirNamesakes) {
  ASSERT_EQ(render("ball.raw", "a.exr", {"--raw", "16x16x16,i16,1,1,1.5", "--preset", "generic"}).code, 0);
  ASSERT_EQ(
      render("ball.nrrd", "b.exr", {"--preset", "generic", "--set", "/volume/spacing_mm=[1,1,1.5]"}).code, 2);
  ASSERT_EQ(render("ball.nrrd", "b.exr", {"--preset", "generic", "--spacing", "1,1,1.5"}).code, 0);
  EXPECT_GT(read_image(folder_ / "a.exr").pixel(12, 10)[1], 0.0f);
}

TEST_F(CliTest, StatisticsHaveTheirKeys) {
  ASSERT_EQ(render("ball.nrrd", "o.png", {"--stats", "s.json", "--threads", "2"}).code, 0);
  const json stats = json::parse(read("s.json"));
  for (const char* key :
       {"wall_s", "load_s", "total_s", "threads", "simd", "integrator", "spp", "paths", "tracking_steps",
        "steps_per_s", "paths_per_s", "majorant_build_ms", "importance_list_s", "importance_list_mb",
        "peak_rss_bytes", "nonfinite_samples", "mean_luminance", "seed", "version"}) {
    EXPECT_TRUE(stats.contains(key)) << key;
  }
  EXPECT_EQ(stats["threads"], 2);
  EXPECT_EQ(stats["paths"], 24 * 20 * 4);
  EXPECT_EQ(stats["nonfinite_samples"], 0);
  EXPECT_EQ(stats["majorant_violations"], 0);
  EXPECT_GT(stats["mean_luminance"].get<double>(), 0);
  EXPECT_GE(stats["total_s"].get<double>(), stats["wall_s"].get<double>());
}

TEST_F(CliTest, TransparentPngHasAlpha) {
  ASSERT_EQ(render("ball.nrrd", "o.png", {"--background", "transparent"}).code, 0);
  const Image image = read_image(folder_ / "o.png");
  EXPECT_EQ(image.pixel(0, 0)[3], 0.0f);
  EXPECT_GT(image.pixel(12, 10)[3], 0.9f);
  ASSERT_EQ(render("ball.nrrd", "opaque.png").code, 0);
  EXPECT_EQ(read_image(folder_ / "opaque.png").pixel(0, 0)[3], 1.0f);
}

TEST_F(CliTest, TheTimeLimitHolds) {
  const RunResult r =
      run({"render", "ball.nrrd", "-o", "o.png", "--size", "32x32", "--seconds", "0.3", "--stats", "s.json"});
  ASSERT_EQ(r.code, 0) << r.err;
  const double wall_s = json::parse(read("s.json"))["wall_s"];
  EXPECT_GE(wall_s, 0.25);
  EXPECT_LT(wall_s, 3);
}

TEST_F(CliTest, TheNoiseLimitHolds) {
  ASSERT_EQ(
      run({"render", "ball.nrrd", "-o", "o.png", "--size", "16x16", "--noise", "0.2", "--stats", "s.json"})
          .code,
      0);
  EXPECT_LE(json::parse(read("s.json"))["noise"].get<double>(), 0.2);
}

/// Interrupts an endless render; returns the samples per pixel it came to.
class CliInterrupt : public CliTest {
 protected:
  double interrupt(int signal) const {
    std::vector<std::string> arguments = kEndless;
    // The scene is saved last before the first sample.
    arguments.insert(arguments.end(), {"--stats", "s.json", "--save-scene", "begun.json"});
    Process process(arguments, folder_);
    for (int i = 0; i < 1000 && !exists("begun.json"); ++i) pause();
    for (int i = 0; i < 30; ++i) pause();
    process.signal(signal);
    const RunResult r = process.wait();
    EXPECT_EQ(r.code, 130) << r.err;
    EXPECT_TRUE(exists("o.exr"));
    EXPECT_TRUE(exists("o.exr.checkpoint"));
    return json::parse(read("s.json"))["spp"];
  }
  static void pause() { std::this_thread::sleep_for(std::chrono::milliseconds(20)); }
};

TEST_F(CliInterrupt, WritesThePictureAndResumesBitForBit) {
  const double interrupted_spp = interrupt(SIGINT);
  ASSERT_GT(interrupted_spp, 1);
  std::vector<std::string> finish = kEndless;
  const std::string spp = std::to_string(static_cast<int>(interrupted_spp) + 40);
  finish.back() = spp;
  std::vector<std::string> whole = finish;
  finish.push_back("--resume");
  const RunResult resumed = run(finish);
  ASSERT_EQ(resumed.code, 0) << resumed.err;
  EXPECT_FALSE(exists("o.exr.checkpoint"));
  whole[3] = "whole.exr";
  ASSERT_EQ(run(whole).code, 0);
  EXPECT_EQ(read_image(folder_ / "o.exr").rgba, read_image(folder_ / "whole.exr").rgba);
}

TEST_F(CliInterrupt, TerminationCountsAndOtherScenesDoNotResume) {
  interrupt(SIGTERM);
  std::vector<std::string> other = kEndless;
  other.insert(other.end(), {"--resume", "--seed", "3"});
  const RunResult r = run(other);
  EXPECT_EQ(r.code, 2);
  EXPECT_THAT(r.err, HasSubstr("o.exr.checkpoint"));
  EXPECT_EQ(line_count(r.err), 1);
}

TEST_F(CliInterrupt, ResumingWithoutACheckpointStartsAnew) {
  const RunResult r = render("ball.nrrd", "o.png", {"--resume"});
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.err, HasSubstr("starting from the beginning"));
}

}  // namespace
}  // namespace voxlume::test
