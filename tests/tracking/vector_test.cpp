#include <gtest/gtest.h>

#include "accel/hierarchy.h"
#include "support/random_direction.h"
#include "support/random_rules.h"
#include "support/transfers.h"
#include "support/volumes.h"
#include "tracking/lanes.h"

namespace voxlume {
namespace {

using test::make_volume;
using test::mu_t_function;

/// A medium over a hierarchy; everything it points to.
struct HierarchyMedium {
  HierarchyMedium(Volume volume_, const TransferDescription& description, int cell_voxels,
                  HierarchyCosts costs = {})
      : volume(std::move(volume_)),
        function(description),
        hierarchy(make_grid_view(volume), cell_voxels, costs) {
    hierarchy.update(function);
    medium = {make_grid_view(volume), function.view(), hierarchy.view()};
  }
  HierarchyMedium(const HierarchyMedium&) = delete;

  Volume volume;
  TransferFunction function;
  MajorantHierarchy hierarchy;
  Medium medium;
};

struct Task {
  TrackRay track;
  bool shadow;
  Rng rng;
};

struct Outcome {
  Collision collision;
  float transmittance = 1;
  std::uint64_t steps = 0, violations = 0;
  std::array<std::uint32_t, 4> rng;
};

Outcome track_scalar(const Medium& medium, Task task) {
  Outcome out;
  TrackingCounters counters;
  if (task.shadow)
    out.transmittance = estimate_transmittance(medium, task.track, task.rng, counters);
  else
    out.collision = sample_free_flight(medium, task.track, task.rng, counters);
  out.steps = counters.steps;
  out.violations = counters.majorant_violations;
  out.rng = task.rng.state();
  return out;
}

std::vector<Outcome> track_lanes(const Medium& medium, VectorTracker tracker,
                                 const std::vector<Task>& tasks) {
  std::vector<Outcome> out(tasks.size());
  Lanes lanes;
  std::size_t next = 0, finished = 0;
  std::array<std::size_t, Lanes::kCount> task_of{};
  const auto refill = [&](int lane) {
    lanes.state[lane] = Lanes::kIdle;
    if (next == tasks.size()) return;
    lanes.put(lane, tasks[next].track, tasks[next].shadow, tasks[next].rng);
    task_of[lane] = next++;
  };
  for (int lane = 0; lane < Lanes::kCount; ++lane) refill(lane);
  while (finished < tasks.size()) {
    tracker(medium, lanes);
    for (int lane = 0; lane < Lanes::kCount; ++lane) {
      if (lanes.state[lane] != Lanes::kDone) continue;
      const Task& task = tasks[task_of[lane]];
      Outcome& o = out[task_of[lane]];
      if (task.shadow)
        o.transmittance = lanes.transmittance[lane];
      else
        o.collision = lanes.collision(lane, task.track.t_near);
      o.steps = lanes.steps[lane];
      o.violations = lanes.violations[lane];
      o.rng = lanes.stream(lane).state();
      ++finished;
      refill(lane);
    }
  }
  return out;
}

/// Rays from inside and outside, along axes, faces and edges, and into every direction.
std::vector<Task> make_tasks(const Medium& medium, int count, std::uint64_t seed) {
  std::vector<Task> tasks;
  Rng rng(seed, 0, 0, 0);
  const Box3f box = medium.grid.index_box();
  for (std::uint32_t n = 0; tasks.size() < static_cast<std::size_t>(count); ++n) {
    const Vec3f target = box.lower + box.extent() * Vec3f(rng.next(), rng.next(), rng.next());
    IndexRay ray{target, test::random_direction(rng) * (0.2f + rng.next())};
    if (n % 3 == 0) ray.direction_index[n / 3 % 3] = n % 2 ? 0.0f : -0.0f;
    if (n % 7 == 0) ray.direction_index[n / 7 % 3] *= 1e-7f;
    if (n % 5 == 0) ray.origin_index[n / 5 % 3] = std::floor(ray.origin_index[n / 5 % 3]);
    if (n % 2) ray.origin_index = ray.origin_index - ray.direction_index * (100 * rng.next());
    Interval<float> run = clip_ray(box, ray.origin_index, ray.direction_index, 0.0f, 1e30f);
    if (n % 4 == 0) run.t_far = run.t_near + (run.t_far - run.t_near) * rng.next();
    if (run.empty()) continue;
    TrackRay track{ray, run.t_near, run.t_far};
    track.fine = n % 6 < 2;
    if (n % 9 == 0) track.u_collision = rng.next();
    if (n % 4 == 0) track.u_depth = rng.next();
    tasks.push_back({track, n % 8 < 4, Rng(seed, 1, 0, n)});
  }
  return tasks;
}

class VectorTracking : public testing::TestWithParam<SimdTarget> {
 protected:
  void expect_twins(const HierarchyMedium& m, int count, std::uint64_t seed) {
    expect_twins(m.medium, count, seed);
  }
  void expect_twins(const Medium& medium, int count, std::uint64_t seed) {
    const VectorTracker tracker = vector_tracker(GetParam(), medium);
    ASSERT_TRUE(tracker);
    const std::vector<Task> tasks = make_tasks(medium, count, seed);
    const std::vector<Outcome> lanes = track_lanes(medium, tracker, tasks);
    std::uint64_t steps = 0;
    for (std::size_t i = 0; i < tasks.size(); ++i) {
      const Outcome expected = track_scalar(medium, tasks[i]);
      SCOPED_TRACE("ray " + std::to_string(i));
      ASSERT_EQ(lanes[i].steps, expected.steps);
      ASSERT_EQ(lanes[i].violations, 0u);
      ASSERT_EQ(lanes[i].collision.real, expected.collision.real);
      ASSERT_EQ(lanes[i].collision.t_mm, expected.collision.t_mm);
      ASSERT_EQ(lanes[i].collision.p_index, expected.collision.p_index);
      ASSERT_EQ(lanes[i].collision.value, expected.collision.value);
      ASSERT_EQ(lanes[i].transmittance, expected.transmittance);
      ASSERT_EQ(lanes[i].rng, expected.rng);
      steps += expected.steps;
    }
    EXPECT_GT(steps, tasks.size() / 10);
  }
  void SetUp() override {
    if (!has_simd_target(GetParam())) GTEST_SKIP() << "not on this machine";
  }
};

template <class T>
HierarchyMedium noisy_medium(test::Size3 size, int cell_voxels) {
  const double upper = sizeof(T) == 1 ? 100 : 1000;
  return {test::noise_volume<T>(size, 0, upper, 11),
          mu_t_function({{0, 0},
                         {0.4 * upper, 0},
                         {0.5 * upper, 0.3},
                         {0.5 * upper, 0.05},
                         {0.9 * upper, 2},
                         {upper, 0.5}}),
          cell_voxels};
}

TEST_P(VectorTracking, EveryVoxelTypeIsTheScalarTwin) {
  expect_twins(noisy_medium<std::uint8_t>({33, 26, 21}, 2), 4000, 1);
  expect_twins(noisy_medium<std::int8_t>({33, 26, 21}, 2), 4000, 2);
  expect_twins(noisy_medium<std::uint16_t>({33, 26, 21}, 2), 4000, 3);
  expect_twins(noisy_medium<std::int16_t>({33, 26, 21}, 2), 4000, 4);
  expect_twins(noisy_medium<std::uint32_t>({33, 26, 21}, 2), 4000, 5);
  expect_twins(noisy_medium<std::int32_t>({33, 26, 21}, 2), 4000, 6);
  expect_twins(noisy_medium<float>({33, 26, 21}, 2), 4000, 7);
  expect_twins(noisy_medium<double>({33, 26, 21}, 2), 4000, 8);
}

TEST_P(VectorTracking, EverySizeAndCell) {
  for (const test::Size3 size :
       {test::Size3{2, 1, 1}, {2, 2, 2}, {3, 5, 7}, {17, 9, 1}, {40, 1, 12}, {65, 64, 63}})
    for (const int cell : {1, 2, 3, 8, 1000}) {
      SCOPED_TRACE(testing::Message() << size[0] << "x" << size[1] << "x" << size[2] << " cells of " << cell);
      expect_twins(noisy_medium<std::int16_t>(size, cell), 1500, 9);
    }
}

TEST_P(VectorTracking, SparseMatterInLargeBlocks) {
  const HierarchyMedium m(
      make_volume<std::int16_t>({130, 130, 70},
                                [](auto i, auto j, auto k) {
                                  return (i - 65) * (i - 65) + (j - 60) * (j - 60) + (k - 30) * (k - 30) < 300
                                             ? 500
                                             : 0;
                                }),
      mu_t_function({{0, 0}, {100, 0}, {400, 3}}), 2);
  expect_twins(m, 10000, 10);
}

TEST_P(VectorTracking, SignedValuesAndNaN) {
  const HierarchyMedium negative(test::noise_volume<std::int8_t>({20, 20, 20}, -100, 100, 12),
                                 mu_t_function({{-100, 0.5}, {-50, 0}, {0, 0.1}, {100, 1}}), 2);
  expect_twins(negative, 3000, 13);
  Volume holes = test::noise_volume<float>({20, 20, 20}, -1, 1, 14);
  auto* voxels = static_cast<float*>(const_cast<void*>(static_cast<const void*>(holes.voxels.get())));
  for (int i = 0; i < 8000; i += 7) voxels[i] = std::numeric_limits<float>::quiet_NaN();
  const HierarchyMedium nan(std::move(holes), mu_t_function({{-1, 0.5}, {1, 2}}), 2);
  expect_twins(nan, 3000, 15);
}

TEST_P(VectorTracking, ShadowsOfLessExtinction) {
  HierarchyMedium m = noisy_medium<std::int16_t>({33, 26, 21}, 2);
  Medium medium = m.medium;
  for (const float share : {0.3f, 0.01f}) {
    medium.shadow_extinction = share;
    expect_twins(medium, 4000, 16);
  }
}

TEST_P(VectorTracking, RandomRules) {
  const test::Size3 size{33, 26, 21};
  test::Placement shifted = test::placements()[3];
  shifted.spacing_mm = {0.9, 1.2, 1.1};
  shifted.origin_mm = {12, 5, 15};
  test::RuleVolumeSet volumes(test::noise_volume<std::int16_t>(size, 0, 1000, 17));
  volumes.add("organs", test::noise_volume<std::uint8_t>(size, 0, 6, 18), Lookup::kNearest)
      .add("pet", test::noise_volume<float>({20, 20, 20}, 0, 10, 19, shifted), Lookup::kLinear)
      .add("rounded",
           test::make_volume<std::int16_t>(
               {24, 24, 24}, [](auto i, auto j, auto k) { return (i / 4 + j / 3 + k / 5) % 4; }, shifted),
           Lookup::kNearest, Outline::kSmooth);
  const auto materials = test::random_rule_materials();
  Rng rng(20, 0, 0, 0);
  test::RandomRules random(volumes, rng);
  RuleBounds bounds(volumes.main(), 2, CellOrder::kCubes, volumes.all());
  MajorantHierarchy hierarchy(volumes.main(), 2);
  for (int n = 0; n < 12; ++n) {
    TransferDescription transfer = random.transfer(static_cast<Merge>(n % 3), 1 + n % 4);
    // Something that is visible everywhere but where a product hides it.
    if (n % 3)
      transfer.rules.push_back(
          test::rule_of(RuleKind::kCoefficientCurve, "data", {test::opacity_point(0, 0.1)}));
    const Classifier classifier(transfer, volumes.all(), materials);
    const TransferFunction function(mu_t_function({{0, 0}}));
    bounds.prepare(classifier);
    hierarchy.update(bounds);
    Medium medium{volumes.main(), function.view(), hierarchy.view(), classifier.view()};
    medium.shadow_extinction = n % 2 ? 0.3f : 1.0f;
    if (classifier.upper_mu_t() > 0) expect_twins(medium, 1500, 21);
  }
}

INSTANTIATE_TEST_SUITE_P(Targets, VectorTracking,
                         testing::Values(SimdTarget::kSse4, SimdTarget::kAvx2, SimdTarget::kAvx512,
                                         SimdTarget::kNeon),
                         [](const auto& target) {
                           switch (target.param) {
                             case SimdTarget::kSse4:
                               return "Sse4";
                             case SimdTarget::kAvx2:
                               return "Avx2";
                             case SimdTarget::kAvx512:
                               return "Avx512";
                             default:
                               return "Neon";
                           }
                         });

}  // namespace
}  // namespace voxlume
