#include <gmock/gmock.h>

#include <cstdlib>

#include "cli_fixture.h"
#include "image_io/image_io.h"
#include "metrics/metrics.h"

namespace voxlume::test {
namespace {

using testing::HasSubstr;

class CliDenoise : public CliTest {
 protected:
  Image picture(const std::string& name) const { return read_image(folder_ / name); }
  void render_ball(const std::string& out, const std::string& spp,
                   const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"render", "ball.nrrd", "-o", out, "--size", "64x64", "--spp", spp};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const RunResult r = run(arguments);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(r.err, "");
  }
};

TEST_F(CliDenoise, TakesNoiseAway) {
  render_ball("exact.exr", "512");
  render_ball("noisy.exr", "4", {"--seed", "7"});
  const double noisy = rmse(picture("noisy.exr"), picture("exact.exr"));
  for (const std::string method : {"decoupled", "svgf", "asvgf", "atrous", "bilateral", "wrls", "rls"}) {
    render_ball("o.exr", "4", {"--seed", "7", "--denoise", method});
    EXPECT_LT(rmse(picture("o.exr"), picture("exact.exr")), 0.8 * noisy) << method;
  }
}

TEST_F(CliDenoise, ConvergesToThePlainPicture) {
  render_ball("noisy.exr", "2048");
  render_ball("o.exr", "2048", {"--denoise", "decoupled"});
  render_ball("other.exr", "2048", {"--seed", "7"});
  const double noise = rmse(picture("noisy.exr"), picture("other.exr"));
  EXPECT_LT(rmse(picture("o.exr"), picture("noisy.exr")), noise)
      << "nearer to it than its own noise is large";
}

TEST_F(CliDenoise, IsNeverWorseThanThePlainPictureOfManySamples) {
  render_ball("exact.exr", "4096", {"--seed", "9"});
  for (const std::string spp : {"256", "1024"}) {
    render_ball("noisy.exr", spp);
    render_ball("o.exr", spp, {"--denoise", "decoupled"});
    EXPECT_LT(rmse(picture("o.exr"), picture("exact.exr")),
              1.05 * rmse(picture("noisy.exr"), picture("exact.exr")))
        << spp;
  }
}

TEST_F(CliDenoise, DoesNotDependOnTheNumberOfThreads) {
  render_ball("one.exr", "40", {"--denoise", "decoupled", "--threads", "1"});
  render_ball("all.exr", "40", {"--denoise", "decoupled"});
  EXPECT_EQ(picture("one.exr").rgba, picture("all.exr").rgba);
}

TEST_F(CliDenoise, KeepsTransparencyAndLayers) {
  render_ball("o.exr", "16",
              {"--denoise", "decoupled", "--background", "transparent", "--aov", "depth,albedo"});
  const Image image = picture("o.exr");
  EXPECT_NE(image.layer("depth"), nullptr);
  EXPECT_NE(image.layer("albedo"), nullptr);
  EXPECT_EQ(image.pixel(0, 0)[3], 0);
  EXPECT_GT(image.pixel(32, 32)[3], 0.9f);
}

TEST_F(CliDenoise, FramesOfASequenceRememberThoseBefore) {
  const std::vector<std::string> table{"--turntable", "1",         "--fps",    "8",
                                       "--denoise",   "decoupled", "--camera", "20,5"};
  render_ball("a-#.exr", "2", table);
  std::vector<std::string> still = table;
  still.insert(still.end(), {"--frames", "0:0"});
  render_ball("b-#.exr", "2", still);
  EXPECT_EQ(picture("a-0.exr").rgba, picture("b-0.exr").rgba) << "the first has none";

  // A later part alone is shown what was before it.
  std::vector<std::string> part = table;
  part.insert(part.end(), {"--frames", "5:7"});
  render_ball("c-#.exr", "2", part);
  EXPECT_EQ(picture("a-7.exr").rgba, picture("c-7.exr").rgba);
  std::filesystem::remove(folder_ / "a-6.exr");
  std::vector<std::string> resumed = table;
  resumed.push_back("--resume");
  render_ball("a-#.exr", "2", resumed);
  EXPECT_EQ(picture("a-6.exr").rgba, picture("c-6.exr").rgba);
}

TEST_F(CliDenoise, SaysWhatIsMissingForOpenImageDenoise) {
  ::setenv("VOXLUME_OIDN_LIBRARY", "/nowhere/libOpenImageDenoise.so", 1);
  const RunResult r = render("ball.nrrd", "o.png", {"--denoise", "oidn"});
  ::unsetenv("VOXLUME_OIDN_LIBRARY");
  EXPECT_EQ(r.code, 2);
  EXPECT_EQ(line_count(r.err), 1) << r.err;
  EXPECT_THAT(r.err, HasSubstr("VOXLUME_OIDN_LIBRARY"));
  EXPECT_FALSE(exists("o.png"));
}

}  // namespace
}  // namespace voxlume::test
