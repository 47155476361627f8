#include "light/environment.h"

#include <gtest/gtest.h>

#include <numeric>

#include "light/light_scenes.h"
#include "sampling/rng.h"
#include "support/chi_square.h"
#include "support/moments.h"
#include "support/random_direction.h"

namespace voxlume {
namespace {

using test::compile;

/// Column and row whose texel is seen along a direction of the unrotated environment, in double precision.
Vec3d seen_in_sky(const EnvironmentImage& image, Vec3d d) {
  const double u = 0.5 + std::atan2(d.x, d.y) / (2 * std::numbers::pi);
  const double v = std::atan2(std::hypot(d.x, d.y), d.z) / std::numbers::pi;
  const int column = std::min(image.width - 1, static_cast<int>(u * image.width));
  const int row = std::min(image.height - 1, static_cast<int>(v * image.height));
  const auto i = static_cast<std::size_t>(3 * (row * image.width + column));
  return {image.rgb[i], image.rgb[i + 1], image.rgb[i + 2]};
}

Lights sky_lights(double rotation_deg = 0) {
  const EnvironmentImage image = test::sky();
  EnvironmentDescription description;
  description.rotation_deg = rotation_deg;
  return compile({}, description, &image);
}

void expect_samples_fit(const Lights& lights, Vec3f axis, double width, int tests) {
  const LightsView view = lights.view();
  Rng rng(1, 0, 0, 0);
  const auto draw = [&] {
    const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
    const LightSample s = sample_light(view, Vec3f(0.0f), u_pick, u0, u1);
    return test::DirectionDraw{s.wi, s.pdf};
  };
  const double total = test::expect_directions_fit(
      test::SphereBins(axis, width), draw, [&](Vec3f d) { return environment_hit(view, Vec3f(0), d).pdf; },
      tests);
  EXPECT_NEAR(total, 1.0, 5e-4);
}

TEST(Environment, ConstantSamplesFit) { expect_samples_fit(compile({}, {}), Vec3f(0, 0, 1), 2, 4); }
TEST(Environment, PictureSamplesFitAboutTheZenith) {
  expect_samples_fit(sky_lights(), Vec3f(0, 0, 1), 0.2, 4);
}
TEST(Environment, PictureSamplesFitAboutTheNadir) {
  expect_samples_fit(sky_lights(33), Vec3f(0, 0, -1), 0.2, 4);
}

TEST(Environment, PictureSamplesFitAboutItsSun) {
  const double u = (21.5 / 32 - 0.5) * 2 * std::numbers::pi, v = 4.5 / 16 * std::numbers::pi;
  const Vec3d sun(std::sin(u) * std::sin(v), std::cos(u) * std::sin(v), std::cos(v));
  expect_samples_fit(sky_lights(), Vec3f(sun), 0.2, 4);
}

TEST(Environment, LooksTheDocumentedWay) {
  EnvironmentImage image{8, 4, std::vector<float>(3 * 8 * 4)};
  for (std::size_t i = 0; i < 8 * 4; ++i) image.rgb[3 * i] = static_cast<float>(i);  // red names the texel
  const auto texel = [&](const EnvironmentDescription& d, const ViewFrame& camera, Vec3f direction) {
    const Lights lights({}, d, &image, camera, SceneSphere{});
    return static_cast<int>(environment_hit(lights.view(), Vec3f(0), normalize(direction)).radiance.x);
  };
  EnvironmentDescription d;
  const ViewFrame front;
  const float e = 1e-3f;
  EXPECT_EQ(texel(d, front, {e, 1, e}), 1 * 8 + 4);    // just right of and above the centre
  EXPECT_EQ(texel(d, front, {-e, 1, -e}), 2 * 8 + 3);  // just left of and below it
  EXPECT_EQ(texel(d, front, {1, e, e}), 1 * 8 + 5);    // +x: u just below 0.75
  EXPECT_EQ(texel(d, front, {-1, e, e}), 1 * 8 + 2);   // -x: u just above 0.25
  EXPECT_EQ(texel(d, front, {e, -1, e}), 1 * 8 + 7);   // the seam is at -y
  EXPECT_EQ(texel(d, front, {e, e, 1}) / 8, 0);        // the top is +z
  // A quarter turn carries what was at +y to -x, and what was at -y to +x.
  d.rotation_deg = 90;
  EXPECT_EQ(texel(d, front, {-1, e, e}), 1 * 8 + 4);
  EXPECT_EQ(texel(d, front, {1, e, e}), 1 * 8 + 7);
  EXPECT_EQ(texel(d, front, {1, -e, e}), 1 * 8 + 0);
  // Attached to a camera that looks along -x from the left, head up: its centre is ahead.
  d.rotation_deg = 0;
  d.attached_to = Attachment::kCamera;
  const ViewFrame left{{0, 1, 0}, {0, 0, 1}, {1, 0, 0}, {5, 5, 5}};
  EXPECT_EQ(texel(d, left, {-1, e, e}), 1 * 8 + 4);
  EXPECT_EQ(texel(d, left, {-1, -e, e}), 1 * 8 + 3);
  EXPECT_EQ(texel(d, front, {e, 1, e}), 1 * 8 + 4);
}

TEST(Environment, HitIsTheTexelScaled) {
  const EnvironmentImage image = test::sky();
  EnvironmentDescription d;
  d.color.linear = {1.0f, 0.5f, 0.25f};
  d.intensity = 3;
  const Lights lights = compile({}, d, &image);
  Rng rng(2, 0, 0, 0);
  int differing = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3f direction = test::random_direction(rng);
    const Vec3d seen = seen_in_sky(image, Vec3d(direction));
    const Vec3f hit = environment_hit(lights.view(), Vec3f(0), direction).radiance;
    differing += std::abs(double{hit.x} - 3 * seen.x) > 1e-5 * seen.x ||
                 std::abs(double{hit.y} - 1.5 * seen.y) > 1e-5 * seen.y;
  }
  EXPECT_LE(differing, 2);  // directions on a texel's border
}

/// Another colour, intensity or way to sample makes of a picture in hand what it makes of one given anew.
TEST(Environment, AnUpdateKeepsThePictureAlone) {
  const EnvironmentImage image = test::sky();
  EnvironmentDescription d;
  Lights updated = compile({}, d, &image);
  const Vec3f* const texels = updated.view().environment.texels;
  Rng rng(8, 0, 0, 0);
  for (const auto samples :
       {EnvironmentSamples::kWhole, EnvironmentSamples::kExcess, EnvironmentSamples::kUniform})
    for (const double intensity : {2.0, 0.0, 0.3}) {
      d.intensity = intensity;
      d.color.linear[1] = 0.5f;
      updated.update({}, d, ViewFrame{}, SceneSphere{{0, 0, 0}, 100}, samples);
      const Lights anew = compile({}, d, &image, samples);
      EXPECT_EQ(updated.view().environment_mean, anew.view().environment_mean);
      EXPECT_EQ(updated.view().has_environment, intensity > 0);
      for (int i = 0; i < 100; ++i) {
        const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
        const LightSample a = sample_light(updated.view(), Vec3f(0.0f), u_pick, u0, u1);
        const LightSample b = sample_light(anew.view(), Vec3f(0.0f), u_pick, u0, u1);
        EXPECT_EQ(a.pdf, b.pdf);
        if (b.pdf > 0) {
          EXPECT_EQ(a.radiance, b.radiance);
        }
      }
    }
  EXPECT_EQ(updated.view().environment.texels, texels);
}

TEST(Environment, SampleAgreesWithHit) {
  const Lights lights = sky_lights(-71);
  const LightsView view = lights.view();
  Rng rng(3, 0, 0, 0);
  int differing = 0;
  for (int i = 0; i < 100000; ++i) {
    const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
    const LightSample s = sample_light(view, Vec3f(0.0f), u_pick, u0, u1);
    ASSERT_GT(s.pdf, 0.0f);
    ASSERT_TRUE(std::isinf(s.distance_mm) && !s.delta);
    const LightHit hit = environment_hit(view, Vec3f(0), s.wi);
    differing += hit.pdf != s.pdf || hit.radiance != s.radiance;
  }
  EXPECT_LE(differing, 20);  // rounded across a texel's border
}

/// radiance / pdf is the same for grey texels wherever they are: the density follows the radiance exactly.
TEST(Environment, DensityFollowsTheRadiance) {
  EnvironmentImage image = test::sky();
  for (std::size_t i = 0; i < image.rgb.size(); i += 3) image.rgb[i + 1] = image.rgb[i + 2] = image.rgb[i];
  const Lights lights = compile({}, {}, &image);
  const double expected = 4 * std::numbers::pi * luminance(Vec3d(lights.view().environment_mean));
  Rng rng(4, 0, 0, 0);
  for (int i = 0; i < 10000; ++i) {
    const float u0 = rng.next(), u1 = rng.next();
    const LightSample s = sample_light(lights.view(), Vec3f(0.0f), 0.5f, u0, u1);
    EXPECT_NEAR(double{s.radiance.x / s.pdf}, expected, expected * 1e-3);
  }
}

/// Light samples go to what is brighter than the mean, in proportion to by how much.
TEST(Environment, ExcessIsWhatIsSampled) {
  const EnvironmentImage image = test::sky();
  const Lights lights = compile({}, {}, &image, EnvironmentSamples::kExcess);
  expect_samples_fit(lights, Vec3f(0, 0, 1), 0.2, 4);
  const Lights whole = compile({}, {}, &image);
  EXPECT_EQ(lights.view().environment_mean, whole.view().environment_mean);
  const double mean = luminance(Vec3d(lights.view().environment_mean));
  Rng rng(6, 0, 0, 0);
  double ratio = 0;
  int dim = 0;
  for (int i = 0; i < 10000; ++i) {
    const float u0 = rng.next(), u1 = rng.next();
    const LightHit hit = environment_hit(lights.view(), Vec3f(0), uniform_sphere(u0, u1));
    const double excess = luminance(Vec3d(hit.radiance)) - mean;
    if (excess <= 0) {
      EXPECT_EQ(hit.pdf, 0.0f);
      ++dim;
    } else {
      if (ratio == 0) ratio = hit.pdf / excess;
      EXPECT_NEAR(hit.pdf / excess, ratio, 1e-3 * ratio);
    }
  }
  EXPECT_GT(dim, 1000);
  EXPECT_GT(ratio, 0);
}

TEST(Environment, ConstantHasNoExcess) {
  const Lights alone = compile({}, {}, nullptr, EnvironmentSamples::kExcess);
  EXPECT_EQ(sample_light(alone.view(), Vec3f(0.0f), 0.5f, 0.5f, 0.5f).pdf, 0.0f);
  EXPECT_EQ(environment_hit(alone.view(), Vec3f(0), Vec3f(0, 0, 1)).pdf, 0.0f);
  EXPECT_EQ(environment_hit(alone.view(), Vec3f(0), Vec3f(0, 0, 1)).radiance, Vec3f(1.0f));
  const Lights beside = compile({test::directional({0, 0, 1}, 1)}, {}, nullptr, EnvironmentSamples::kExcess);
  EXPECT_EQ(bin_probability(beside.view().pick, 0), 1.0f);
  EXPECT_EQ(environment_hit(beside.view(), Vec3f(0), Vec3f(0, 0, 1)).pdf, 0.0f);
}

TEST(Environment, IrradianceOfThePicture) {
  const EnvironmentImage image = test::sky();
  const Lights lights = sky_lights();
  for (Vec3f n :
       {Vec3f(0, 0, 1), Vec3f(0, 0, -1), normalize(Vec3f(1, 2, 0.5f)), normalize(Vec3f(-3, 1, -1))}) {
    double expected = 0;
    constexpr int kRows = 16 * 64, kColumns = 32 * 32;
    for (int row = 0; row < kRows; ++row)
      for (int column = 0; column < kColumns; ++column) {
        const double theta = std::numbers::pi * (row + 0.5) / kRows;
        const double a = 2 * std::numbers::pi * ((column + 0.5) / kColumns - 0.5);
        const Vec3d d(std::sin(a) * std::sin(theta), std::cos(a) * std::sin(theta), std::cos(theta));
        const double cosine = dot(d, Vec3d(n));
        if (cosine > 0) expected += seen_in_sky(image, d).y * cosine * std::sin(theta);
      }
    expected *= 2 * std::numbers::pi * std::numbers::pi / kRows / kColumns;
    Rng rng(5, 0, 0, 0);
    test::Moments mean;
    for (int i = 0; i < 1 << 18; ++i) {
      const float u_pick = rng.next(), u0 = rng.next(), u1 = rng.next();
      const LightSample s = sample_light(lights.view(), Vec3f(0.0f), u_pick, u0, u1);
      mean.add(double{s.radiance.y} * std::max(0.0f, dot(s.wi, n)) / s.pdf);
    }
    EXPECT_LT(std::abs(mean.z(expected, 1e-4 * expected)), 4) << expected;
  }
}

TEST(Environment, MeanRadiance) {
  EnvironmentDescription d;
  d.color.linear = {0.5f, 1.0f, 0.0f};
  d.intensity = 2;
  EXPECT_EQ(compile({}, d).view().environment_mean, Vec3f(1, 2, 0));
  EnvironmentImage image{4, 2, std::vector<float>(24, 0.0f)};
  image.rgb[0] = 8.0f;  // one texel of eight equal ones
  EXPECT_NEAR(compile({}, {}, &image).view().environment_mean.x, 1.0f, 1e-6f);
}

TEST(Environment, BlackIsNone) {
  const EnvironmentImage black{4, 2, std::vector<float>(24, 0.0f)};
  for (const EnvironmentImage* image : {static_cast<const EnvironmentImage*>(nullptr), &black}) {
    const Lights lights = compile({}, image ? EnvironmentDescription{} : test::no_environment(), image);
    EXPECT_EQ(sample_light(lights.view(), Vec3f(0.0f), 0.5f, 0.5f, 0.5f).pdf, 0.0f);
    EXPECT_EQ(environment_hit(lights.view(), Vec3f(0), Vec3f(0, 0, 1)).radiance, Vec3f(0.0f));
    EXPECT_EQ(environment_hit(lights.view(), Vec3f(0), Vec3f(0, 0, 1)).pdf, 0.0f);
  }
}

TEST(Environment, EdgesAreFinite) {
  const EnvironmentImage large{2048, 1024, std::vector<float>(3 * 2048 * 1024, 1.0f)};
  const Lights lights = compile({}, {}, &large);
  // A polar row has the probability 2.35e-6, 39 steps of the random numbers' 2^-24.
  constexpr float kRounding = 0.02f * kUniformSpherePdf;
  for (float u0 : test::kEdgeNumbers)
    for (float u1 : test::kEdgeNumbers) {
      const LightSample s = sample_light(lights.view(), Vec3f(0.0f), 0.0f, u0, u1);
      EXPECT_NEAR(length(s.wi), 1.0f, 1e-6f);
      EXPECT_NEAR(s.pdf, kUniformSpherePdf, kRounding);
    }
  for (Vec3f d : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(0, -1, 0), Vec3f(-0.0f, -1, 0), Vec3f(1, 0, 0)})
    EXPECT_NEAR(environment_hit(lights.view(), Vec3f(0), d).pdf, kUniformSpherePdf, kRounding);
}

}  // namespace
}  // namespace voxlume
