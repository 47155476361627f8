#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "cli_fixture.h"
#include "image_io/image_io.h"

namespace voxlume::test {
namespace {

using nlohmann::json;
using testing::HasSubstr;

TEST_F(CliTest, InfoJson) {
  const RunResult r = run({"info", "ball.nrrd", "--json"});
  ASSERT_EQ(r.code, 0) << r.err;
  const json info = json::parse(r.out);
  EXPECT_EQ(info["size"], json({16, 16, 16}));
  EXPECT_EQ(info["type"], "i16");
  EXPECT_EQ(info["spacing_mm"], json({1.0, 1.0, 1.5}));
  EXPECT_EQ(info["extent_mm"], json({16.0, 16.0, 24.0}));
  EXPECT_EQ(info["origin_mm"], json({-7.5, -7.5, -11.25}));
  EXPECT_EQ(info["orientation"], "LPS");
  EXPECT_EQ(info["value_range"], json({-1000.0, 1000.0}));
  EXPECT_EQ(info["percentiles"]["50"], -1000.0);
  EXPECT_EQ(info["percentiles"]["99.9"], 1000.0);
  EXPECT_EQ(info["bytes"], 16 * 16 * 16 * 2);
  EXPECT_GE(info["render_bytes"], 16 * 16 * 16 * 2);
  EXPECT_TRUE(info["warnings"].is_array());
}

TEST_F(CliTest, InfoNamesTheOrientationByItsAxes) {
  std::string flipped = read("ball.nrrd");
  const std::string directions = "(1,0,0) (0,1,0) (0,0,1.5)";
  flipped.replace(flipped.find(directions), directions.size(), "(0,0,-1) (-1,0,0) (0,2,0)");
  write("turned.nrrd", flipped);
  const json info = json::parse(run({"info", "turned.nrrd", "--json"}).out);
  EXPECT_EQ(info["orientation"], "IRP");
  EXPECT_EQ(info["spacing_mm"], json({1.0, 1.0, 2.0}));
}

TEST_F(CliTest, InfoForPeople) {
  const RunResult r = run({"info", "ball.nrrd"});
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.out, HasSubstr("16 x 16 x 16 voxels"));
  EXPECT_THAT(r.out, HasSubstr("1 x 1 x 1.5 mm"));
  EXPECT_THAT(r.out, HasSubstr("-1000 to 1000"));
  EXPECT_THAT(run({"info", "ball.raw", "--raw", "16x16x16,i16,2,2,2"}).out, HasSubstr("32 x 32 x 32 mm"));
}

TEST_F(CliTest, InfoTellsATerminalHowFarItIs) {
  if (std::system("script --version > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "no script, which makes a terminal";
  write("large.raw", std::string(2 * 100 * 100 * 60, 'x'));
  const std::string info = std::string(VOXLUME_BINARY) + " info large.raw --raw 100x100x60,i16,1,1,1,big";
  const std::string command = "cd '" + folder_.string() + "' && script -qec '" + info + "' seen > /dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  const std::string seen = read("seen");
  EXPECT_THAT(seen, testing::ContainsRegex("reading large.raw: [1-9][0-9]? %"));
  EXPECT_THAT(seen, testing::ContainsRegex("looking over large.raw: [4-6][0-9] %"));
  EXPECT_THAT(seen, HasSubstr("100 x 100 x 60 voxels"));
}

TEST_F(CliTest, ConvertThereAndBack) {
  ASSERT_EQ(run({"convert", "ball.nrrd", "ball.nii.gz"}).code, 0);
  ASSERT_EQ(run({"convert", "ball.nii.gz", "ball.mha"}).code, 0);
  json before = json::parse(run({"info", "ball.nrrd", "--json"}).out);
  json after = json::parse(run({"info", "ball.mha", "--json"}).out);
  for (const char* key :
       {"size", "type", "spacing_mm", "origin_mm", "direction", "value_range", "percentiles"}) {
    EXPECT_EQ(before[key], after[key]) << key;
  }
}

TEST_F(CliTest, ConvertDevelopsAPicture) {
  ASSERT_EQ(render("ball.nrrd", "a.exr", {"--exposure", "1"}).code, 0);
  ASSERT_EQ(render("ball.nrrd", "direct.png", {"--exposure", "1"}).code, 0);
  const RunResult r = run({"convert", "a.exr", "developed.png"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(json::parse(run({"compare", "developed.png", "direct.png", "--json"}).out)["rmse"], 0.0);
  EXPECT_THAT(run({"convert", "a.exr", "a.nrrd"}).err, HasSubstr("a.nrrd"));
  EXPECT_THAT(run({"convert", "a.exr", "a.exr"}).err, HasSubstr("is an input of this command"));
}

TEST_F(CliTest, CompareOfIdenticalPictures) {
  ASSERT_EQ(render("ball.nrrd", "a.exr").code, 0);
  const RunResult r = run({"compare", "a.exr", "a.exr", "--json"});
  ASSERT_EQ(r.code, 0) << r.err;
  const json result = json::parse(r.out);
  EXPECT_EQ(result["rmse"], 0.0);
  EXPECT_TRUE(result["psnr"].is_null());
  EXPECT_NEAR(result["ssim"].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(result["flip"], 0.0);
  EXPECT_EQ(result["flip_hdr"], 0.0);
}

TEST_F(CliTest, CompareOfDifferentPictures) {
  ASSERT_EQ(render("ball.nrrd", "a.exr").code, 0);
  ASSERT_EQ(render("ball.nrrd", "b.exr", {"--seed", "9"}).code, 0);
  const RunResult r =
      run({"compare", "a.exr", "b.exr", "--metric", "psnr,rmse", "--json", "--error-map", "e.png"});
  ASSERT_EQ(r.code, 0) << r.err;
  const json result = json::parse(r.out);
  EXPECT_EQ(result.size(), 2u);
  EXPECT_GT(result["rmse"].get<double>(), 0);
  EXPECT_GT(result["psnr"].get<double>(), 5);
  EXPECT_EQ(read_image(folder_ / "e.png").width, 24);
  const RunResult all = run({"compare", "a.exr", "b.exr"});
  for (const char* name : {"rmse ", "psnr ", "psnr_hdr ", "ssim ", "flip ", "flip_hdr "}) {
    EXPECT_THAT(all.out, HasSubstr(name));
  }
  ASSERT_EQ(run({"render", "ball.nrrd", "-o", "small.exr", "--size", "8x8", "--spp", "1"}).code, 0);
  const RunResult sizes = run({"compare", "a.exr", "small.exr"});
  EXPECT_EQ(sizes.code, 2);
  EXPECT_THAT(sizes.err, HasSubstr("is 8 x 8 pixels, expected 24 x 20"));
}

TEST_F(CliTest, CompareLeavesItsInputsAlone) {
  Image image(12, 12);
  write_exr(image, folder_ / "a.exr");
  ASSERT_EQ(run({"compare", "a.exr", "a.exr", "--error-map", "e.png"}).code, 0);
  std::filesystem::copy_file(folder_ / "e.png", folder_ / "f.png");
  std::filesystem::create_hard_link(folder_ / "f.png", folder_ / "g.png");
  const std::string before = read("f.png");
  for (const char* map : {"e.png", "f.png", "./f.png", "g.png"}) {
    const RunResult r = run({"compare", "e.png", "f.png", "--error-map", map});
    EXPECT_EQ(r.code, 2) << map;
    EXPECT_EQ(r.out, "");
    EXPECT_THAT(r.err, HasSubstr("--error-map: \"" + std::string(map) + "\" is an input of this command"));
  }
  EXPECT_EQ(read("f.png"), before);
  EXPECT_EQ(read("e.png"), before);
}

TEST_F(CliTest, CompareNamesThePictureThatIsNotFinite) {
  Image image(12, 12);
  write_exr(image, folder_ / "a.exr");
  image.pixel(3, 5)[1] = std::nanf("");
  write_exr(image, folder_ / "b.exr");
  for (const auto& [a, b] : {std::pair{"a.exr", "b.exr"}, {"b.exr", "a.exr"}}) {
    const RunResult r = run({"compare", a, b});
    EXPECT_EQ(r.code, 2);
    EXPECT_THAT(r.err, HasSubstr("b.exr: has a value that is not finite at pixel 3,5"));
  }
}

// A mid-grey picture against one that is black on the left: the right half is equal.
TEST_F(CliTest, ErrorMapsOfFlip) {
  Image grey(60, 40), half(60, 40);
  for (Image* image : {&grey, &half}) std::fill(image->rgba.begin(), image->rgba.end(), 0.2f);
  for (int y = 0; y < 40; ++y) std::fill_n(half.pixel(0, y), 4 * 30, 0.0f);
  write_exr(grey, folder_ / "grey.exr");
  write_exr(half, folder_ / "half.exr");
  for (const char* kind : {"flip", "flip_hdr"}) {
    const RunResult r = run({"compare", "half.exr", "grey.exr", "--metric", kind, "--json", "--error-map",
                             "e.png", "--error-map-kind", kind});
    ASSERT_EQ(r.code, 0) << r.err;
    const double mean = json::parse(r.out)[kind].get<double>();
    EXPECT_GT(mean, 0.3);
    EXPECT_LT(mean, 0.6);
    const Image map = read_image(folder_ / "e.png");
    ASSERT_EQ(map.width, 60);
    EXPECT_GT(map.pixel(5, 20)[0], 0.5f);
    EXPECT_EQ(map.pixel(55, 20)[0], 0.0f);
  }
}

TEST_F(CliTest, HdrFlipNeedsALitReference) {
  write_exr(Image(12, 12), folder_ / "black.exr");
  const RunResult r = run({"compare", "black.exr", "black.exr", "--json"});
  ASSERT_EQ(r.code, 0) << r.err;
  EXPECT_TRUE(json::parse(r.out)["flip_hdr"].is_null());
  const RunResult map =
      run({"compare", "black.exr", "black.exr", "--error-map", "e.png", "--error-map-kind", "flip_hdr"});
  EXPECT_EQ(map.code, 2);
  EXPECT_THAT(map.err, HasSubstr("black reference"));
  EXPECT_FALSE(exists("e.png"));
}

}  // namespace
}  // namespace voxlume::test
