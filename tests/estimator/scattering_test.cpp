// Vectors of scatterings are the scalar ones, to the last bit.
#include "integrator/scattering.h"

#include <gtest/gtest.h>

#include "simd_modes.h"
#include "support/random_direction.h"

namespace voxlume::test {
namespace {

Vec3f random_point(const Box3f& box, Rng& rng) {
  const float x = rng.next(), y = rng.next(), z = rng.next();
  return box.lower + box.extent() * Vec3f(x, y, z);
}

/// Points deep inside, near faces and edges, and all that may be asked.
ScatteringQuery random_query(const SceneView& scene, Rng& rng) {
  const GridView& grid = scene.medium.grid;
  const bool samples = scene.lights.pick.count > 0;
  ScatteringQuery query{random_point(grid.index_box(), rng), 0, random_direction(rng), samples, true};
  query.value = sample_trilinear(grid, query.p_index);
  if (rng.next() < 0.05f) query.value = std::numeric_limits<float>::quiet_NaN();
  query.u_surface = rng.next();
  query.u_light = rng.next();
  query.light = {rng.next(), rng.next()};
  query.u_lobe = rng.next();
  query.direction = {rng.next(), rng.next()};
  if (rng.next() < 0.05f) query.direction = {0.5f, 0.5f};
  return query;
}

void expect_same(const TrackRay& a, const TrackRay& b) {
  ASSERT_EQ(a.t_near < a.t_far, b.t_near < b.t_far);
  if (!(a.t_near < a.t_far)) return;
  ASSERT_EQ(a.ray.origin_index, b.ray.origin_index);
  ASSERT_EQ(a.ray.direction_index, b.ray.direction_index);
  ASSERT_EQ(a.t_near, b.t_near);
  ASSERT_EQ(a.t_far, b.t_far);
}

void expect_same(const Scattering& a, const Scattering& b) {
  ASSERT_EQ(a.matter.p_world, b.matter.p_world);
  ASSERT_EQ(a.matter.emission, b.matter.emission);
  ASSERT_EQ(a.matter.scatter.normal, b.matter.scatter.normal);
  ASSERT_EQ(a.matter.scatter.p_brdf, b.matter.scatter.p_brdf);
  ASSERT_EQ(a.matter.scatter.albedo, b.matter.scatter.albedo);
  ASSERT_EQ(a.surface_share, b.surface_share);
  ASSERT_EQ(a.choice.specular, b.choice.specular);
  ASSERT_EQ(a.choice.surface, b.choice.surface);
  ASSERT_EQ(a.choice.any, b.choice.any);
  ASSERT_EQ(a.light.wi, b.light.wi);
  ASSERT_EQ(a.light.distance_mm, b.light.distance_mm);
  ASSERT_EQ(a.light.radiance, b.light.radiance);
  ASSERT_EQ(a.light.pdf, b.light.pdf);
  ASSERT_EQ(a.light.delta, b.light.delta);
  ASSERT_EQ(a.toward_light.value, b.toward_light.value);
  ASSERT_EQ(a.toward_light.pdf, b.toward_light.pdf);
  ASSERT_EQ(a.turn.wi, b.turn.wi);
  ASSERT_EQ(a.turn.value, b.turn.value);
  ASSERT_EQ(a.turn.pdf, b.turn.pdf);
  ASSERT_EQ(a.turn_meets_rect, b.turn_meets_rect);
  expect_same(a.light_ray, b.light_ray);
  expect_same(a.turn_ray, b.turn_ray);
}

/// Every instruction set, over batches full and not.
void expect_twins(const SceneDescription& description, const Volume& volume, const char* name) {
  const auto compiled = compile(description, volume, SimdTarget::kScalar);
  const SceneView& scene = compiled->view();
  for (const SimdTarget target : kTargets) {
    if (!has_simd_target(target)) continue;
    SCOPED_TRACE(std::string(name) + ", " + simd_name(target));
    const FillScatterings fill = vector_scatterings(target);
    ASSERT_TRUE(fill);
    Rng rng(7, 0, 0, 0);
    int surfaces = 0, media = 0, lit = 0;
    ScatteringBatch batch;
    for (int n = 0; n < 60; ++n) {
      std::vector<ScatteringQuery> queries;
      batch.clear();
      for (int i = 0; i < (n % 3 ? ScatteringBatch::kCount : n % ScatteringBatch::kCount); ++i) {
        queries.push_back(random_query(scene, rng));
        batch.add(queries.back());
      }
      fill(scene, batch);
      for (int i = 0; i < batch.count; ++i) {
        const Scattering expected = scatter_at(scene, queries[static_cast<std::size_t>(i)]);
        ASSERT_NO_FATAL_FAILURE(expect_same(batch.at(scene, i), expected));
        surfaces += expected.turn.pdf > 0 && expected.surface_share > 0;
        media += expected.turn.pdf > 0;
        lit += expected.light.pdf > 0;
      }
    }
    EXPECT_GT(media, 100);
    if (scene.scattering.shading != Shading::kPhase) {
      EXPECT_GT(surfaces, 100);
    }
    if (scene.lights.pick.count > 0) {
      EXPECT_GT(lit, 100);
    }
  }
}

LightDescription rect_light(Double3 position, double width, bool two_sided) {
  LightDescription light;
  light.kind = LightKind::kRect;
  light.position_mm = position;
  light.target_mm = Double3{0, 0, 0};
  light.size_mm = {width, 0.5 * width};
  light.two_sided = two_sided;
  return light;
}

LightDescription point_light(Double3 position) {
  LightDescription light;
  light.kind = LightKind::kPoint;
  light.position_mm = position;
  light.intensity = 100;
  return light;
}

const Mode kScatteringModes[] = {
    {"anisotropic", [](SceneDescription& s) { s.material.anisotropy = 0.7; }},
    {"backwards", [](SceneDescription& s) { s.material.anisotropy = -0.4; }},
    {"no interface", [](SceneDescription& s) { s.material.specular = 0; }},
    {"mirror", [](SceneDescription& s) { s.material.roughness = 0; }},
    {"exponential share",
     [](SceneDescription& s) { s.material.surface_share = SurfaceShareForm::kExponential; }},
    {"modulated share",
     [](SceneDescription& s) { s.material.surface_share = SurfaceShareForm::kModulation; }},
    {"threshold share", [](SceneDescription& s) { s.material.surface_share = SurfaceShareForm::kThreshold; }},
    {"near lights",
     [](SceneDescription& s) {
       s.lights = {rect_light({0, -30, 0}, 40, true), rect_light({8, 0, 2}, 4, false),
                   point_light({0, 0, 1})};
     }},
    {"many lights",
     [](SceneDescription& s) {
       for (int i = 0; i < 12; ++i) s.lights->push_back(point_light({20.0 * i, -30, 5}));
     }},
    {"no lights", [](SceneDescription& s) { s.lights.emplace(); }},
};

TEST(Scatterings, AreTheScalarOnesInEveryMode) {
  const Volume volume = bumps();
  for (const Mode& mode : kModes) {
    SceneDescription scene = base_scene();
    mode.set(scene);
    expect_twins(scene, volume, mode.name);
  }
  for (const Mode& mode : kScatteringModes) {
    SceneDescription scene = base_scene();
    mode.set(scene);
    expect_twins(scene, volume, mode.name);
  }
}

template <class T>
void expect_twins_of_type(VoxelType type, const char* name) {
  constexpr double kScale = 80;
  const Volume ball = bumps();
  const auto* values = static_cast<const float*>(ball.voxels.get());
  const auto voxels = std::make_shared<std::vector<T>>();
  for (std::size_t i = 0; i < ball.voxel_count(); ++i)
    voxels->push_back(static_cast<T>(std::max(0.0, kScale * values[i])));
  Volume volume = ball;
  volume.type = type;
  volume.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  SceneDescription scene = base_scene();
  for (TransferPoint& p : scene.transfer.points) p.value *= kScale;
  expect_twins(scene, volume, name);
}

TEST(Scatterings, AreTheScalarOnesForEveryVoxelType) {
  expect_twins_of_type<std::uint8_t>(VoxelType::kU8, "u8");
  expect_twins_of_type<std::int8_t>(VoxelType::kI8, "i8");
  expect_twins_of_type<std::uint16_t>(VoxelType::kU16, "u16");
  expect_twins_of_type<std::int16_t>(VoxelType::kI16, "i16");
  expect_twins_of_type<std::uint32_t>(VoxelType::kU32, "u32");
  expect_twins_of_type<std::int32_t>(VoxelType::kI32, "i32");
  expect_twins_of_type<double>(VoxelType::kF64, "f64");
}

TEST(Scatterings, AreTheScalarOnesInThinVolumes) {
  for (const std::array<std::int64_t, 3>& size :
       {std::array<std::int64_t, 3>{2, 1, 1}, {2, 2, 2}, {9, 1, 5}, {3, 8, 1}})
    expect_twins(base_scene(),
                 make_volume(size, 2, [](Vec3d p) { return 0.7 + 0.1 * p.x + 0.05 * p.y - 0.07 * p.z; }),
                 "thin");
}

}  // namespace
}  // namespace voxlume::test
