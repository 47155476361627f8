#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrator/primary_ray.cpp"
#include <hwy/foreach_target.h>

#include "integrator/primary_ray-inl.h"

#if HWY_ONCE

#include <limits>

#include "sampling/warp.h"

namespace voxlume {

SampleStream sample_stream(const SceneView& scene, int x, int y, std::uint32_t sample) noexcept {
  const std::uint32_t pixel =
      static_cast<std::uint32_t>(y) * static_cast<std::uint32_t>(scene.width) + static_cast<std::uint32_t>(x);
  return {scene.seed, scene.frame, pixel, sample};
}

PrimaryRay make_primary_ray(const SceneView& scene, int x, int y, std::uint32_t sample) noexcept {
  return make_primary_ray(scene, sample_stream(scene, x, y, sample), x + 0.5f, y + 0.5f);
}

PrimaryRay make_primary_ray(const SceneView& scene, const SampleStream& stream, float center_px,
                            float center_py) noexcept {
  PrimaryRay out{};
  out.rng = Rng(stream.seed, stream.frame, stream.pixel, stream.sample);
  UnitQuad image{};  // and the lens
  if (scene.sampler == Sampler::kSobol) {
    const std::uint32_t pixel_seed = sobol_pixel_seed(stream.seed, stream.frame, stream.pixel);
    image = sobol_quad(pixel_seed, stream.sample, SobolSet::kCamera);
    const auto quad = [&](SobolSet set) { return sobol_quad(pixel_seed, stream.sample, set); };
    out.first = FirstNumbers::of(quad(SobolSet::kFirstFlight), quad(SobolSet::kFirstScattering),
                                 quad(SobolSet::kFirstLight));
  } else {
    for (float& u : image) u = out.rng.next();
  }
  out.px = center_px + sample_filter(scene.filter, scene.filter_radius_px, image[0]);
  out.py = center_py + sample_filter(scene.filter, scene.filter_radius_px, image[1]);
  const CameraRay camera = camera_ray(scene.camera, out.px, out.py, image[2], image[3]);
  out.origin_world = camera.origin;
  out.direction_world = camera.direction;
  const bool clipped = true;
  out.track = visible_part(scene, to_index_ray(scene.medium.grid, camera.origin, camera.direction),
                           camera.origin, camera.direction, std::numeric_limits<float>::infinity(), clipped);
  out.track.u_collision = out.first.u_collision;
  out.track.u_depth = out.first.u_depth;
  out.track.fine = scene.sampler == Sampler::kSobol;
  out.enters = out.track.t_near < out.track.t_far;
  return out;
}

FillPrimaryRays vector_primary_rays(SimdTarget target, const CameraView& camera) {
  if (camera.aperture_radius_mm > 0) return nullptr;
  switch (target) {
#if HWY_TARGETS & HWY_AVX3
    case SimdTarget::kAvx512:
      return &N_AVX3::fill_primary_rays;
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdTarget::kAvx2:
      return &N_AVX2::fill_primary_rays;
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdTarget::kSse4:
      return &N_SSE4::fill_primary_rays;
#endif
#if HWY_TARGETS & HWY_NEON
    case SimdTarget::kNeon:
      return &N_NEON::fill_primary_rays;
#endif
    default:
      return nullptr;
  }
}

}  // namespace voxlume
#endif  // HWY_ONCE
