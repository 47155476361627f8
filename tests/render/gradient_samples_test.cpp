#include "render/gradient_samples.h"

#include <gtest/gtest.h>

#include "denoise/svgf.h"
#include "estimator/test_scene.h"
#include "render/denoise_frame.h"
#include "render/render_loop.h"

namespace voxlume {
namespace {

using test::grey;

constexpr int kWidth = 121, kHeight = 91;  // neither is a multiple of three
constexpr float kSize_mm = 28;

/// A ball of two materials whose rim is translucent, before a bright background.
const Volume& ball() {
  static const Volume volume = test::make_volume({32, 32, 32}, 1.0, [](Vec3d p) {
    const double stripes = 0.12 * std::sin(p.x / 2) * std::sin(p.z / 2);
    return std::clamp((14 - length(p)) / 3, 0.0, 1.0) * (0.85 + stripes);
  });
  return volume;
}

SceneDescription ball_scene() {
  SceneDescription scene;
  scene.environment.emplace();
  scene.environment->intensity = 0;
  scene.background.emplace();
  scene.background->color = grey(5);
  scene.lights = {test::directional({0.5, -0.7, 0.4}, 3)};
  scene.camera.azimuth_deg = 20;
  scene.camera.zoom = 1.8;
  scene.image.width = kWidth;
  scene.image.height = kHeight;
  scene.transfer.reference_length_mm = 1;
  scene.transfer.points = {test::point(0.2, 0, grey(0.3f)), test::point(0.75, 1.5, grey(0.4f)),
                           test::point(0.95, 3, grey(0.9f))};
  return scene;
}

struct Shot {
  Film film;
  DenoiseFrame frame;
};

/// Frames of a sequence, each with the gradients against the one before.
class Sequence {
 public:
  Shot shoot(const SceneDescription& description, int spp = 2) {
    const VolumeStatistics statistics = compute_statistics(make_grid_view(ball()));
    const CompiledScene scene(resolve(description, ball(), statistics), ball(), statistics);
    SceneView view = scene.view();
    view.frame = next_frame_++;
    view.keeps_parts = true;
    Shot shot{Film(view.width, view.height, {.normal = true, .albedo = true, .classes = true}), {}};
    const std::vector<TileRect> tiles = make_tiles(view.width, view.height, 16);
    parallel_for(static_cast<std::int64_t>(tiles.size()), 1, [&](std::int64_t i) {
      TraceCounters counters;
      render_tile(view, tiles[i], 0, spp, shot.film, counters);
    });
    fill_denoise_frame(shot.film, view, kSize_mm, shot.frame);
    sampler_.fill(view, shot.film, shot.frame);
    return shot;
  }

 private:
  GradientSampler sampler_;
  std::uint32_t next_frame_ = 0;
};

bool has_matter(const DenoiseFrame& frame, int column, int row) {
  bool matter = false;
  for (int y = 3 * row; y < std::min(3 * row + 3, frame.height); ++y)
    for (int x = 3 * column; x < std::min(3 * column + 3, frame.width); ++x)
      matter |= frame.alpha.at(x, y) > 0;
  return matter;
}

/// The strata of a frame.
struct Strata {
  int with_matter = 0, valid = 0;
  double mean_difference = 0, mean_square = 0;  ///< of now - before, over valid ones
  double mean_larger = 0;
};

/// Calls visit(now, before) for each that is valid.
template <class Visit>
Strata visit_strata(const DenoiseFrame& frame, const Visit& visit) {
  const GradientSamples& samples = *frame.gradients;
  EXPECT_EQ(samples.valid.width(), (frame.width + 2) / 3);
  EXPECT_EQ(samples.valid.height(), (frame.height + 2) / 3);
  Strata out;
  for (int y = 0; y < samples.valid.height(); ++y) {
    for (int x = 0; x < samples.valid.width(); ++x) {
      out.with_matter += has_matter(frame, x, y);
      if (!(samples.valid.at(x, y) > 0)) continue;
      ++out.valid;
      const double now = samples.now.at(x, y), before = samples.before.at(x, y);
      out.mean_difference += now - before;
      out.mean_square += (now - before) * (now - before);
      out.mean_larger += std::max(now, before);
      visit(now, before);
    }
  }
  for (double* mean : {&out.mean_difference, &out.mean_square, &out.mean_larger}) *mean /= out.valid;
  return out;
}
Strata visit_strata(const DenoiseFrame& frame) {
  return visit_strata(frame, [](double, double) {});
}

void expect_equal_samples(const SceneDescription& scene) {
  Sequence sequence;
  EXPECT_FALSE(sequence.shoot(scene).frame.gradients) << "nothing came before";
  for (int i = 0; i < 2; ++i) {
    const Strata strata =
        visit_strata(sequence.shoot(scene).frame, [](double now, double before) { ASSERT_EQ(now, before); });
    EXPECT_GT(strata.with_matter, 300);
    EXPECT_GT(strata.valid, 0.95 * strata.with_matter);
    EXPECT_GT(strata.mean_larger, 0.05);
  }
}

TEST(GradientSampler, AnUnchangedSceneGivesEqualSamples) {
  expect_equal_samples(ball_scene());
  SceneDescription random = ball_scene();
  random.render.sampler = Sampler::kRandom;
  expect_equal_samples(random);
  SceneDescription lens = ball_scene();
  lens.camera.aperture_radius_mm = 2;
  lens.image.filter = PixelFilter::kBox;
  expect_equal_samples(lens);
  SceneDescription orthographic = ball_scene();
  orthographic.camera.projection = Projection::kOrthographic;
  orthographic.render.simd = "scalar";
  expect_equal_samples(orthographic);
}

TEST(GradientSampler, ALightTwiceAsBrightGivesTwiceTheLight) {
  Sequence sequence;
  SceneDescription scene = ball_scene();
  sequence.shoot(scene);
  (*scene.lights)[0].intensity *= 2;
  const Shot shot = sequence.shoot(scene);
  const Strata strata =
      visit_strata(shot.frame, [](double now, double before) { ASSERT_NEAR(now, 2 * before, 1e-5 * now); });
  EXPECT_GT(strata.valid, 300);
}

TEST(GradientSampler, WhatIsBehindMatterStaysOut) {
  Sequence sequence;
  SceneDescription scene = ball_scene();
  sequence.shoot(scene);
  for (TransferPoint& point : scene.transfer.points) point.mu_t_per_mm = 0;
  const Strata vanished =
      visit_strata(sequence.shoot(scene).frame, [](double now, double) { ASSERT_EQ(now, 0); });
  EXPECT_GT(vanished.valid, 300) << "is a change";
  EXPECT_GT(vanished.mean_larger, 0.05);
  EXPECT_EQ(visit_strata(sequence.shoot(scene).frame).valid, 0) << "without matter there are no samples";
}

/// Mean square of the difference of samples of the same pixels that scattered, in two frames.
double independent_mean_square(const Film& a, const Film& b) {
  double sum = 0;
  int count = 0;
  for (int y = 0; y < a.height(); ++y) {
    for (int x = 0; x < a.width(); ++x) {
      const PixelClasses &one = a.classes(x, y), &other = b.classes(x, y);
      if (!(one.first_depth_mm > 0 && other.first_depth_mm > 0)) continue;
      sum += std::pow(one.first_luminance - other.first_luminance, 2);
      ++count;
    }
  }
  return sum / count;
}

TEST(GradientSampler, SamplesFollowTheirMatterAsTheCameraTurns) {
  for (const double step_deg : {1.0, 3.0}) {
    Sequence sequence;
    SceneDescription scene = ball_scene();
    const Shot first = sequence.shoot(scene);
    const double independent = independent_mean_square(first.film, sequence.shoot(scene).film);
    scene.camera.azimuth_deg += step_deg;
    const Strata strata = visit_strata(sequence.shoot(scene).frame);
    EXPECT_GT(strata.valid, 0.6 * strata.with_matter) << step_deg;
    EXPECT_LT(strata.mean_square, independent / 5) << step_deg;
    EXPECT_LT(std::abs(strata.mean_difference), 0.03 * strata.mean_larger) << step_deg;
  }
}

TEST(GradientSampler, DoesNotDependOnThreads) {
  const auto gradients = [](int threads) {
    const ThreadLimit limit(threads);
    Sequence sequence;
    SceneDescription scene = ball_scene();
    sequence.shoot(scene);
    scene.camera.azimuth_deg += 2;
    return *sequence.shoot(scene).frame.gradients;
  };
  const GradientSamples one = gradients(1), four = gradients(4);
  for (int y = 0; y < one.valid.height(); ++y) {
    for (int x = 0; x < one.valid.width(); ++x) {
      ASSERT_EQ(one.valid.at(x, y), four.valid.at(x, y));
      ASSERT_EQ(one.now.at(x, y), four.now.at(x, y));
      ASSERT_EQ(one.before.at(x, y), four.before.at(x, y));
    }
  }
}

TEST(GradientSampler, BeginsAnewWithAnotherSize) {
  Sequence sequence;
  SceneDescription scene = ball_scene();
  sequence.shoot(scene);
  scene.image.width -= 3;
  EXPECT_FALSE(sequence.shoot(scene).frame.gradients);
  EXPECT_TRUE(sequence.shoot(scene).frame.gradients);
}

double sum_of(const Planes3& planes) {
  double sum = 0;
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) sum += planes[0].at(x, y);
  return sum;
}

/// Rendered frames until nine tenths of a step of brightness are seen.
int frames_to_follow(Denoiser& denoiser) {
  Sequence sequence;
  SceneDescription scene = ball_scene();
  DenoisedFrame out;
  for (int i = 0; i < 6; ++i) denoiser.denoise(sequence.shoot(scene).frame, out);
  const double before = sum_of(out.radiance), step = 3 * before;
  (*scene.lights)[0].intensity *= 4;
  for (int n = 1; n < 20; ++n) {
    denoiser.denoise(sequence.shoot(scene).frame, out);
    if (sum_of(out.radiance) - before > 0.9 * step) return n;
  }
  return 20;
}

TEST(GradientSampler, AsvgfFollowsALightSoonerThanSvgf) {
  EXPECT_GE(frames_to_follow(*make_svgf()), 10) << "0.8^n < 0.1 takes eleven";
  EXPECT_LE(frames_to_follow(*make_asvgf()), 5) << "0.25 * 0.8^n < 0.1: three quarters are forgotten at once";
}

}  // namespace
}  // namespace voxlume
