// What hides the important fades: against the closed form, and the same picture where nothing is important.
#include <gtest/gtest.h>

#include "blob_scene.h"
#include "integrator/visibility.h"
#include "same_mean.h"

namespace voxlume::test {
namespace {

ImportanceDescription values(double lower, double upper, double importance = 1) {
  ImportanceDescription out;
  out.importance = importance;
  out.range = {lower, upper};
  return out;
}

SceneDescription hidden_blobs(VisibilityLights lights) {
  SceneDescription scene = blob_scene();
  scene.lights = {area_light(), directional({0, 0, 1}, 1)};
  scene.environment->intensity = 0.4;
  scene.visibility.emplace();
  scene.visibility->important = {values(85, 1000)};
  scene.visibility->lights = lights;
  return scene;
}

struct Compiled {
  Compiled(const SceneDescription& scene, const Volume& volume_)
      : volume(volume_),
        statistics(compute_statistics(make_grid_view(volume))),
        compiled(resolve(as_tested(scene), volume, statistics), volume, statistics) {}
  const SceneView& view() const { return compiled.view(); }
  const Volume volume;
  const VolumeStatistics statistics;
  const CompiledScene compiled;
};

TEST(Visibility, WithoutAnythingImportantIsTheSamePicture) {
  SceneDescription plain = hidden_blobs(VisibilityLights::kAll);
  plain.visibility.reset();
  plain.render.light_sampling = "light";
  SceneDescription nothing = hidden_blobs(VisibilityLights::kAll);
  nothing.visibility->important = {values(5000, 6000), values(85, 1000, 0)};
  const Compiled a(plain, two_blobs()), b(nothing, two_blobs());
  ASSERT_TRUE(b.view().visibility.on);
  TraceCounters counters;
  for (int y = 0; y < 32; ++y)
    EXPECT_EQ(row_luminances(a.view(), 0, 32, y, 4, counters),
              row_luminances(b.view(), 0, 32, y, 4, counters));
}

/// The fraction of the light of a pixel's ray that fading matter takes, by marching eq. 8 densely.
double marched_alpha(const SceneView& scene, int x, int y) {
  std::vector<ImportanceSegment> segments;
  const SegmentListView list = find_importance(scene, x, y, {48, 1}, segments);
  if (!(list.entry < list.exit)) return 0;
  const CameraRay eye =
      camera_ray(scene.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f, 0.5f);
  const IndexRay ray = to_index_ray(scene.medium.grid, eye.origin, eye.direction);
  constexpr int kSteps = 20000;
  const double h_mm = (double{list.exit} - list.entry) / kSteps;
  std::vector<double> mu(kSteps), g(kSteps);
  double total = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto t = static_cast<float>(list.entry + (i + 0.5) * h_mm);
    const Vec3f p = ray.origin_index + ray.direction_index * t;
    mu[i] = extinction_at(scene.medium, p);
    g[i] = importance_at(scene.visibility.importance, p);
    total += g[i] * g[i] * h_mm;
  }
  const VisibilityWeights& w = scene.visibility.weights;
  double before = 0, depth = 0;
  for (int i = 0; i < kSteps; ++i) {
    before += 0.5 * g[i] * g[i] * h_mm;
    const double h = w.r_per_mm * before + w.q_per_mm * (total - before);
    before += 0.5 * g[i] * g[i] * h_mm;
    depth += mu[i] * w.p / (w.p + std::pow(1 - g[i], 2.0 * w.lambda) * h) * h_mm;
  }
  return 1 - std::exp(-depth);
}

TEST(Visibility, CameraRaysMeetWhatTheClosedFormLeaves) {
  for (const double importance : {1.0, 0.75}) {
    SceneDescription scene = hidden_blobs(VisibilityLights::kOff);
    scene.visibility->important = {values(60, 1000, importance)};
    scene.visibility->ray_passes = 64;
    scene.image.filter_radius_px = 1e-3;  // the rays of pixels' centres
    scene.transfer.density_scale = 0.05;
    const Compiled compiled(scene, two_blobs());
    double sum2 = 0;
    int pixels = 0, faded = 0;
    SceneDescription plain = scene;
    plain.visibility.reset();
    for (int y = 10; y < 24; y += 2)
      for (int x = 6; x < 26; x += 2) {
        const double expected = marched_alpha(compiled.view(), x, y);
        if (expected < 0.02 || expected > 0.98) continue;
        constexpr int kSamples = 4000;
        std::vector<PixelSample> samples(kSamples);
        TraceCounters counters;
        trace_tile(compiled.view(), {x, y, x + 1, y + 1}, 0, kSamples, samples, {}, counters);
        double alpha = 0;
        for (const PixelSample& s : samples) alpha += s.alpha / kSamples;
        const double z = (alpha - expected) / std::sqrt(expected * (1 - expected) / kSamples);
        EXPECT_LT(std::abs(z), 4.5) << x << "," << y << ": " << alpha << " against " << expected;
        sum2 += z * z;
        ++pixels;
        faded += compiled.view().visibility.pixels.heads[y * 32 + x].total > 0;
      }
    ASSERT_GT(pixels, 20);
    ASSERT_GT(faded, 5);
    EXPECT_LT(sum2, pixels + 4.5 * std::sqrt(2.0 * pixels));
  }
}

TEST(Visibility, NeverAddsMatter) {
  const Compiled compiled(hidden_blobs(VisibilityLights::kFirst), two_blobs());
  const SceneView& scene = compiled.view();
  std::vector<ImportanceSegment> segments;
  Rng rng(7, 0, 0, 0);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 32; ++x) {
      const SegmentListView list = find_importance(scene, x, y, {48, 4}, segments);
      for (int i = 0; i < 50; ++i) {
        const float t = list.entry + (list.exit - list.entry) * rng.next(), g = rng.next();
        const float kept = visibility_factor(scene.visibility.weights, list, t, g);
        ASSERT_GT(kept, 0);
        ASSERT_LE(kept, 1);
        ASSERT_EQ(visibility_factor(scene.visibility.weights, list, t, 1), 1);
      }
      // h at both ends: what is beyond the entry weighs q, what is before the exit r.
      const VisibilityWeights& w = scene.visibility.weights;
      EXPECT_FLOAT_EQ(visibility_factor(w, list, list.entry, 0), w.p / (w.p + w.q_per_mm * list.total));
      EXPECT_FLOAT_EQ(visibility_factor(w, list, list.exit, 0), w.p / (w.p + w.r_per_mm * list.total));
    }
}

TEST(Visibility, IsTheSameForAnyScale) {
  SceneDescription scene = hidden_blobs(VisibilityLights::kOff);
  const Compiled small(scene, two_blobs());
  Volume large = two_blobs();
  for (int a = 0; a < 3; ++a) {
    large.spacing_mm[a] *= 100;
    large.origin_mm[a] *= 100;
  }
  const Compiled big(scene, large);
  const VisibilityWeights &a = small.view().visibility.weights, &b = big.view().visibility.weights;
  EXPECT_FLOAT_EQ(a.q_per_mm, 100 * b.q_per_mm);
  EXPECT_FLOAT_EQ(a.r_per_mm, 100 * b.r_per_mm);
}

TEST(Visibility, ScalarAndVectorCodeAgree) {
  const SceneDescription scene = hidden_blobs(VisibilityLights::kAll);
  SceneDescription scalar = scene;
  scalar.render.simd = "scalar";
  scalar.render.seed = 5;
  expect_same_mean(estimate(scene, two_blobs(), 60), estimate(scalar, two_blobs(), 60));
}

}  // namespace
}  // namespace voxlume::test
