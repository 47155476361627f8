#pragma once
#include <array>
#include <cstdint>

#include "integrator/scene_view.h"
#include "sampling/rng.h"
#include "sampling/sobol.h"

namespace voxlume {

/// The sample's numbers that are stratified against those of its pixel's other samples.
struct FirstNumbers {
  /// SobolSet::kFirstFlight: where the flight collides (TrackRay::u_collision), the shadow ray's first
  /// optical depth, which light it is cast to, the flight's first optical depth.
  float u_collision = -1, u_shadow_depth = -1, u_light = -1, u_depth = -1;
  /// SobolSet::kFirstScattering: the direction, the first optical depth of the flight that follows, and which
  /// part of the matter scatters.
  UnitPair direction{-1, -1};
  float u_next_depth = -1, u_lobe = -1;
  /// SobolSet::kFirstLight: the point on the light, and where the flight after the scattering collides.
  UnitPair light{-1, -1};
  float u_next_collision = -1;
  /// In the order of SobolSet.
  static FirstNumbers of(const UnitQuad& flight, const UnitQuad& scattering, const UnitQuad& light) noexcept {
    return {flight[0],
            flight[1],
            flight[2],
            flight[3],
            {scattering[0], scattering[1]},
            scattering[2],
            scattering[3],
            {light[0], light[1]},
            light[2]};
  }
  bool operator==(const FirstNumbers&) const = default;
};

/// Where a camera sample looks.
struct PrimaryRay {
  Rng rng;  ///< of the sample, past what was drawn here
  /// What the path up to its first shadow ray takes instead of its stream's numbers; negative: it takes
  /// those.
  FirstNumbers first;
  float px, py;  ///< image point, from the top left corner
  Vec3f origin_world, direction_world;
  TrackRay track;  ///< the part inside the visible region
  bool enters;     ///< false: there is none
};

/// What a camera sample's random numbers depend on, alone.
struct SampleStream {
  std::uint64_t seed;
  std::uint32_t frame;
  std::uint32_t pixel;  ///< row * width + column
  std::uint32_t sample;
};

/// The stream of sample `sample` of the scene's pixel (x, y).
SampleStream sample_stream(const SceneView& scene, int x, int y, std::uint32_t sample) noexcept;

/// The ray of sample `sample` of pixel (x, y).
PrimaryRay make_primary_ray(const SceneView& scene, int x, int y, std::uint32_t sample) noexcept;

/// The ray of a sample of any stream, of a pixel whose middle is image point (center_px, center_py).
PrimaryRay make_primary_ray(const SceneView& scene, const SampleStream& stream, float center_px,
                            float center_py) noexcept;

/// Many primary rays, a column of every array each.
struct alignas(64) PrimaryRayBatch {
  static constexpr int kCount = 32;
  template <class T>
  using Column = std::array<T, kCount>;

  // Given.
  alignas(64) Column<std::int32_t> x{}, y{}, sample{};
  // Filled.
  alignas(64) Column<std::uint32_t> rng[4]{};
  alignas(64) Column<float> first_flight[4]{}, first_scattering[4]{}, first_light[4]{};  ///< of the SobolSets
  alignas(64) Column<float> px{}, py{};
  alignas(64) Column<float> origin_world[3]{}, direction_world[3]{};
  alignas(64) Column<float> origin_index[3]{}, direction_index[3]{};
  alignas(64) Column<float> t_near{}, t_far{};

  PrimaryRay at(int i) const noexcept {
    const auto vec = [i](const Column<float>(&a)[3]) { return Vec3f(a[0][i], a[1][i], a[2][i]); };
    return {Rng(std::array{rng[0][i], rng[1][i], rng[2][i], rng[3][i]}),
            FirstNumbers::of(quad(first_flight, i), quad(first_scattering, i), quad(first_light, i)),
            px[i],
            py[i],
            vec(origin_world),
            vec(direction_world),
            {{vec(origin_index), vec(direction_index)},
             t_near[i],
             t_far[i],
             first_flight[0][i],
             first_flight[3][i],
             first_flight[0][i] >= 0},
            t_near[i] < t_far[i]};
  }

 private:
  static UnitQuad quad(const Column<float> (&from)[4], int i) noexcept {
    return {from[0][i], from[1][i], from[2][i], from[3][i]};
  }
};

/// Fills a batch with what make_primary_ray computes, to the last bit.
using FillPrimaryRays = void (*)(const SceneView& scene, PrimaryRayBatch& batch);

/// The filler for an instruction set that the machine has; nullptr where scalar code has to serve: without
/// one, and for lenses that blur.
FillPrimaryRays vector_primary_rays(SimdTarget target, const CameraView& camera);

}  // namespace voxlume
