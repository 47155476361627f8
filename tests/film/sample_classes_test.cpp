#include <gtest/gtest.h>

#include <limits>

#include "film/film.h"

namespace voxlume {
namespace {

PixelSample hit(float radiance, float depth_mm) {
  PixelSample sample;
  sample.radiance = Vec3f(radiance);
  sample.alpha = 1;
  sample.depth_mm = depth_mm;
  return sample;
}

RadianceParts parts(float fx, float direct, bool dense = false) {
  RadianceParts p;
  p.fx_diffuse = Vec3f(fx);
  p.direct_diffuse = Vec3f(direct);
  p.later = Vec3f(0.25f);
  p.dense = dense;
  return p;
}

class Classes : public testing::Test {
 protected:
  void add(std::vector<PixelSample> samples, std::vector<RadianceParts> with) {
    film_.add_classes(0, 0, samples, with);
  }
  void add_fx(const std::vector<float>& fx) {
    std::vector<PixelSample> samples;
    std::vector<RadianceParts> with;
    for (const float value : fx) samples.push_back(hit(1, 10)), with.push_back(parts(value, 2));
    add(samples, with);
  }
  const PixelClasses& pixel() const { return film_.classes(0, 0); }
  Film film_{1, 1, {.classes = true}};
};

TEST_F(Classes, DivideAtTheLargestGap) {
  add_fx({0.50f, 0.12f, 0.95f, 0.10f, 0.60f});
  EXPECT_EQ(pixel().classes[0].count, 2u) << "0.12 to 0.50 is the largest";
  EXPECT_EQ(pixel().classes[1].count, 3u);
}

TEST_F(Classes, AreOneWhereSamplesAreAlike) {
  add_fx({0.50f, 0.52f, 0.45f, 0.54f});
  EXPECT_EQ(pixel().classes[0].count, 4u);
  EXPECT_EQ(pixel().classes[1].count, 0u);
}

TEST_F(Classes, TakeLaterSamplesByTheNearerMean) {
  add_fx({0.5f});
  EXPECT_EQ(pixel().classes[0].count, 1u);
  add_fx({0.55f});
  EXPECT_EQ(pixel().classes[0].count, 2u);
  add_fx({0.9f, 0.1f, 0.85f});  // opens the second; the first is nearer; the second
  EXPECT_EQ(pixel().classes[0].count, 3u);
  EXPECT_EQ(pixel().classes[1].count, 2u);
  EXPECT_NEAR(pixel().classes[1].fx_diffuse.x, 1.75f, 1e-6f);
}

TEST_F(Classes, KeepSumsOfEverything) {
  add({hit(1, 30), PixelSample{}, hit(3, 20), hit(2, 40)},
      {parts(0.2f, 2, true), {}, parts(0.8f, 5), parts(0.21f, 4, true)});
  EXPECT_EQ(pixel().radiance, Vec3d(6));
  EXPECT_NEAR(pixel().luminance_squared, 14, 1e-5);
  EXPECT_EQ(pixel().classes[0].count, 2u);
  EXPECT_FLOAT_EQ(pixel().classes[0].direct_diffuse.y, 6);
  EXPECT_FLOAT_EQ(pixel().classes[0].later.z, 0.5f);
  EXPECT_FLOAT_EQ(pixel().classes[1].direct_diffuse.y, 5);
  EXPECT_EQ(pixel().dense_depth_mm, 30) << "the least that is dense";
  EXPECT_EQ(pixel().median_depth_mm, 30);
}

TEST_F(Classes, LeaveOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  add({hit(nan, 10), hit(1, infinity), hit(1, 10), hit(1, 10)},
      {parts(0.2f, 1), parts(0.2f, 1), parts(0.2f, infinity), parts(0.2f, 1)});
  EXPECT_EQ(pixel().classes[0].count, 1u);
  EXPECT_EQ(pixel().radiance, Vec3d(1));
}

TEST_F(Classes, OfSamplesAddedTogetherDoNotDependOnTheirNumber) {
  // 100 samples, far more than are usual in one frame.
  std::vector<float> fx;
  for (int i = 0; i < 100; ++i) fx.push_back((i % 2 ? 0.7f : 0.2f) + 0.0005f * static_cast<float>(i));
  add_fx(fx);
  EXPECT_EQ(pixel().classes[0].count, 50u);
  EXPECT_EQ(pixel().classes[1].count, 50u);
}

TEST_F(Classes, KeepWhatTheFirstSampleOfThePixelMet) {
  film_.add(0, 0, hit(2, 30));
  film_.add(0, 0, hit(5, 20));
  EXPECT_FLOAT_EQ(pixel().first_luminance, 2);
  EXPECT_EQ(pixel().first_depth_mm, 30);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (const PixelSample& nothing : {PixelSample{.radiance = Vec3f(3)}, hit(nan, 30), hit(2, nan)}) {
    Film film(1, 1, {.classes = true});
    film.add(0, 0, nothing);
    film.add(0, 0, hit(5, 20));
    EXPECT_EQ(film.classes(0, 0).first_luminance, 0);
    EXPECT_EQ(film.classes(0, 0).first_depth_mm, 0);
  }
}

}  // namespace
}  // namespace voxlume
