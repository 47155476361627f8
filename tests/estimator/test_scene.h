#pragma once
#include <cmath>
#include <cstdlib>
#include <functional>
#include <vector>

#include "base/parallel.h"
#include "grid/grid_view.h"
#include "integrator/path_tracer.h"
#include "scene/compile.h"
#include "scene/resolve.h"

namespace voxlume::test {

/// A float volume of `size` voxels, centred on the origin, filled by value(p_world mm).
inline Volume make_volume(std::array<std::int64_t, 3> size, double spacing_mm,
                          const std::function<double(Vec3d)>& value,
                          std::array<double, 9> direction = {1, 0, 0, 0, 1, 0, 0, 0, 1}) {
  Volume volume;
  volume.size = size;
  volume.type = VoxelType::kF32;
  volume.spacing_mm = {spacing_mm, spacing_mm, spacing_mm};
  volume.direction = direction;
  Vec3d half;
  for (int a = 0; a < 3; ++a) half[a] = 0.5 * static_cast<double>(size[a] - 1);
  const Vec3d origin = -world_from_index(volume).vector(half);
  volume.origin_mm = {origin.x, origin.y, origin.z};
  const Affined world = world_from_index(volume);
  auto voxels = std::make_shared<std::vector<float>>(volume.voxel_count());
  std::size_t at = 0;
  for (std::int64_t k = 0; k < size[2]; ++k)
    for (std::int64_t j = 0; j < size[1]; ++j)
      for (std::int64_t i = 0; i < size[0]; ++i)
        (*voxels)[at++] = static_cast<float>(value(
            world.point(Vec3d(static_cast<double>(i), static_cast<double>(j), static_cast<double>(k)))));
  volume.voxels = std::shared_ptr<const void>(voxels, voxels->data());
  return volume;
}

inline TransferPoint point(double value, double mu_t_per_mm, Color albedo, Color emission = {{0, 0, 0}}) {
  TransferPoint p;
  p.value = value;
  p.mu_t_per_mm = mu_t_per_mm;
  p.color = albedo;
  p.emission = emission;
  return p;
}

inline Color grey(float linear) { return {{linear, linear, linear}}; }

/// No lights, no environment, a black background, an orthographic view along +y of the whole volume.
inline SceneDescription dark_scene(int width, int height) {
  SceneDescription scene;
  scene.lights.emplace();
  scene.environment.emplace();
  scene.environment->intensity = 0;
  scene.background.emplace();
  scene.background->color = grey(0);
  scene.camera.projection = Projection::kOrthographic;
  scene.image.width = width;
  scene.image.height = height;
  scene.image.filter = PixelFilter::kBox;
  scene.image.filter_radius_px = 0.5;
  scene.transfer.reference_length_mm = 1;
  // Independent samples: their spread tells the error of their mean.
  scene.render.sampler = Sampler::kRandom;
  return scene;
}

inline LightDescription directional(Double3 direction, double irradiance) {
  LightDescription light;
  light.kind = LightKind::kDirectional;
  light.direction = direction;
  light.intensity = irradiance;
  return light;
}

/// Sample moments of a quantity.
struct Moments {
  double count = 0, sum = 0, sum2 = 0;
  void add(double x) {
    count += 1;
    sum += x;
    sum2 += x * x;
  }
  Moments& operator+=(const Moments& o) {
    count += o.count;
    sum += o.sum;
    sum2 += o.sum2;
    return *this;
  }
  double mean() const { return sum / count; }
  double variance() const { return (sum2 - sum * sum / count) / (count - 1); }
  double standard_error() const { return std::sqrt(std::max(variance(), 0.0) / count); }
};

/// Welch's statistic for the difference of two means; about N(0,1) where they are equal.
inline double welch_z(const Moments& a, const Moments& b) {
  const double error = std::hypot(a.standard_error(), b.standard_error());
  return error > 0 ? (a.mean() - b.mean()) / error : a.mean() == b.mean() ? 0.0 : 1e9;
}

struct Estimate {
  int width = 0, height = 0;
  std::vector<Moments> pixels;  ///< luminance, row by row
  TraceCounters counters;

  /// Moments of all samples of the pixels of block (bx, by).
  Moments block(int bx, int by, int edge) const {
    Moments sum;
    for (int y = by * edge; y < (by + 1) * edge; ++y)
      for (int x = bx * edge; x < (bx + 1) * edge; ++x)
        sum += pixels[static_cast<std::size_t>(y) * width + x];
    return sum;
  }
  Moments total() const {
    Moments sum;
    for (const Moments& m : pixels) sum += m;
    return sum;
  }
};

/// What the whole program is run with: the accelerator that VOXLUME_TEST_ACCELERATOR names ("thresholds": the
/// hierarchy by that rule) where the scene's trackers and rules can do with it, and the instruction set that
/// VOXLUME_TEST_SIMD names if this machine has it.
inline SceneDescription as_tested(SceneDescription description) {
  RenderDescription& render = description.render;
  if (const char* variable = std::getenv("VOXLUME_TEST_ACCELERATOR")) {
    const std::string name = variable;
    const bool has_minima = name == "none" || name == "macrocell";
    const bool needs_minima = render.transmittance != TransmittanceEstimator::kRatio ||
                              render.free_flight != FreeFlightSampling::kDelta;
    const bool has_rules = !description.transfer.rules.empty();
    if (has_minima || !(needs_minima || has_rules)) {
      render.accelerator = name == "thresholds" ? "hierarchy" : name;
      if (name == "thresholds") render.hierarchy_rule = "thresholds";
    }
  }
  if (const char* variable = std::getenv("VOXLUME_TEST_SIMD")) {
    const std::string name = variable;
    for (const SimdTarget target :
         {SimdTarget::kScalar, SimdTarget::kSse4, SimdTarget::kAvx2, SimdTarget::kAvx512, SimdTarget::kNeon})
      if (name == simd_name(target) && has_simd_target(target)) render.simd = name;
  }
  return description;
}

/// Luminances of samples [0, spp) of pixels [x0, x1) of a row.
inline std::vector<double> row_luminances(const SceneView& scene, int x0, int x1, int y, int spp,
                                          TraceCounters& counters) {
  std::vector<PixelSample> samples(static_cast<std::size_t>(x1 - x0) * spp);
  trace_tile(scene, {x0, y, x1, y + 1}, 0, spp, samples, {}, counters);
  std::vector<double> out;
  for (const PixelSample& sample : samples) out.push_back(luminance(sample.radiance));
  return out;
}

/// Traces `spp` samples of every pixel.
inline Estimate estimate(const SceneDescription& description, const Volume& volume, int spp) {
  const VolumeStatistics statistics = compute_statistics(make_grid_view(volume));
  const CompiledScene scene(resolve(as_tested(description), volume, statistics), volume, statistics);
  Estimate out;
  out.width = description.image.width;
  out.height = description.image.height;
  out.pixels.resize(static_cast<std::size_t>(out.width) * out.height);
  std::vector<TraceCounters> counters(out.height);
  parallel_for(out.height, 1, [&](std::int64_t y) {
    const std::vector<double> row =
        row_luminances(scene.view(), 0, out.width, static_cast<int>(y), spp, counters[y]);
    for (std::size_t i = 0; i < row.size(); ++i) out.pixels[y * out.width + i / spp].add(row[i]);
  });
  for (const TraceCounters& c : counters) out.counters += c;
  return out;
}

}  // namespace voxlume::test
