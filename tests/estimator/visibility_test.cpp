// What hides the important fades: against the closed form, and the same picture where nothing is important.
#include <gtest/gtest.h>

#include "blob_scene.h"
#include "compiled_scene.h"
#include "integrator/visibility.h"
#include "marched_alpha.h"
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

bool same(const SegmentListView& a, const SegmentListView& b) {
  const auto equal = [](const ImportanceSegment& s, const ImportanceSegment& t) {
    return s.t == t.t && s.length == t.length && s.k == t.k && s.integral == t.integral;
  };
  return a.entry == b.entry && a.exit == b.exit && a.total == b.total &&
         (!(a.total > 0) ||
          std::equal(a.segments, a.segments + a.count, b.segments, b.segments + b.count, equal));
}

/// Cells that tell of importance without a look-up change no list, of whichever importances.
TEST(Visibility, ListsAreTheSameWithoutCells) {
  Volume small = two_blobs();
  SceneDescription scenes[3];
  for (SceneDescription& scene : scenes) scene = hidden_blobs(VisibilityLights::kFirst);
  scenes[1].visibility->important = {values(40, 60, 0.5), values(85, 1000)};
  scenes[1].visibility->important[1].center_mm = Double3{-7, 2, 3};
  scenes[1].visibility->important[1].radius_mm = 5;
  scenes[2].visibility->lookup = ImportanceLookup::kPerVoxel;
  for (const SceneDescription& description : scenes) {
    const Compiled compiled(description, small);
    const SceneView& scene = compiled.view();
    SceneView plain = scene;
    plain.visibility.importance.cells = {};
    const PixelLists lists(scene, {48, 8}), looked_up(plain, {48, 8});
    std::vector<ImportanceSegment> segments, others;
    const auto list_of = [](const PixelLists& from, std::size_t pixel) {
      const PixelListsView::Head& head = from.view().heads[pixel];
      return SegmentListView{from.view().pool + head.first, head.count, head.entry, head.exit, head.total};
    };
    int important = 0;
    for (std::size_t pixel = 0; pixel < 32 * 32; ++pixel) {
      ASSERT_TRUE(same(list_of(lists, pixel), list_of(looked_up, pixel))) << pixel;
      important += list_of(lists, pixel).total > 0;
    }
    EXPECT_GT(important, 10);
    EXPECT_LT(important, 1000);
    Rng rng(3, 0, 0, 0);
    for (int n = 0; n < 2000; ++n) {
      const Vec3f from = Vec3f(rng.next(), rng.next(), rng.next()) * 31;
      const Vec3f to = normalize(Vec3f(rng.next(), rng.next(), rng.next()) - Vec3f(0.5f));
      const Vec3f world = scene.medium.grid.world_from_index.point(from);
      const TrackRay ray =
          visible_part(scene, to_index_ray(scene.medium.grid, world, to), world, to, 1e30f, false);
      ASSERT_TRUE(same(find_light_importance(scene, ray, rng, segments),
                       find_light_importance(plain, ray, rng, others)));
    }
  }
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

/// Importance interpolated between voxels is no step function; its lists stay short and know its integral.
TEST(Visibility, ListsOfVoxelsAreShortAndKnowTheIntegral) {
  for (const ImportanceLookup lookup : {ImportanceLookup::kPerVoxel, ImportanceLookup::kSmoothed}) {
    SceneDescription description = hidden_blobs(VisibilityLights::kOff);
    description.visibility->important = {values(30, 1000, 0.7), values(70, 1000)};
    description.visibility->lookup = lookup;
    const Compiled compiled(description, two_blobs());
    const SceneView& scene = compiled.view();
    std::vector<ImportanceSegment> segments;
    double sum = 0, expected_sum = 0, worst = 0;
    for (int y = 0; y < 32; ++y)
      for (int x = 0; x < 32; ++x) {
        const SegmentListView list = find_importance(scene, x, y, {48, 16}, segments);
        if (!(list.total > 0)) continue;
        EXPECT_LT(list.count, 150);
        const CameraRay eye =
            camera_ray(scene.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f, 0.5f);
        const IndexRay ray = to_index_ray(scene.medium.grid, eye.origin, eye.direction);
        constexpr int kSteps = 4000;
        const double h_mm = (double{list.exit} - list.entry) / kSteps;
        double expected = 0;
        for (int i = 0; i < kSteps; ++i) {
          const Vec3f p =
              ray.origin_index + ray.direction_index * static_cast<float>(list.entry + (i + 0.5) * h_mm);
          const double g = importance_at(scene.visibility.importance, p);
          expected += g * g * h_mm;
        }
        sum += list.total;
        expected_sum += expected;
        worst = std::max(worst, std::abs(list.total - expected));
      }
    EXPECT_GT(expected_sum, 100);
    EXPECT_NEAR(sum / expected_sum, 1, 0.01);
    EXPECT_LT(worst, 0.3);  // mm, a fifth of a voxel
  }
}

/// Lists are built again for what they depend on alone.
TEST(Visibility, ListsAreKeptWhereNothingMoves) {
  const SceneDescription first = as_tested(hidden_blobs(VisibilityLights::kOff));
  const Volume volume = two_blobs();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  CompiledScene compiled(resolve(first, volume, statistics), volume, statistics);
  EXPECT_GT(compiled.importance_list_s(), 0);
  EXPECT_GE(compiled.importance_list_bytes(), 32u * 32 * sizeof(PixelListsView::Head));
  const auto rebuilt = [&](const SceneDescription& scene) {
    int told = 0;
    compiled.update(resolve(scene, volume, statistics), [&](double share) {
      ++told;
      EXPECT_GT(share, 0);
      EXPECT_LE(share, 1);
    });
    EXPECT_EQ(told > 0, compiled.importance_list_s() > 0);
    return told > 0;
  };
  SceneDescription scene = first;
  EXPECT_FALSE(rebuilt(scene));
  scene.visibility->q = 10;
  scene.visibility->lights = VisibilityLights::kAll;
  scene.transfer.density_scale = 2;
  scene.environment->intensity = 3;
  EXPECT_FALSE(rebuilt(scene));
  scene.camera.azimuth_deg = 21;
  EXPECT_TRUE(rebuilt(scene));
  scene.visibility->important[0].range = {80, 1000};
  EXPECT_TRUE(rebuilt(scene));
  scene.visibility->lookup = ImportanceLookup::kSmoothed;
  EXPECT_TRUE(rebuilt(scene));
  EXPECT_FALSE(rebuilt(scene));
  scene.visibility->important.clear();
  EXPECT_FALSE(rebuilt(scene));
  EXPECT_EQ(compiled.importance_list_bytes(), 0u);
  EXPECT_TRUE(rebuilt(first));
}

/// Lists that are ended half way leave a scene that can be updated, to itself and to any other.
TEST(Visibility, ListsCanBeEnded) {
  struct Ended {};
  SceneDescription scene = as_tested(hidden_blobs(VisibilityLights::kOff));
  scene.image.width = scene.image.height = 192;
  const Volume volume = two_blobs();
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const auto resolved = [&](const SceneDescription& s) { return resolve(s, volume, statistics); };
  SceneDescription turned = scene;
  turned.camera.azimuth_deg = 40;
  turned.transfer.density_scale = 3;
  CompiledScene compiled(resolved(scene), volume, statistics);
  for (const SceneDescription& next : {turned, scene}) {
    EXPECT_THROW(compiled.update(resolved(turned), [](double) { throw Ended(); }), Ended);
    EXPECT_EQ(compiled.importance_list_bytes(), 0u);
    compiled.update(resolved(next));
    const CompiledScene fresh(resolved(next), volume, statistics);
    for (int y = 0; y < 192; y += 19)
      for (int x = 0; x < 192; x += 17) {
        TraceCounters counters;
        const PixelSample a = trace_camera_sample(compiled.view(), x, y, 0, counters);
        const PixelSample b = trace_camera_sample(fresh.view(), x, y, 0, counters);
        EXPECT_EQ(a.radiance.x, b.radiance.x);
        EXPECT_EQ(a.alpha, b.alpha);
      }
    compiled.update(resolved(scene));
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
