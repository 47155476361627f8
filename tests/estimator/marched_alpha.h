#pragma once
#include <cmath>
#include <vector>

#include "integrator/visibility.h"

namespace voxlume::test {

/// The fraction of the light of a pixel's ray that fading matter takes, by marching eq. 8 densely.
inline double marched_alpha(const SceneView& scene, int x, int y) {
  std::vector<ImportanceSegment> segments;
  const SegmentListView list = find_importance(scene, x, y, {48, 1}, segments);
  if (!(list.entry < list.exit)) return 0;
  const CameraRay eye =
      camera_ray(scene.camera, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f, 0.5f, 0.5f);
  const IndexRay ray = to_index_ray(scene.medium.grid, eye.origin, eye.direction);
  constexpr int kSteps = 20000;
  const double h_mm = (double{list.exit} - list.entry) / kSteps;
  std::vector<double> mu(kSteps), g(kSteps);
  double total = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto t = static_cast<float>(list.entry + (i + 0.5) * h_mm);
    const Vec3f p = ray.origin_index + ray.direction_index * t;
    mu[i] = extinction_at(scene.medium, p);
    g[i] = importance_at(scene.visibility.importance, p);
    total += g[i] * g[i] * h_mm;
  }
  const VisibilityWeights& w = scene.visibility.weights;
  double before = 0, depth = 0;
  for (int i = 0; i < kSteps; ++i) {
    before += 0.5 * g[i] * g[i] * h_mm;
    const double h = w.r_per_mm * before + w.q_per_mm * (total - before);
    before += 0.5 * g[i] * g[i] * h_mm;
    depth += mu[i] * w.p / (w.p + std::pow(1 - g[i], 2.0 * w.lambda) * h) * h_mm;
  }
  return 1 - std::exp(-depth);
}

}  // namespace voxlume::test
