#include "render/gradient_samples.h"

#include <gtest/gtest.h>

#include "denoise/svgf.h"
#include "estimator/test_scene.h"
#include "render/denoise_frame.h"
#include "render/render_loop.h"

namespace voxlume {
namespace {

using test::grey;

constexpr int kWidth = 121, kHeight = 91;  // neither is a multiple of three
constexpr float kSize_mm = 28;

/// A ball of two materials whose rim is translucent, before a bright background.
const Volume& ball() {
  static const Volume volume = test::make_volume({32, 32, 32}, 1.0, [](Vec3d p) {
    const double stripes = 0.12 * std::sin(p.x / 2) * std::sin(p.z / 2);
    return std::clamp((14 - length(p)) / 3, 0.0, 1.0) * (0.85 + stripes);
  });
  return volume;
}

SceneDescription ball_scene() {
  SceneDescription scene;
  scene.environment.emplace();
  scene.environment->intensity = 0;
  scene.background.emplace();
  scene.background->color = grey(5);
  scene.lights = {test::directional({0.5, 0.7, -0.4}, 3)};
  scene.camera.azimuth_deg = 20;
  scene.image.width = kWidth;
  scene.image.height = kHeight;
  scene.transfer.reference_length_mm = 1;
  scene.transfer.points = {test::point(0.2, 0, grey(0.3f)), test::point(0.75, 1.5, grey(0.4f)),
                           test::point(0.95, 3, grey(0.9f))};
  return scene;
}

struct Shot {
  Film film;
  DenoiseFrame frame;
};

/// Frames of a sequence, each with the gradients against the one before.
class Sequence {
 public:
  Shot shoot(const SceneDescription& description, int spp = 2) {
    const VolumeStatistics statistics = compute_statistics(make_grid_view(ball()));
    const CompiledScene scene(resolve(description, ball(), statistics), ball(), statistics);
    SceneView view = scene.view();
    view.frame = next_frame_++;
    view.keeps_parts = true;
    Shot shot{Film(view.width, view.height, {.normal = true, .albedo = true, .classes = true}), {}};
    const std::vector<TileRect> tiles = make_tiles(view.width, view.height, 16);
    parallel_for(static_cast<std::int64_t>(tiles.size()), 1, [&](std::int64_t i) {
      TraceCounters counters;
      render_tile(view, tiles[i], 0, spp, shot.film, counters);
    });
    fill_denoise_frame(shot.film, view, kSize_mm, shot.frame);
    sampler_.fill(view, shot.film, shot.frame);
    return shot;
  }

 private:
  GradientSampler sampler_;
  std::uint32_t next_frame_ = 0;
};

/// Strata that have matter, those that are valid, and moments of these.
struct Summary {
  int with_matter = 0, valid = 0;
  test::Moments now, before, difference;
  double correlation() const {
    return (now.variance() + before.variance() - difference.variance()) /
           (2 * std::sqrt(now.variance() * before.variance()));
  }
};

template <class Visit>
void for_strata(const DenoiseFrame& frame, const Visit& visit) {
  const Plane& valid = frame.gradients->valid;
  for (int y = 0; y < valid.height(); ++y)
    for (int x = 0; x < valid.width(); ++x) visit(x, y, valid.at(x, y) > 0);
}

Summary summary(const DenoiseFrame& frame) {
  Summary out;
  for_strata(frame, [&](int x, int y, bool valid) {
    bool matter = false;
    for (int j = 3 * y; j < std::min(3 * y + 3, frame.height); ++j)
      for (int i = 3 * x; i < std::min(3 * x + 3, frame.width); ++i) matter |= frame.alpha.at(i, j) > 0;
    out.with_matter += matter;
    out.valid += valid;
    if (!valid) return;
    const float now = frame.gradients->now.at(x, y), before = frame.gradients->before.at(x, y);
    out.now.add(now);
    out.before.add(before);
    out.difference.add(now - before);
  });
  return out;
}

TEST(GradientSampler, ProbeOrbit) {
  for (double step : {0.0, 0.25, 1.0, 3.0}) {
    Sequence sequence;
    SceneDescription scene = ball_scene();
    sequence.shoot(scene);
    scene.camera.azimuth_deg += step;
    const Shot shot = sequence.shoot(scene);
    const Summary s = summary(shot.frame);
    printf(
        "step %.2f matter %d valid %d mean now %.4f before %.4f var now %.4f diff %.4f corr %.3f bias %.4f\n",
        step, s.with_matter, s.valid, s.now.mean(), s.before.mean(), s.now.variance(),
        s.difference.variance(), s.correlation(), s.difference.mean());
  }
}

}  // namespace
}  // namespace voxlume
