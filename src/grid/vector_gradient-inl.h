// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_GRID_VECTOR_GRADIENT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_GRID_VECTOR_GRADIENT_INL_H_
#undef VOXLUME_GRID_VECTOR_GRADIENT_INL_H_
#else
#define VOXLUME_GRID_VECTOR_GRADIENT_INL_H_
#endif

#include <hwy/highway.h>

#include "grid/sample.h"
#include "grid/voxel_pairs-inl.h"
#include "sampling/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// sample_trilinear of each lane; the grid is at least two voxels wide.
template <class Voxel, class D, class F = hn::Vec<D>>
F vector_interpolate(D d, const GridView& grid, Vector3<F> p_index) {
  constexpr std::size_t kN = hn::MaxLanes(D());
  const hn::RebindToSigned<D> di;
  alignas(64) std::int32_t base[3][kN];
  F fraction[3];
  const F coordinate[3] = {p_index.x, p_index.y, p_index.z};
  for (int a = 0; a < 3; ++a) {
    const F p = clamped(coordinate[a], 0.0f, static_cast<float>(grid.size[a] - 1));
    const auto i = hn::Min(hn::ConvertTo(di, p), hn::Set(di, std::max(grid.size[a] - 2, 0)));
    fraction[a] = p - hn::ConvertTo(d, i);
    hn::Store(i, di, base[a]);
  }
  const auto* voxels = static_cast<const Voxel*>(grid.voxels);
  const std::int64_t next_j = grid.size[1] > 1 ? grid.stride_j : 0,
                     next_k = grid.size[2] > 1 ? grid.stride_k : 0;
  alignas(64) typename VoxelPairs<Voxel, kN>::Columns columns;
  VoxelPairs<Voxel, kN> pairs(columns, 0);
  for (std::size_t lane = 0; lane < kN; ++lane)
    pairs.fetch(lane, voxels + base[0][lane] + base[1][lane] * grid.stride_j + base[2][lane] * grid.stride_k,
                next_j, next_k);
  return pairs.interpolate(d, fraction);
}

/// sample_gradient of each lane; the grid is at least two voxels wide.
template <class D, class F = hn::Vec<D>>
Vector3<F> vector_gradient(D d, const GridView& grid, Vector3<F> p_index) {
  return with_voxel_type(grid.type, [&](auto voxel) {
    using Voxel = decltype(voxel);
    F along[3];
    for (int a = 0; a < 3; ++a) {
      Vec3f one;
      one[a] = grid.step_index[a];
      const Vector3<F> offset = broadcast<F>(one);
      along[a] = (vector_interpolate<Voxel>(d, grid, p_index + offset) -
                  vector_interpolate<Voxel>(d, grid, p_index - offset)) /
                 broadcast<F>(2.0f * grid.step_mm);
    }
    const Vector3<F> step = broadcast<F>(grid.step_index);
    const Vector3<F> per_voxel{along[0] * step.x, along[1] * step.y, along[2] * step.z};
    return mapped_vector(grid.world_from_index, per_voxel) / broadcast<F>(grid.step_mm);
  });
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
