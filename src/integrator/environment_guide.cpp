#include "integrator/environment_guide.h"

#include <cmath>

#include "base/parallel.h"
#include "light/direction_bins.h"
#include "light/environment.h"

namespace voxlume {
namespace {

constexpr int kMostCells = 24;
/// A cell's mean extinction is that of this many points along each axis.
constexpr int kPointsPerAxis = 4;
/// A bin's mean radiance is that of this many directions along its height and width.
constexpr int kLooksPerAxis = 8;

/// What is inside the volume and, unless what is cut away still attenuates light, the clip box.
Box3f lit_box(const SceneView& scene) {
  Box3f box;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3f p;
    for (int a = 0; a < 3; ++a)
      p[a] = (corner >> a) & 1 ? scene.domain_index.upper[a] : scene.domain_index.lower[a];
    box.extend(scene.medium.grid.world_from_index.point(p));
  }
  return scene.clip_blocks_light ? box : intersect(box, scene.clip_world);
}

/// mu_t [1/mm] that light meets at a place, 0 outside.
float shadow_extinction_at(const SceneView& scene, Vec3f p_world) {
  const Vec3f p_index = scene.medium.grid.index_from_world.point(p_world);
  if (!scene.domain_index.contains(p_index)) return 0;
  return extinction_at(scene.medium, p_index) * scene.medium.shadow_extinction;
}

/// Mean luminance of the environment in every bin.
std::vector<float> radiance_by_bin(const EnvironmentView& environment) {
  std::vector<float> out(DirectionBins::kCount);
  for (int bin = 0; bin < DirectionBins::kCount; ++bin) {
    float sum = 0;
    for (int look = 0; look < kLooksPerAxis * kLooksPerAxis; ++look) {
      const float u0 = (static_cast<float>(look % kLooksPerAxis) + 0.5f) / kLooksPerAxis;
      const float u1 = (static_cast<float>(look / kLooksPerAxis) + 0.5f) / kLooksPerAxis;
      sum += luminance(eval_environment(environment, DirectionBins::direction_in(bin, u0, u1)).radiance);
    }
    out[static_cast<std::size_t>(bin)] = sum / (kLooksPerAxis * kLooksPerAxis);
  }
  return out;
}

/// Sweeps one direction. Axis `main` is the direction's longest; s, t are the others.
class Sweep {
 public:
  Sweep(const CoarseMedium& medium, Vec3f direction) : medium_(medium), visibility_(medium.cell_count()) {
    for (int a = 1; a < 3; ++a)
      if (std::abs(direction[a]) > std::abs(direction[main_])) main_ = a;
    s_ = (main_ + 1) % 3;
    t_ = (main_ + 2) % 3;
    const Vec3f extent = medium.cell_extent();
    way_mm_ = extent[main_] / std::abs(direction[main_]);
    shift_s_ = direction[s_] * way_mm_ / extent[s_];
    shift_t_ = direction[t_] * way_mm_ / extent[t_];
    up_ = direction[main_] > 0;
    leaving_.resize(plane_size());
  }

  std::vector<float> run() {
    std::vector<float> entering(plane_size());
    for (int i = 0; i < medium_.count[main_]; ++i) {
      const int plane = up_ ? medium_.count[main_] - 1 - i : i;
      const bool first = i == 0;
      for (int t = 0; t < medium_.count[t_]; ++t)
        for (int s = 0; s < medium_.count[s_]; ++s)
          entering[at(s, t)] =
              first ? 1.0f : light_before(static_cast<float>(s) + shift_s_, static_cast<float>(t) + shift_t_);
      for (int t = 0; t < medium_.count[t_]; ++t)
        for (int s = 0; s < medium_.count[s_]; ++s) {
          const std::size_t cell = cell_at(plane, s, t);
          const float depth = medium_.mu_t[cell] * way_mm_;
          visibility_[cell] = entering[at(s, t)] * std::exp(-0.5f * depth);
          leaving_[at(s, t)] = entering[at(s, t)] * std::exp(-depth);
        }
    }
    return std::move(visibility_);
  }

 private:
  std::size_t plane_size() const {
    return static_cast<std::size_t>(medium_.count[s_]) * static_cast<std::size_t>(medium_.count[t_]);
  }
  std::size_t at(int s, int t) const { return static_cast<std::size_t>(t * medium_.count[s_] + s); }
  std::size_t cell_at(int plane, int s, int t) const {
    int c[3];
    c[main_] = plane;
    c[s_] = s;
    c[t_] = t;
    return static_cast<std::size_t>((c[2] * medium_.count[1] + c[1]) * medium_.count[0] + c[0]);
  }
  /// What left the plane before at a place between its cells; beside the box nothing is in the way.
  float light_before(float s, float t) const {
    const float s0 = std::floor(s), t0 = std::floor(t);
    const auto one = [&](float i, float j) {
      if (!(i >= 0 && i < static_cast<float>(medium_.count[s_]) && j >= 0 &&
            j < static_cast<float>(medium_.count[t_])))
        return 1.0f;
      return leaving_[at(static_cast<int>(i), static_cast<int>(j))];
    };
    const float fs = s - s0, ft = t - t0;
    return (one(s0, t0) * (1 - fs) + one(s0 + 1, t0) * fs) * (1 - ft) +
           (one(s0, t0 + 1) * (1 - fs) + one(s0 + 1, t0 + 1) * fs) * ft;
  }

  const CoarseMedium& medium_;
  int main_ = 0, s_, t_;
  float way_mm_;             ///< along the direction, from plane to plane
  float shift_s_, shift_t_;  ///< cells, from plane to plane
  bool up_;
  std::vector<float> visibility_, leaving_;
};

}  // namespace

CoarseMedium coarse_medium(const SceneView& scene, int most_cells) {
  CoarseMedium out;
  out.box = lit_box(scene);
  const Vec3f extent = out.box.extent();
  std::size_t cells = 1;
  for (int a = 0; a < 3; ++a) {
    const float share = extent[a] / max_component(extent);
    out.count[a] = std::max(1, static_cast<int>(std::lround(share * static_cast<float>(most_cells))));
    cells *= static_cast<std::size_t>(out.count[a]);
  }
  out.mu_t.resize(cells);
  const Vec3f cell = out.cell_extent();
  parallel_for(static_cast<std::int64_t>(cells), 64, [&](std::int64_t i) {
    const auto first =
        Vec3f(static_cast<float>(i % out.count[0]), static_cast<float>(i / out.count[0] % out.count[1]),
              static_cast<float>(i / out.count[0] / out.count[1]));
    float sum = 0;
    for (int k = 0; k < kPointsPerAxis; ++k)
      for (int j = 0; j < kPointsPerAxis; ++j)
        for (int l = 0; l < kPointsPerAxis; ++l) {
          const Vec3f inside((static_cast<float>(l) + 0.5f) / kPointsPerAxis,
                             (static_cast<float>(j) + 0.5f) / kPointsPerAxis,
                             (static_cast<float>(k) + 0.5f) / kPointsPerAxis);
          sum += shadow_extinction_at(scene, out.box.lower + (first + inside) * cell);
        }
    out.mu_t[static_cast<std::size_t>(i)] = sum / (kPointsPerAxis * kPointsPerAxis * kPointsPerAxis);
  });
  return out;
}

std::vector<float> sweep_visibility(const CoarseMedium& medium, Vec3f direction) {
  return Sweep(medium, direction).run();
}

EnvironmentGuide::EnvironmentGuide(const SceneView& scene) {
  const CoarseMedium medium = coarse_medium(scene, kMostCells);
  const std::vector<float> radiance = radiance_by_bin(scene.lights.environment);
  std::vector<std::vector<float>> visibility(DirectionBins::kCount);
  parallel_for(DirectionBins::kCount, 1, [&](std::int64_t bin) {
    visibility[static_cast<std::size_t>(bin)] =
        sweep_visibility(medium, DirectionBins::direction_in(static_cast<int>(bin), 0.5f, 0.5f));
  });
  constexpr std::size_t kStride = DirectionBins::kCount + 1;
  cdf_.resize(medium.cell_count() * kStride);
  parallel_for(static_cast<std::int64_t>(medium.cell_count()), 64, [&](std::int64_t i) {
    const auto cell = static_cast<std::size_t>(i);
    std::vector<double> weights(DirectionBins::kCount);
    for (std::size_t bin = 0; bin < weights.size(); ++bin)
      weights[bin] = double{radiance[bin]} * double{visibility[bin][cell]};
    const Distribution1D distribution(weights);
    std::copy_n(distribution.view().cdf, kStride, cdf_.begin() + static_cast<std::ptrdiff_t>(cell * kStride));
  });
  view_.box = medium.box;
  std::copy_n(medium.count, 3, view_.count);
}

EnvironmentGuideView EnvironmentGuide::view() const {
  EnvironmentGuideView out = view_;
  out.cdf = cdf_.data();
  return out;
}

}  // namespace voxlume
