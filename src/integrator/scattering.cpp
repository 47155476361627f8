#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "integrator/scattering.cpp"
#include <hwy/foreach_target.h>

#include "integrator/scattering-inl.h"

#if HWY_ONCE

namespace voxlume {

Scattering scatter_at(const SceneView& scene, const ScatteringQuery& query) noexcept {
  Scattering out{};
  out.matter = matter_at(scene, query.p_index, query.value);
  ScatterPoint& point = out.matter.scatter;
  out.surface_share = point.p_brdf;
  // Exposure Render decides at every event whether it is a surface or a medium (xu2024 eq. 4, without the
  // division by the probability of the choice, which would double the scattered energy).
  if (scene.scattering.shading == Shading::kExposureRender)
    out.matter.particles.p_surface = point.p_brdf = query.u_surface < point.p_brdf ? 1.0f : 0.0f;
  const ScatterKernel kernel(scene, out.matter, query.wo);
  out.choice = kernel.choice();
  const Vec3f p_world = out.matter.p_world;
  if (query.samples_light) {
    out.light = sample_light(scene.lights, p_world, query.u_light, query.light.u0, query.light.u1);
    const ScatterParts parts = kernel.eval(out.light.wi);
    out.toward_light = {parts.diffuse + parts.specular + parts.phase, parts.pdf};
    out.light_ray = ray_from(scene, query.p_index, p_world, out.light.wi, out.light.distance_mm);
  }
  if (query.turns) {
    out.turn = kernel.sample(query.u_lobe, query.direction.u0, query.direction.u1);
    out.turn_ray =
        ray_from(scene, query.p_index, p_world, out.turn.wi, std::numeric_limits<float>::infinity());
    out.turn_meets_rect = meets_rect_light(scene.lights, p_world, out.turn.wi);
  }
  return out;
}

ScatterKernel::Albedo ScatterKernel::albedo() const noexcept {
  if (model_ == Model::kParticles) {
    const ParticlePoint& p = matter_.particles;
    const ParticleShares shares = particle_shares(p);
    const Vec3f diffuse = p.color * (shares.rest * (1 - particles_.fresnel) + shares.phase);
    return {diffuse, max(particle_albedo(p, wo_) - diffuse, Vec3f(0))};
  }
  const ScatterPoint& point = matter_.scatter;
  if (model_ == Model::kBlinnPhong) {
    const float reflected = matter_.highlight.strength * blinn_phong_albedo(matter_.highlight.shininess);
    return {point.albedo, point.albedo * reflected};
  }
  SurfaceAlbedo surface{Vec3f(0), 0};
  if (point.p_brdf > 0)
    surface = estimate_albedo(surface_lobe(point), std::min(std::abs(dot(point.normal, wo_)), 1.0f));
  return {surface.diffuse * point.p_brdf + point.albedo * (1 - point.p_brdf),
          Vec3f(surface.specular * point.p_brdf)};
}

void ScatteringBatch::add(const ScatteringQuery& query) noexcept {
  const int i = count++;
  for (int a = 0; a < 3; ++a) {
    p_index[a][i] = query.p_index[a];
    wo[a][i] = query.wo[a];
  }
  value[i] = query.value;
  u_surface[i] = query.u_surface;
  u_light[i] = query.u_light;
  light0[i] = query.light.u0;
  light1[i] = query.light.u1;
  u_lobe[i] = query.u_lobe;
  direction0[i] = query.direction.u0;
  direction1[i] = query.direction.u1;
  samples_light |= query.samples_light;
  turns |= query.turns;
}

Scattering ScatteringBatch::at(const SceneView& scene, int i) const noexcept {
  const auto vec = [i](const Column3& a) { return Vec3f(a[0][i], a[1][i], a[2][i]); };
  const ScatteringView& s = scene.scattering;
  const auto ray = [&](const Column3& direction, const Column<float>& near, const Column<float>& far) {
    return TrackRay{{vec(p_index), vec(direction)}, near[i], far[i]};
  };
  return {{{vec(normal), p_brdf[i], vec(albedo), s.g, s.alpha, s.f0}, {}, {}, vec(emission), vec(p_world)},
          surface_share[i],
          {specular[i], surface[i], any[i]},
          {vec(light_wi), light_mm[i], vec(light_radiance), light_pdf[i], light_delta[i] != 0},
          {vec(light_value), light_value_pdf[i]},
          ray(light_direction_index, light_near, light_far),
          {vec(turn_wi), vec(turn_value), turn_pdf[i]},
          ray(turn_direction_index, turn_near, turn_far),
          turn_meets_rect[i] != 0};
}

FillScatterings vector_scatterings(SimdTarget target) {
  switch (target) {
#if HWY_TARGETS & HWY_AVX3
    case SimdTarget::kAvx512:
      return &N_AVX3::fill_scatterings;
#endif
#if HWY_TARGETS & HWY_AVX2
    case SimdTarget::kAvx2:
      return &N_AVX2::fill_scatterings;
#endif
#if HWY_TARGETS & HWY_SSE4
    case SimdTarget::kSse4:
      return &N_SSE4::fill_scatterings;
#endif
#if HWY_TARGETS & HWY_NEON
    case SimdTarget::kNeon:
      return &N_NEON::fill_scatterings;
#endif
    default:
      return nullptr;
  }
}

}  // namespace voxlume
#endif  // HWY_ONCE
