#pragma once
#include <cmath>
#include <numbers>
#include <vector>

#include "material/particles.h"

namespace voxlume::test {

inline const Vec3f kNormal = normalize(Vec3f(0.2f, -0.5f, 0.7f));
inline constexpr Vec3f kWhite(1.0f, 1.0f, 1.0f);

/// The table of one of a few indices; nullptr for others.
inline const GlassAlbedo* glass_of(float ior) {
  static const GlassAlbedo crown(1.5f), water(1.33f), dense(3.0f), thin(1.05f), thinnest(1.001f);
  for (const GlassAlbedo* g : {&crown, &water, &dense, &thin, &thinnest})
    if (g->ior() == ior) return g;
  return nullptr;
}

/// A surface of diffuse matter without coat, to be changed.
inline ParticlePoint matter(Vec3f color, float alpha) {
  return {kNormal, 1.0f, color, alpha, 0.0f, 0.0f, 0.0f, 1.5f, 0.0f, 0.0f, 0.0f, 0.0f, nullptr};
}
inline ParticlePoint lambert(Vec3f color) { return matter(color, 0.3f); }
inline ParticlePoint rough(Vec3f color, float roughness) {
  ParticlePoint p = matter(color, 0.3f);
  p.diffuse_roughness = roughness;
  return p;
}
inline ParticlePoint coated(Vec3f color, float alpha, float f0) {
  ParticlePoint p = matter(color, alpha);
  p.f0 = f0;
  return p;
}
inline ParticlePoint metal(Vec3f color, float alpha) {
  ParticlePoint p = matter(color, alpha);
  p.metallic = 1.0f;
  return p;
}
inline ParticlePoint glass(Vec3f color, float alpha, float ior) {
  ParticlePoint p = matter(color, alpha);
  p.transmission = 1.0f;
  p.ior = ior;
  p.glass = glass_of(ior);
  return p;
}
inline ParticlePoint medium(Vec3f color, float g, float g_back, float back_share) {
  ParticlePoint p = matter(color, 0.3f);
  p.normal = Vec3f(0.0f);
  p.p_surface = 0.0f;
  p.g = g;
  p.g_back = g_back;
  p.back_share = back_share;
  return p;
}
/// A bit of everything.
inline ParticlePoint mixture(Vec3f color, float p_surface, float metallic, float transmission, float alpha) {
  return {kNormal, p_surface, color, alpha, 0.04f, metallic,      transmission,
          1.5f,    0.7f,      0.6f,  -0.4f, 0.3f,  glass_of(1.5f)};
}

/// Every kind alone, and mixtures. Some are smooth over the sphere.
inline std::vector<ParticlePoint> kinds(Vec3f color) {
  return {lambert(color),
          rough(color, 1.0f),
          coated(color, 0.3f, 0.04f),
          metal(color, 0.4f),
          metal(color, 1.0f),
          glass(color, 0.3f, 1.5f),
          glass(color, 0.7f, 1.33f),
          medium(color, 0.5f, -0.3f, 0.2f),
          mixture(color, 0.5f, 0.3f, 0.4f, 0.25f),
          mixture(color, 0.9f, 0.0f, 0.5f, 0.5f),
          mixture(color, 0.03f, 0.5f, 0.0f, 0.6f)};
}

/// A unit vector at an angle from kNormal.
inline Vec3f tilted(double degrees) {
  const double a = degrees * std::numbers::pi / 180;
  return normalize(Frame(kNormal).to_world(Vec3f(Vec3d(std::sin(a) * 0.6, std::sin(a) * 0.8, std::cos(a)))));
}

}  // namespace voxlume::test
