#include "image_io/image_io.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <OpenImageIO/imageio.h>

#include <limits>
#include <sstream>

#include "image_io/sample_images.h"
#include "support/temporary_folder.h"
#include "tonemap/srgb.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::HasSubstr;

class ImageIo : public testing::Test {
 protected:
  template <class Work>
  Error error_of(Work work) const {
    try {
      work();
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
      return error;
    }
    ADD_FAILURE() << "no error";
    return Error(ErrorCode::kInternal, "", "");
  }

  test::TemporaryFolder folder_;
};

TEST_F(ImageIo, ExrRoundTripIsExact) {
  Image image = test::sample_image(37, 150);
  image.rgba[5] = -3.0f;
  image.rgba[6] = std::numeric_limits<float>::infinity();
  write_exr(image, folder_ / "a.exr");
  const Image back = read_image(folder_ / "a.exr");
  EXPECT_EQ(back.width, 37);
  EXPECT_EQ(back.height, 150);
  EXPECT_EQ(back.rgba, image.rgba);
  EXPECT_EQ(back.metadata, image.metadata);
  EXPECT_EQ(back.layers.size(), image.layers.size());
  for (const ImageLayer& layer : image.layers) {
    ASSERT_NE(back.layer(layer.name), nullptr) << layer.name;
    EXPECT_EQ(*back.layer(layer.name), layer);
  }
  EXPECT_EQ(folder_.entry_count(), 1u);
}

TEST_F(ImageIo, ExrChannelNamesAreFixed) {
  write_exr(test::sample_image(4, 4), folder_ / "a.exr");
  const auto input = OIIO::ImageInput::open((folder_ / "a.exr").string());
  ASSERT_NE(input, nullptr);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::FLOAT);
  EXPECT_THAT(input->spec().channelnames,
              testing::UnorderedElementsAre("R", "G", "B", "A", "alpha.Y", "depth.Z", "normal.X", "normal.Y",
                                            "normal.Z", "albedo.R", "albedo.G", "albedo.B", "samples.Y",
                                            "variance.Y"));
  EXPECT_EQ(input->spec().get_string_attribute("voxlume:seed"), "18446744073709551615");
  EXPECT_EQ(input->spec().get_string_attribute("DateTime"), "");
}

TEST_F(ImageIo, SameBytesEachTime) {
  const Image image = test::sample_image(9, 9);
  write_exr(image, folder_ / "a.exr");
  write_exr(image, folder_ / "b.exr");
  EXPECT_EQ(test::read_bytes(folder_ / "a.exr"), test::read_bytes(folder_ / "b.exr"));
}

TEST_F(ImageIo, ForeignExrChannels) {
  // Half floats, no alpha, a channel without a layer: as other programs write them.
  OIIO::ImageSpec spec(3, 2, 4, OIIO::TypeDesc::HALF);
  spec.channelnames = {"R", "G", "B", "Z"};
  spec.attribute("PatientName", "somebody");
  std::vector<float> values(24);
  for (std::size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open((folder_ / "a.exr").string(), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
  const Image image = read_image(folder_ / "a.exr");
  EXPECT_EQ(image.pixel(2, 1)[1], 21.0f);
  EXPECT_EQ(image.pixel(2, 1)[3], 1.0f);
  ASSERT_NE(image.layer(""), nullptr);
  EXPECT_EQ(image.layer("")->channels, std::vector<std::string>{"Z"});
  EXPECT_EQ(image.layer("")->values[5], 23.0f);
  EXPECT_TRUE(image.metadata.empty());
}

TEST_F(ImageIo, ExrWithoutColourIsRefused) {
  OIIO::ImageSpec spec(2, 2, 1, OIIO::TypeDesc::FLOAT);
  spec.channelnames = {"depth.Z"};
  const std::vector<float> values(4);
  const auto output = OIIO::ImageOutput::create("openexr");
  ASSERT_TRUE(output->open((folder_ / "a.exr").string(), spec));
  ASSERT_TRUE(output->write_image(OIIO::TypeDesc::FLOAT, values.data()));
  ASSERT_TRUE(output->close());
  EXPECT_EQ(error_of([&] { read_image(folder_ / "a.exr"); }).code(), ErrorCode::kUnsupported);
}

TEST_F(ImageIo, PngKnownColoursAreExact) {
  const Image8 image{2, 2, 3, {0, 128, 255, 1, 2, 3, 10, 20, 30, 200, 118, 7}, {{"voxlume:seed", "5"}}};
  write_png(image, folder_ / "a.png");
  const auto input = OIIO::ImageInput::open((folder_ / "a.png").string());
  ASSERT_NE(input, nullptr);
  EXPECT_EQ(input->spec().nchannels, 3);
  EXPECT_EQ(input->spec().format, OIIO::TypeDesc::UINT8);
  std::vector<std::uint8_t> stored(12);
  ASSERT_TRUE(input->read_image(0, 0, 0, 3, OIIO::TypeDesc::UINT8, stored.data()));
  EXPECT_EQ(stored, image.values);
  EXPECT_EQ(input->spec().get_string_attribute("voxlume:seed"), "5");
  const Image back = read_image(folder_ / "a.png");
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(back.rgba[4 * i + c], linear_from_srgb(static_cast<float>(image.values[3 * i + c]) / 255));
    }
    EXPECT_EQ(back.rgba[4 * i + 3], 1.0f);
  }
}

TEST_F(ImageIo, PngAlphaIsStraightInTheFile) {
  const Image8 image{3, 1, 4, {200, 100, 50, 128, 255, 255, 255, 0, 7, 8, 9, 255}, {}};
  write_png(image, folder_ / "a.png");
  const auto input = OIIO::ImageInput::create("png");
  OIIO::ImageSpec config, spec;
  config.attribute("oiio:UnassociatedAlpha", 1);
  ASSERT_TRUE(input->open((folder_ / "a.png").string(), spec, config));
  std::vector<std::uint8_t> stored(12);
  ASSERT_TRUE(input->read_image(0, 0, 0, 4, OIIO::TypeDesc::UINT8, stored.data()));
  EXPECT_EQ(stored, image.values);
  // In memory it is linear and premultiplied.
  const Image back = read_image(folder_ / "a.png");
  const float alpha = 128.0f / 255;
  EXPECT_NEAR(back.rgba[0], linear_from_srgb(200.0f / 255) * alpha, 1e-6f);
  EXPECT_NEAR(back.rgba[3], alpha, 1e-7f);
  EXPECT_EQ(back.rgba[4], 0.0f);
  EXPECT_EQ(back.rgba[7], 0.0f);
}

TEST_F(ImageIo, GreyPngAndSixteenBits) {
  for (const int channels : {1, 2}) {
    OIIO::ImageSpec spec(2, 1, channels, OIIO::TypeDesc::UINT16);
    spec.attribute("oiio:UnassociatedAlpha", 1);
    const std::vector<std::uint16_t> values{32768, 65535, 1000, 65535};
    const auto output = OIIO::ImageOutput::create("png");
    ASSERT_TRUE(output->open((folder_ / "grey.png").string(), spec));
    ASSERT_TRUE(output->write_image(OIIO::TypeDesc::UINT16, values.data()));
    ASSERT_TRUE(output->close());
    const Image image = read_image(folder_ / "grey.png");
    for (int c = 0; c < 3; ++c) EXPECT_EQ(image.rgba[c], linear_from_srgb(32768.0f / 65535));
    EXPECT_EQ(image.rgba[3], 1.0f);
  }
}

TEST_F(ImageIo, HdrValues) {
  // Mantissas 128 64 32 with exponent 129: 2^(129 - 128) / 256 times them.
  std::string rgbe = std::string("\x80\x40\x20\x81", 4) + std::string(4, '\0');
  test::write_bytes(folder_ / "a.hdr", test::hdr_bytes(2, 1, rgbe));
  const Image image = read_image(folder_ / "a.hdr");
  EXPECT_EQ(image.rgba, (std::vector<float>{1, 0.5f, 0.25f, 1, 0, 0, 0, 1}));
}

TEST_F(ImageIo, FormatIsToldByTheBytes) {
  write_exr(test::sample_image(4, 2), folder_ / "a.png");
  EXPECT_EQ(read_image(folder_ / "a.png").layers.size(), 6u);
}

TEST_F(ImageIo, MissingAndForeignFiles) {
  EXPECT_EQ(error_of([&] { read_image(folder_ / "none.exr"); }).code(), ErrorCode::kFileNotFound);
  EXPECT_EQ(error_of([&] { read_image(folder_.path()); }).code(), ErrorCode::kFileNotFound);
  test::write_bytes(folder_ / "text.exr", "hello");
  EXPECT_EQ(error_of([&] { read_image(folder_ / "text.exr"); }).code(), ErrorCode::kBadFormat);
  test::write_bytes(folder_ / "empty.png", "");
  EXPECT_EQ(error_of([&] { read_image(folder_ / "empty.png"); }).code(), ErrorCode::kBadFormat);
}

TEST_F(ImageIo, AbsurdSizesTakeNoMemory) {
  for (const char* size : {"-Y 65536 +X 65536", "-Y 32768 +X 65536", "-Y 2000000000 +X 2000000000",
                           "-Y -5 +X 8", "-Y 0 +X 8", "-Y 99999999999999 +X 1"}) {
    const std::string header = std::string("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n") + size + "\n";
    test::write_bytes(folder_ / "a.hdr", header + "abcd");
    const Error error = error_of([&] { read_image(folder_ / "a.hdr"); });
    EXPECT_EQ(error.code(), ErrorCode::kBadFormat) << error.what();
  }
  write_exr(test::sample_image(64, 64), folder_ / "a.exr");
  const Error error = error_of([&] { read_image(folder_ / "a.exr", {.memory_limit_bytes = 1000}); });
  EXPECT_EQ(error.code(), ErrorCode::kOutOfMemory);
  EXPECT_THAT(error.message(), HasSubstr("64 x 64"));
}

TEST_F(ImageIo, WritersRefuseWrongSizes) {
  Image image = test::sample_image(4, 4);
  image.layers[2].values.pop_back();
  EXPECT_EQ(error_of([&] { write_exr(image, folder_ / "a.exr"); }).code(), ErrorCode::kBadParameter);
  image = test::sample_image(4, 4);
  image.rgba.pop_back();
  EXPECT_EQ(error_of([&] { write_exr(image, folder_ / "a.exr"); }).code(), ErrorCode::kBadParameter);
  EXPECT_EQ(error_of([&] { write_exr(Image(), folder_ / "a.exr"); }).code(), ErrorCode::kBadParameter);
  EXPECT_EQ(error_of([&] {
              write_png({2, 2, 3, {1, 2}, {}}, folder_ / "a.png");
            }).code(),
            ErrorCode::kBadParameter);
  EXPECT_EQ(error_of([&] {
              write_png({1, 1, 2, {1, 2}, {}}, folder_ / "a.png");
            }).code(),
            ErrorCode::kBadParameter);
  EXPECT_EQ(folder_.entry_count(), 0u);
}

TEST_F(ImageIo, WriteErrorsAreClean) {
  const Image8 pixel{1, 1, 3, {1, 2, 3}, {}};
  EXPECT_EQ(error_of([&] { write_png(pixel, folder_ / "none/a.png"); }).code(), ErrorCode::kFileNotFound);
  EXPECT_EQ(error_of([&] { write_exr(Image(1, 1), folder_.path()); }).code(), ErrorCode::kBadParameter);
  // The disk is full.
  const Image many_values = test::sample_image(200, 200);
  EXPECT_EQ(error_of([&] { write_exr(many_values, "/dev/full"); }).code(), ErrorCode::kInternal);
  const Image8 large{400, 400, 3, std::vector<std::uint8_t>(480000, 7), {}};
  EXPECT_EQ(error_of([&] { write_png(large, "/dev/full"); }).code(), ErrorCode::kInternal);
}

TEST_F(ImageIo, EnvironmentIsColourAlone) {
  Image image = test::sample_image(8, 4);
  write_exr(image, folder_ / "a.exr");
  const EnvironmentImage environment = read_environment(folder_ / "a.exr");
  EXPECT_EQ(environment.width, 8);
  EXPECT_EQ(environment.height, 4);
  ASSERT_EQ(environment.rgb.size(), 96u);
  EXPECT_EQ(environment.rgb[3 * 9 + 1], image.pixel(1, 1)[1]);
}

TEST_F(ImageIo, EnvironmentRefusals) {
  write_exr(test::sample_image(8, 5), folder_ / "aspect.exr");
  Error error = error_of([&] { read_environment(folder_ / "aspect.exr"); });
  EXPECT_EQ(error.code(), ErrorCode::kBadFormat);
  EXPECT_THAT(error.message(), HasSubstr("8 x 5"));
  for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity()}) {
    Image image = test::sample_image(8, 4);
    image.pixel(6, 3)[2] = bad;
    write_exr(image, folder_ / "bad.exr");
    error = error_of([&] { read_environment(folder_ / "bad.exr"); });
    EXPECT_EQ(error.code(), ErrorCode::kBadFormat);
    EXPECT_THAT(error.message(), HasSubstr("6,3"));
    EXPECT_THAT(error.where(), HasSubstr("bad.exr"));
  }
  // Negative radiance is what filters leave behind.
  Image ringing = test::sample_image(8, 4);
  ringing.pixel(6, 3)[2] = -0.5f;
  write_exr(ringing, folder_ / "ringing.exr");
  EXPECT_EQ(read_environment(folder_ / "ringing.exr").rgb[3 * 30 + 2], 0.0f);
  // Negative alpha is no business of an environment.
  Image image = test::sample_image(8, 4);
  image.pixel(6, 3)[3] = -1;
  write_exr(image, folder_ / "alpha.exr");
  EXPECT_EQ(read_environment(folder_ / "alpha.exr").width, 8);
}

}  // namespace
}  // namespace voxlume
