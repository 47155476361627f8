#pragma once
#include <array>
#include <cstdint>

#include "integrator/scene_view.h"
#include "sampling/rng.h"

namespace voxlume {

/// Where a camera sample looks.
struct PrimaryRay {
  Rng rng;                           ///< of the sample, past what was drawn here
  std::uint32_t pixel_seed, sample;  ///< of sobol_pair
  float u_light;                     ///< which light the first scattering takes; negative: drawn from rng
  float px, py;                      ///< image point, from the top left corner
  Vec3f origin_world, direction_world;
  TrackRay track;  ///< the part inside the visible region
  bool enters;     ///< false: there is none
};

/// The ray of sample `sample` of pixel (x, y). The random stream depends on (seed, frame, pixel, sample)
/// alone.
PrimaryRay make_primary_ray(const SceneView& scene, int x, int y, std::uint32_t sample) noexcept;

/// Many primary rays, a column of every array each.
struct alignas(64) PrimaryRayBatch {
  static constexpr int kCount = 32;
  template <class T>
  using Column = std::array<T, kCount>;

  // Given.
  alignas(64) Column<std::int32_t> x{}, y{}, sample{};
  // Filled.
  alignas(64) Column<std::uint32_t> rng[4]{};
  alignas(64) Column<std::uint32_t> pixel_seed{};
  alignas(64) Column<float> px{}, py{}, u_flight{}, u_light{};
  alignas(64) Column<float> origin_world[3]{}, direction_world[3]{};
  alignas(64) Column<float> origin_index[3]{}, direction_index[3]{};
  alignas(64) Column<float> t_near{}, t_far{};

  PrimaryRay at(int i) const noexcept {
    const auto vec = [i](const Column<float>(&a)[3]) { return Vec3f(a[0][i], a[1][i], a[2][i]); };
    return {Rng(std::array{rng[0][i], rng[1][i], rng[2][i], rng[3][i]}),
            pixel_seed[i],
            static_cast<std::uint32_t>(sample[i]),
            u_light[i],
            px[i],
            py[i],
            vec(origin_world),
            vec(direction_world),
            {{vec(origin_index), vec(direction_index)}, t_near[i], t_far[i], u_flight[i]},
            t_near[i] < t_far[i]};
  }
};

/// Fills a batch with what make_primary_ray computes, to the last bit.
using FillPrimaryRays = void (*)(const SceneView& scene, PrimaryRayBatch& batch);

/// The filler for an instruction set that the machine has; nullptr where scalar code has to serve: without
/// one, and for lenses that blur.
FillPrimaryRays vector_primary_rays(SimdTarget target, const CameraView& camera);

}  // namespace voxlume
