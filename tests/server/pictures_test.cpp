#include <gtest/gtest.h>

#include <cmath>

#include "grid/grid_view.h"
#include "image_io/image_io.h"
#include "server/frame_message.h"
#include "server/picture_bytes.h"
#include "server/probe.h"
#include "server/viewer.h"
#include "support/temporary_folder.h"
#include "support/volumes.h"

namespace voxlume::server {
namespace {

Image8 gradient(int width, int height, int channels) {
  Image8 picture{width, height, channels, {}, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      for (int c = 0; c < channels; ++c)
        picture.values.push_back(static_cast<std::uint8_t>(c == 3 ? 255 : (x * 7 + y * 3 + c * 40) % 256));
  return picture;
}

TEST(PictureBytes, PngIsThePicture) {
  const test::TemporaryFolder folder;
  for (const int channels : {3, 4}) {
    const Image8 picture = gradient(37, 21, channels);
    test::write_bytes(folder / "p.png", png_bytes(picture));
    write_png(picture, folder / "q.png");
    EXPECT_EQ(read_image(folder / "p.png").rgba, read_image(folder / "q.png").rgba);
  }
}

TEST(PictureBytes, JpegIsOne) {
  const std::string jpeg = jpeg_bytes(gradient(37, 21, 3));
  EXPECT_EQ(jpeg.substr(0, 3), "\xFF\xD8\xFF");
  EXPECT_EQ(jpeg.substr(jpeg.size() - 2), "\xFF\xD9");
}

std::shared_ptr<LiveFrame> frame_of(int channels, bool moving) {
  auto frame = std::make_shared<LiveFrame>();
  frame->number = 3;
  frame->revision = 5;
  frame->moving = moving;
  frame->frame_s = 0.05;
  frame->picture = gradient(8, 4, channels);
  return frame;
}

nlohmann::json header_of(const FrameMessage& message) {
  const auto* bytes = reinterpret_cast<const unsigned char*>(message.bytes->data());
  const std::size_t size =
      bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<std::size_t>(bytes[3]) << 24;
  return nlohmann::json::parse(message.bytes->substr(4, size));
}

TEST(FrameMessage, NumbersGoOnFromTheSessionBefore) {
  FrameCoder coder;
  const FrameMessage message = coder.code(frame_of(3, true), {.frames_before = 100, .revisions_before = 200});
  EXPECT_EQ(message.number, 103u);
  const auto header = header_of(message);
  EXPECT_EQ(header["frame"], 103);
  EXPECT_EQ(header["revision"], 205);
  EXPECT_EQ(header["format"], "jpeg");
  EXPECT_NEAR(header["fps"].get<double>(), 20, 1e-9);
  EXPECT_TRUE(header["noise"].is_null());
}

TEST(FrameMessage, TransparencyIsKeptWhileMoving) {
  FrameCoder coder;
  EXPECT_EQ(header_of(coder.code(frame_of(4, true), {}))["format"], "png");
  EXPECT_EQ(header_of(coder.code(frame_of(3, false), {}))["format"], "png");
}

TEST(Probe, PlaceIsAlongThePixelsRay) {
  LiveFrame frame;
  CameraDescription description;
  description.vertical_fov_deg = 40;
  frame.camera = compile_camera(description, Vec3f(10, 20, 30), 50, 8, 4);
  frame.picture = gradient(8, 4, 3);
  frame.depth_mm.assign(32, 0);
  frame.depth_mm[1 * 8 + 6] = 70;
  const auto place = place_in_picture(frame, 6.5 / 8, 1.5 / 4);
  ASSERT_TRUE(place);
  const PixelPosition seen = project(frame.camera, Vec3f(*place));
  EXPECT_NEAR(seen.px, 6.5, 1e-3);
  EXPECT_NEAR(seen.py, 1.5, 1e-3);
  EXPECT_NEAR(length(*place - Vec3d(frame.camera.eye_mm)), 70, 1e-3);
  EXPECT_FALSE(place_in_picture(frame, 0.1, 0.1));
  EXPECT_FALSE(place_in_picture(frame, 1, 1));
  EXPECT_FALSE(place_in_picture(LiveFrame{}, 0.5, 0.5));
}

TEST(Probe, DataOfATurnedVolume) {
  for (const test::Placement& placement : test::placements()) {
    const Volume volume = test::make_volume<std::int16_t>(
        {9, 8, 7}, [](auto i, auto j, auto k) { return i + 10 * j + 100 * k; }, placement);
    const auto data = data_at(volume, world_from_index(volume).point({3.25, 4, 5.5}));
    EXPECT_EQ(data["voxel"][0], 3);
    EXPECT_EQ(data["voxel"][1], 4);
    EXPECT_NEAR(data["value"].get<double>(), 3.25 + 40 + 550, 0.01);
    const auto outside = data_at(volume, world_from_index(volume).point({-0.7, 4, 9}));
    EXPECT_EQ(outside["voxel"], nlohmann::json({0, 4, 6}));
  }
}

TEST(RateLimit, LetsRunsThroughButNoMoreThanItsRateOnAverage) {
  RateLimit limit(10, 20);
  RateLimit::Time now{};
  int taken = 0;
  while (limit.take(now)) ++taken;
  EXPECT_EQ(taken, 20);
  now += std::chrono::seconds(1);
  for (int i = 0; i < 10; ++i) EXPECT_TRUE(limit.take(now));
  EXPECT_FALSE(limit.take(now));
  now += std::chrono::hours(1);
  taken = 0;
  while (limit.take(now)) ++taken;
  EXPECT_EQ(taken, 20);
}

}  // namespace
}  // namespace voxlume::server
