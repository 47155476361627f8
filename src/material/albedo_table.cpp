#include "material/albedo_table.h"

#include <cstdint>
#include <numbers>
#include <vector>

#include "base/parallel.h"

namespace voxlume {
namespace {

/// Means over the half vectors that sample_visible_normal draws. They are those of a cap of directions; in
/// its azimuth and height integrands vary over lengths of order one, however small alpha. Masking and total
/// reflection bend them along curves, where a lattice of points does better than rules for smooth functions.
class CapLattice {
 public:
  struct Point {
    double x, y, depth;  ///< of the azimuth, in [0, pi]; the share of the cap's area above
  };

  /// `count` and `generator` are neighbours in Fibonacci's sequence.
  CapLattice(int count, int generator) {
    for (int i = 0; i < count; ++i) {
      const double azimuth = (i + 0.5) / count * std::numbers::pi;
      const double depth =
          (static_cast<double>(static_cast<std::int64_t>(i) * generator % count) + 0.5) / count;
      points_.push_back({std::cos(azimuth), std::sin(azimuth), depth});
    }
  }
  const std::vector<Point>& points() const { return points_; }

 private:
  std::vector<Point> points_;
};

/// wo at a cosine, and GGX about +z.
struct View {
  Vec3d wo, stretched;
  double alpha, smith_o;

  View(double cosine, double width)
      : wo(std::sqrt((1.0 - cosine) * (1.0 + cosine)), 0.0, cosine),
        stretched(normalize(Vec3d(width * wo.x, 0.0, cosine))),
        alpha(width),
        smith_o(smith(cosine)) {}

  double smith(double cosine) const {
    return std::sqrt(cosine * cosine + alpha * alpha * (1.0 - cosine) * (1.0 + cosine));
  }
  Vec3d half(const CapLattice::Point& at) const {
    const double z = 1.0 - at.depth * (1.0 + stretched.z);
    const double s = std::sqrt(std::max(0.0, (1.0 - z) * (1.0 + z)));
    return normalize(Vec3d(alpha * (s * at.x + stretched.x), alpha * s * at.y, z + stretched.z));
  }
  /// G2 / G1(wo) for a wi at a cosine; 0 on the wrong side.
  double unmasked(double cosine) const {
    const double c = std::min(cosine, 1.0);
    return c > 0.0 ? c * (wo.z + smith_o) / (c * smith_o + wo.z * smith(c)) : 0.0;
  }
};

AlbedoEntry mirror_entry(const CapLattice& lattice, double cosine, double alpha) {
  const View view(cosine, alpha);
  double albedo = 0.0, schlick = 0.0;
  for (const CapLattice::Point& point : lattice.points()) {
    const Vec3d h = view.half(point);
    const double cos_d = dot(view.wo, h);
    const double kept = view.unmasked(2.0 * cos_d * h.z - cosine);
    const double m = std::max(0.0, 1.0 - cos_d), m2 = m * m;
    albedo += kept;
    schlick += kept * m2 * m2 * m;
  }
  return {static_cast<float>(albedo / static_cast<double>(lattice.points().size())),
          static_cast<float>(schlick / albedo)};
}

AlbedoEntry glass_entry(const CapLattice& lattice, double cosine, double alpha, double eta) {
  const View view(cosine, alpha);
  double reflected = 0.0, refracted = 0.0;
  for (const CapLattice::Point& point : lattice.points()) {
    const Vec3d h = view.half(point);
    const double cos_d = std::min(dot(view.wo, h), 1.0);
    const double fresnel = fresnel_dielectric(cos_d, eta);
    reflected += fresnel * view.unmasked(2.0 * cos_d * h.z - cosine);
    if (fresnel < 1.0) refracted += (1.0 - fresnel) * view.unmasked(-refract(view.wo, h, eta).z);
  }
  const double albedo = reflected + refracted;
  return {static_cast<float>(albedo / static_cast<double>(lattice.points().size())),
          static_cast<float>(albedo > 0.0 ? reflected / albedo : 1.0)};
}

}  // namespace

const AlbedoTable& ggx_albedo() noexcept {
  // On this thread alone: tasks that a parallel loop picks up while it waits could ask for the table, too.
  static const AlbedoTable table = [] {
    const CapLattice lattice(4181, 2584);
    AlbedoTable made;
    for (int row = 0; row < AlbedoTable::kWidths; ++row)
      made.fill_row(row, [&](double cosine, double alpha) { return mirror_entry(lattice, cosine, alpha); });
    return made;
  }();
  return table;
}

GlassAlbedo::GlassAlbedo(float ior) : ior_(ior) {
  if (!(ior >= kMinIor)) return;
  sides_ = std::make_unique<std::array<AlbedoTable, 2>>();
  const CapLattice lattice(1597, 987);
  parallel_for(2 * AlbedoTable::kWidths, 1, [&](std::int64_t i) {
    const double eta = i % 2 == 0 ? double{ior} : 1.0 / double{ior};
    (*sides_)[static_cast<std::size_t>(i % 2)].fill_row(
        static_cast<int>(i / 2),
        [&](double cosine, double alpha) { return glass_entry(lattice, cosine, alpha, eta); });
  });
}

}  // namespace voxlume
