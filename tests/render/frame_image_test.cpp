#include "render/frame_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>
#include <random>

#include "image_io/image_io.h"
#include "render/camera_text.h"
#include "render/file_denoiser.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

using testing::HasSubstr;

constexpr int kWidth = 19, kHeight = 7;
constexpr DenoiserNeeds kEverything{.normal = true, .albedo = true, .classes = true};
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

/// Every plane of a frame.
std::vector<Plane*> planes_of(DenoiseFrame& frame) {
  std::vector<Plane*> planes{&frame.alpha, &frame.depth_mm, &frame.variance, &frame.samples};
  const auto add = [&](Planes3& three) {
    for (Plane& plane : three) planes.push_back(&plane);
  };
  add(frame.radiance);
  add(frame.background);
  add(frame.normal);
  add(frame.albedo);
  for (SampleClass& one : *frame.classes) {
    planes.push_back(&one.count);
    for (Planes3* three :
         {&one.fx_diffuse, &one.fx_specular, &one.fl_diffuse, &one.fl_specular, &one.later}) {
      add(*three);
    }
  }
  return planes;
}

/// A different value in [0, 1) everywhere.
DenoiseFrame random_frame(int width = kWidth, int height = kHeight, unsigned seed = 5) {
  DenoiseFrame frame = make_denoise_frame(width, height);
  add_classes(frame);
  CameraDescription camera;
  camera.azimuth_deg = 33;
  camera.elevation_deg = -12;
  frame.camera = compile_camera(camera, Vec3f(0.1f, -20, 3), 150, width, height);
  frame.size_mm = 123.4567f;
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> value(0, 1);
  for (Plane* plane : planes_of(frame)) {
    for (int y = 0; y < height; ++y) {
      // As many samples as both classes have, at least.
      for (int x = 0; x < width; ++x)
        plane->at(x, y) = value(random) + (plane == &frame.samples ? 2.0f : 0.0f);
    }
  }
  return frame;
}

Image image_of(const DenoiseFrame& frame) {
  Image image(frame.width, frame.height);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) image.rgba[4 * i + 3] = 1;
  add_denoise_layers(frame, image);
  image.metadata["voxlume:camera"] = write_camera(frame.camera, {0, 0, 0});
  return image;
}

void expect_equal(DenoiseFrame& found, DenoiseFrame& expected) {
  const std::vector<Plane*> a = planes_of(found), b = planes_of(expected);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) ASSERT_EQ(a[i]->at(x, y), b[i]->at(x, y)) << i << ' ' << x << ' ' << y;
    }
  }
}

void expect_bad(const Image& image, const DenoiserNeeds& needs, const std::string& message) {
  try {
    frame_from_image(image, needs, "f.exr");
    ADD_FAILURE() << "expected: " << message;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFormat);
    EXPECT_EQ(error.where(), "f.exr");
    EXPECT_THAT(error.message(), HasSubstr(message));
    EXPECT_EQ(error.message().find('\n'), std::string::npos);
  }
}

TEST(FrameImage, RoundTripThroughExrIsExact) {
  DenoiseFrame frame = random_frame();
  const test::TemporaryFolder folder;
  write_exr(image_of(frame), folder / "f.exr");
  DenoiseFrame back = frame_from_image(read_image(folder / "f.exr"), kEverything, "f.exr");
  expect_equal(back, frame);
  EXPECT_EQ(back.size_mm, frame.size_mm);
  for (const auto member : {&CameraView::eye_mm, &CameraView::target_mm, &CameraView::right, &CameraView::up,
                            &CameraView::forward}) {
    for (int axis = 0; axis < 3; ++axis) EXPECT_EQ((back.camera.*member)[axis], (frame.camera.*member)[axis]);
  }
  EXPECT_EQ(back.camera.half_width, frame.camera.half_width);
  EXPECT_EQ(back.camera.half_height, frame.camera.half_height);
  EXPECT_EQ(back.camera.width_px, kWidth);
  EXPECT_FALSE(back.camera.orthographic);
}

TEST(FrameImage, ReadsOnlyWhatTheMethodNeeds) {
  Image image = image_of(random_frame());
  std::erase_if(image.layers, [](const ImageLayer& l) {
    return l.name == "normal" || l.name == "albedo" || l.name.starts_with("class");
  });
  const DenoiseFrame frame = frame_from_image(image, {}, "");
  EXPECT_FALSE(frame.classes);
  EXPECT_EQ(frame.normal[0].at(3, 3), 0);
  expect_bad(image, {.normal = true}, "layer \"normal\" is missing; render the picture with --aov denoise");
}

TEST(FrameImage, NamesEveryLayerThatIsMissing) {
  const Image whole = image_of(random_frame());
  ASSERT_EQ(whole.layers.size(), 19u);
  for (const ImageLayer& layer : whole.layers) {
    Image image = whole;
    std::erase_if(image.layers, [&](const ImageLayer& l) { return l.name == layer.name; });
    expect_bad(image, kEverything, "layer \"" + layer.name + "\" is missing; render");
    if (layer.channels.size() < 2) continue;
    image = whole;
    for (ImageLayer& l : image.layers) {
      if (l.name == layer.name) l.channels.back() = "x";
    }
    expect_bad(image, kEverything, "channel \"" + layer.name + "." + layer.channels.back() + "\" is missing");
  }
}

TEST(FrameImage, RefusesMetadataThatMakesNoSense) {
  const Image whole = image_of(random_frame());
  const auto with = [&](const char* name, const std::string& text) {
    Image image = whole;
    image.metadata[name] = text;
    return image;
  };
  const std::string camera = whole.metadata.at("voxlume:camera");
  const auto change = [&](const std::string& from, const std::string& to) {
    std::string text = camera;
    const std::size_t at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return with("voxlume:camera", text.replace(at, from.size(), to));
  };
  for (const char* text : {"", "{", "[]", "null", "\"x\"", "\xff\xfe", "{\"eye_mm\": 1e999}"}) {
    expect_bad(with("voxlume:camera", text), {}, "is no JSON object");
  }
  expect_bad(with("voxlume:camera", std::string(1 << 20, '[')), {}, "is longer than any camera");
  expect_bad(with("voxlume:camera", std::string(1 << 13, '[')), {}, "is no JSON object");
  expect_bad(with("voxlume:camera", "{}"), {}, "lacks eye_mm");
  expect_bad(change("\"eye_mm\":[", "\"eye_mm\":[1,"), {}, "no three numbers for eye_mm");
  expect_bad(change("\"eye_mm\":[", "\"eye_mm\":[1e300, 0, 0], \"x\":["), {},
             "numbers within +-1e9 for eye_mm");
  expect_bad(change("\"up\":[", "\"up\":[1, 1, 0], \"x\":["), {}, "axes that are not orthonormal");
  expect_bad(change("\"half_width\":", "\"half_width\":-1, \"x\":"), {}, "needs a number > 0 for half_width");
  expect_bad(change("\"orthographic\":false", "\"orthographic\":0"), {}, "true or false for orthographic");
  expect_bad(change("\"width_px\":19", "\"width_px\":20"), {}, "20 x 7 pixels; found 19 x 7");
  for (const char* text : {"", "-1", "0", "1e999", "[1]", "nan"}) {
    expect_bad(with("voxlume:size_mm", text), {}, "is no number in (0, 1e9]");
  }
  Image image = whole;
  image.metadata.erase("voxlume:size_mm");
  expect_bad(image, {}, "\"voxlume:size_mm\" is missing; render the picture with --aov denoise");
}

TEST(FrameImage, ValuesThatMakeNoSenseMakeThePixelEmpty) {
  DenoiseFrame exact = random_frame();
  const auto check = [&](const std::string& layer, std::size_t channel, float value) {
    Image image = image_of(exact);
    for (ImageLayer& l : image.layers) {
      if (l.name == layer) l.values[(2 * kWidth + 5) * l.channels.size() + channel] = value;
    }
    DenoiseFrame frame = frame_from_image(image, kEverything, "");
    EXPECT_EQ(frame.alpha.at(5, 2), 0) << layer;
    EXPECT_EQ(frame.radiance[1].at(5, 2), 0) << layer;
    EXPECT_EQ((*frame.classes)[0].count.at(5, 2), 0) << layer;
    if (layer != "background") {
      EXPECT_EQ(frame.background[1].at(5, 2), exact.background[1].at(5, 2));
    }
    for (const Plane* plane : planes_of(frame)) EXPECT_TRUE(std::isfinite(plane->at(5, 2)));
    EXPECT_EQ(frame.alpha.at(6, 2), exact.alpha.at(6, 2));
  };
  for (const ImageLayer& layer : image_of(exact).layers) {
    for (std::size_t c = 0; c < layer.channels.size(); ++c) {
      check(layer.name, c, kNan);
      check(layer.name, c, std::numeric_limits<float>::infinity());
      check(layer.name, c, -1e30f);
    }
  }
  check("matter", 3, -0.1f);
  check("matter_depth", 0, -1);
  check("matter_variance", 0, -1);
  check("class1.count", 0, -1);
  check("class1.count", 0, 4);
  check("class0.fl_diffuse", 1, -1);
  check("class1.fx_specular", 2, 1e10f);
  check("class1.fl_specular", 2, 0.9e17f);
}

TEST(FrameImage, WithoutCameraTheViewStandsStill) {
  Image image = image_of(random_frame());
  image.metadata.clear();
  const DenoiseFrame one = frame_from_image(image, kEverything, "");
  EXPECT_GT(one.size_mm, 0);
  const PixelPosition seen =
      project(one.camera, camera_ray(one.camera, 4.5f, 2.5f, 0, 0).origin +
                              camera_ray(one.camera, 4.5f, 2.5f, 0, 0).direction * 7.0f);
  EXPECT_NEAR(seen.px, 4.5f, 1e-4f);
  EXPECT_NEAR(seen.py, 2.5f, 1e-4f);
}

/// As another program would write it.
Image foreign_image() {
  Image image(4, 3);
  for (std::size_t i = 0; i < 48; ++i) image.rgba[i] = i % 4 == 3 ? 1.0f : 0.01f * static_cast<float>(i);
  return image;
}

TEST(FrameImage, PicturesOfOtherProgramsAreAllMatter) {
  Image image = foreign_image();
  const DenoiseFrame plain = frame_from_image(image, {}, "");
  EXPECT_EQ(plain.radiance[2].at(1, 1), image.pixel(1, 1)[2]);
  EXPECT_EQ(plain.alpha.at(1, 1), 1);
  EXPECT_EQ(plain.background[0].at(1, 1), 0);
  EXPECT_EQ(plain.samples.at(1, 1), 1);
  EXPECT_GT(plain.depth_mm.at(1, 1), 0);
  expect_bad(image, {.normal = true}, "layer \"normal\" is missing; this method needs it");
  expect_bad(image, {.classes = true},
             "layer \"class0.count\" is missing; render the picture with --aov denoise");
  image.layers.push_back({"", {"Z"}, std::vector<float>(12, 40)});
  image.layers.push_back({"albedo", {"B", "R", "G"}, std::vector<float>(36, 0.5f)});
  image.layers.back().values[1] = 0.75f;
  const DenoiseFrame deep = frame_from_image(image, {.albedo = true}, "");
  EXPECT_EQ(deep.depth_mm.at(2, 2), 40);
  EXPECT_EQ(deep.size_mm, 40);
  EXPECT_EQ(deep.albedo[0].at(0, 0), 0.75f);
}

TEST(FrameImage, TheSkyOfOtherProgramsStaysAsItIs) {
  Image image = foreign_image();
  image.layers.push_back({"depth", {"Z"}, std::vector<float>(12, 40)});
  image.layers.back().values[0] = std::numeric_limits<float>::infinity();
  image.pixel(1, 0)[0] = -0.5f;
  const DenoiseFrame frame = frame_from_image(image, {}, "");
  EXPECT_EQ(frame.alpha.at(0, 0), 0);
  EXPECT_EQ(frame.background[2].at(0, 0), image.pixel(0, 0)[2]);
  EXPECT_EQ(frame.radiance[0].at(1, 0), 0);
}

TEST(FileDenoiser, KeepsMetadataButTheDigest) {
  Image image = foreign_image();
  image.metadata["voxlume:frame"] = "3";
  image.metadata["voxlume:digest"] = "x";
  const Image out = FileDenoiser(find_denoiser("wrls")).denoise(image, "");
  EXPECT_EQ(out.metadata,
            (std::map<std::string, std::string>{{"voxlume:frame", "3"}, {"voxlume:denoiser", "wrls"}}));
  EXPECT_TRUE(out.layers.empty());
  EXPECT_EQ(out.pixel(1, 1)[3], 1);
}

TEST(FileDenoiser, ADamagedSceneIsAnErrorWhereItIsNeeded) {
  const test::TemporaryFolder folder;
  Image image = foreign_image();
  image.metadata["voxlume:scene"] = "{\"version\": 1,";
  save_with_own_scene(image, "f.exr", folder / "o.exr");
  try {
    save_with_own_scene(image, "f.exr", folder / "o.png");
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kBadFormat);
    EXPECT_THAT(error.what(), HasSubstr("f.exr: its scene cannot be read: voxlume:scene: line 1"));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "o.png"));
}

/// The checksums of EXR find most damage; what they miss is a picture like another.
TEST(FrameImage, SurvivesDamagedFiles) {
  const test::TemporaryFolder folder;
  write_exr(image_of(random_frame()), folder / "f.exr");
  const std::string bytes = test::read_bytes(folder / "f.exr");
  std::mt19937 random(9);
  int refused = 0;
  for (int i = 0; i < 300; ++i) {
    std::string damaged = bytes;
    if (i % 3 == 0) {
      damaged.resize(random() % bytes.size());
    } else {
      for (int k = 0; k < 4; ++k)
        damaged[random() % (i % 3 == 1 ? 2500 : bytes.size())] ^= 1 << (random() % 8);
    }
    test::write_bytes(folder / "d.exr", damaged);
    try {
      FileDenoiser denoiser(find_denoiser("decoupled"));
      denoiser.denoise(read_image(folder / "d.exr", {.memory_limit_bytes = 64 << 20}), "d.exr");
    } catch (const Error& error) {
      EXPECT_EQ(std::string_view(error.what()).find('\n'), std::string_view::npos);
      ++refused;
    }
  }
  EXPECT_GT(refused, 100);
}

/// A picture whose values are replaced by `value(random)` in a tenth of all places.
template <class Value>
Image damaged_image(std::mt19937& random, const Value& value) {
  Image image = image_of(random_frame());
  for (ImageLayer& layer : image.layers) {
    for (float& v : layer.values) {
      if (random() % 10 == 0) v = value(random);
    }
  }
  CameraDescription camera;
  camera.azimuth_deg = static_cast<double>(random() % 20);
  image.metadata["voxlume:camera"] =
      write_camera(compile_camera(camera, Vec3f(0), 150, kWidth, kHeight), {0, 0, 0});
  return image;
}

void expect_light(const Image& picture) {
  for (const float v : picture.rgba) ASSERT_TRUE(std::isfinite(v) && v >= 0) << v;
}

TEST(FileDenoiser, DamagedValuesNeverSpread) {
  for (const DenoiserKind& kind : denoiser_kinds()) {
    if (kind.name == "oidn") continue;
    SCOPED_TRACE(kind.name);
    std::mt19937 random(3);
    FileDenoiser denoiser(kind);
    for (int i = 0; i < 8; ++i) {  // any bits at all
      expect_light(denoiser.denoise(
          damaged_image(
              random, [](std::mt19937& r) { return std::bit_cast<float>(static_cast<std::uint32_t>(r())); }),
          ""));
    }
    FileDenoiser other(kind);
    for (int i = 0; i < 3; ++i) {
      expect_light(
          other.denoise(damaged_image(random, [](std::mt19937& r) { return r() % 2 ? kNan : -1e30f; }), ""));
    }
  }
}

TEST(FileDenoiser, SequencesRecoverFromDamagedFrames) {
  constexpr int kDamagedX = 40, kDamagedY = 30, kReach = 12, kFrames = 8, kRecovered = 5;
  const auto frame = [](int number) { return image_of(random_frame(80, 60, 100 + number)); };
  for (const DenoiserKind& kind : denoiser_kinds()) {
    if (kind.name == "oidn") continue;
    std::vector<float> values{9e17f, kNan};
    // What may be light is taken for light; svgf and wrls smear it as far as their filters reach.
    if (kind.needs.classes) values.insert(values.end(), {3e15f, 1e9f, 1e4f});
    for (const float value : values) {
      SCOPED_TRACE(std::string(kind.name) + ", " + std::to_string(value));
      FileDenoiser damaged(kind), whole(kind);
      for (int i = 0; i < kFrames; ++i) {
        Image picture = frame(i);
        const Image expected = whole.denoise(frame(i), "");
        for (ImageLayer& layer : picture.layers) {
          if (i != 1 || (!layer.name.starts_with("class") && layer.name != "matter")) continue;
          const std::size_t channels = layer.channels.size();
          for (std::size_t c = 0; c < channels; ++c)
            layer.values[(kDamagedY * 80 + kDamagedX) * channels + c] = value;
        }
        const Image found = damaged.denoise(picture, "");
        expect_light(found);
        // Wide filters reach far in the damaged frame itself.
        for (int y = 0; i >= kRecovered && y < 60; ++y) {
          for (int x = 0; x < 80; ++x) {
            if (std::max(std::abs(x - kDamagedX), std::abs(y - kDamagedY)) <= kReach) continue;
            for (int c = 0; c < 3; ++c)
              ASSERT_NEAR(found.pixel(x, y)[c], expected.pixel(x, y)[c],
                          0.01 * expected.pixel(x, y)[c] + 1e-4)
                  << i << ": " << x << ", " << y;
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace voxlume
