#pragma once
#include <functional>

#include "accel/majorant_grid.h"
#include "base/box.h"
#include "support/transfers.h"
#include "support/volumes.h"
#include "tracking/tracking.h"

namespace voxlume::test {

constexpr int kGlobal = 1 << 20;  ///< cell edge that gives one majorant for the whole volume

/// A volume, a function and a majorant grid that live as long as the medium made of them.
struct TrackedMedium {
  TrackedMedium(Volume volume_, const TransferDescription& description, int cell_voxels,
                CellMinima minima = CellMinima::kNone)
      : volume(std::move(volume_)),
        function(description),
        majorants(make_grid_view(volume), cell_voxels, minima) {
    majorants.update(function);
    medium = {make_grid_view(volume), function.view(), majorants.view()};
  }
  TrackedMedium(const TrackedMedium&) = delete;

  Interval<float> inside(const IndexRay& ray) const {
    return clip_ray(medium.grid.index_box(), ray.origin_index, ray.direction_index, 0.0f,
                    std::numeric_limits<float>::infinity());
  }

  Volume volume;
  TransferFunction function;
  MajorantGrid majorants;
  Medium medium;
};

/// mu_t equals the data, for data in [0, upper].
inline TransferDescription identity_function(double upper) { return mu_t_function({{0, 0}, {upper, upper}}); }

/// The optical depth of [t_near, t_far] by Simpson's rule, from the voxels and the function's points in
/// double.
template <class T>
double reference_optical_depth(const Volume& volume, const CurvePoints& points, const IndexRay& ray,
                               double t_near, double t_far, int panels) {
  const auto mu_t = [&](double t) {
    const Vec3d p = Vec3d(ray.origin_index) + Vec3d(ray.direction_index) * t;
    return curve_at(points, reference_trilinear<T>(volume, p));
  };
  const double h = (t_far - t_near) / panels;
  double sum = 0;
  for (int i = 0; i < panels; ++i)
    sum += (mu_t(t_near + i * h) + 4 * mu_t(t_near + (i + 0.5) * h) + mu_t(t_near + (i + 1) * h)) / 6;
  return sum * h;
}

}  // namespace voxlume::test
