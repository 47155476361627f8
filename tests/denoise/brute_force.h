#pragma once
#include <random>

#include "denoise/guides.h"
#include "denoise/test_frame.h"

namespace voxlume {

/// Matter of random depth, normal, albedo and colour, and holes in it.
inline DenoiseFrame random_frame(int width, int height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> uniform;
  const auto pixel = [&](int x, int) {
    TestPixel p;
    p.alpha = uniform(random) < 0.2f ? 0 : uniform(random);
    p.radiance = Vec3f(uniform(random), uniform(random), uniform(random)) * p.alpha;
    p.depth_mm = 400.0f + static_cast<float>(x) + 3 * uniform(random);
    p.normal = Vec3f(0.3f * uniform(random), -0.9f, 0.3f * uniform(random));
    p.albedo = Vec3f(0.5f + 0.2f * uniform(random));
    return p;
  };
  return test_frame(width, height, pixel);
}

/// The weight that guides give to q as a neighbour of p, in double precision.
inline double guide_weight(const Guides& guides, int px, int py, int qx, int qy) {
  double features = 0;
  for (int c = 0; c < 3; ++c) {
    const double normal = guides.normal[c].at(px, py) - guides.normal[c].at(qx, qy);
    const double albedo = guides.albedo[c].at(px, py) - guides.albedo[c].at(qx, qy);
    features += normal * normal + albedo * albedo;
  }
  const double distance = std::hypot(qx - px, qy - py);
  const double depth = std::abs(guides.depth_mm.at(px, py) - guides.depth_mm.at(qx, qy));
  return std::exp(-features * guides.feature_rate.at(px, py) -
                  (distance > 0 ? depth * guides.depth_rate.at(px, py) / distance : 0));
}

}  // namespace voxlume
