#pragma once
#include <span>

#include "base/progress.h"
#include "voxlume/volume.h"

namespace voxlume {

/// Volumes computed from another one, whose voxels stand for something else than the data itself. All are f32
/// on the grid of the volume given, of any voxel type, and are computed on all threads. All throw Error
/// kOutOfMemory, before anything is allocated, when their working memory is more than the machine has left.
/// `progress` may be empty; what it throws ends them.

/// Length of sample_gradient at every voxel centre [data units per mm]: central differences of the
/// neighbours, which at the border are continued. NaN where a difference is (of NaN or infinite voxels).
Volume gradient_magnitude(const Volume& volume, const Progress& progress = {});

/// The volume convolved with a Gaussian of standard deviation `sigma_mm` along every axis [mm]; beyond the
/// border the outermost voxels go on. Voxels that are not finite count as the smallest finite value (0 when
/// there is none), so that they leave no hole. Along an axis of one voxel nothing happens, along one of two
/// or three sigma is at most 3 voxels. Throws Error kBadParameter unless `sigma_mm` >= 0 and finite.
Volume smoothed(const Volume& volume, double sigma_mm, const Progress& progress = {});

/// What signed_distance gives where there is no boundary at all [mm].
inline constexpr float kNoBoundary_mm = 1e6f;

/// Distance of every voxel centre from the boundary of the union of the labels `inside` [mm], positive inside
/// and negative outside. A voxel belongs to the union when its value, as the float sample_nearest returns, is
/// in `inside`. The distance is the exact Euclidean one to the nearest voxel centre of the other side, less
/// half a voxel along that direction: exact for flat boundaries along the axes, else within half of a voxel's
/// longest side. The volume's own border is no boundary. When every voxel is inside all are kNoBoundary_mm,
/// when none is -kNoBoundary_mm.
Volume signed_distance(const Volume& labels, std::span<const float> inside, const Progress& progress = {});

}  // namespace voxlume
