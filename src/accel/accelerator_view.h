#pragma once
#include "accel/hierarchy_view.h"
#include "accel/majorant_view.h"
#include "accel/octree_view.h"
#include "accel/residency_view.h"

namespace voxlume {

enum class AcceleratorKind {
  kMacrocell,        ///< a uniform grid; one cell alone is a global majorant
  kHierarchy,        ///< blocks joined by cost
  kSkippingOctree,   ///< xu2024: macrocells, and an octree over what is empty
  kThresholdOctree,  ///< xu2025: a complete octree, walked by thresholds
  kResidency         ///< a sparse octree over bricks
};

/// One of the structures that bound the extinction along a ray.
struct AcceleratorView {
  AcceleratorKind kind = AcceleratorKind::kMacrocell;
  MajorantView macrocell;
  HierarchyView hierarchy;
  SkippingOctreeView skipping_octree;
  ThresholdOctreeView threshold_octree;
  ResidencyView residency;

  AcceleratorView() = default;
  AcceleratorView(const MajorantView& view) : kind(AcceleratorKind::kMacrocell), macrocell(view) {}
  AcceleratorView(const HierarchyView& view) : kind(AcceleratorKind::kHierarchy), hierarchy(view) {}
  AcceleratorView(const SkippingOctreeView& view)
      : kind(AcceleratorKind::kSkippingOctree), skipping_octree(view) {}
  AcceleratorView(const ThresholdOctreeView& view)
      : kind(AcceleratorKind::kThresholdOctree), threshold_octree(view) {}
  AcceleratorView(const ResidencyView& view) : kind(AcceleratorKind::kResidency), residency(view) {}
};

/// Calls visit(walk) with a walk of `origin + t * direction` from t = 0 to length_mm; walk.next(segment)
/// gives its runs in order. The origin is in the domain, up to rounding.
template <class Visit>
void with_walk(const AcceleratorView& view, Vec3f origin_index, Vec3f direction_index, float length_mm,
               Visit&& visit) noexcept {
  const auto visit_blocks = [&](const auto& blocks) {
    const BlockRay ray = make_block_ray(blocks.domain, origin_index, direction_index, length_mm);
    BlockWalk walk(blocks, ray);
    visit(walk);
  };
  switch (view.kind) {
    case AcceleratorKind::kMacrocell: {
      MacrocellWalk walk(view.macrocell, origin_index, direction_index, 0.0f, length_mm);
      return visit(walk);
    }
    case AcceleratorKind::kHierarchy:
      return visit_blocks(view.hierarchy);
    case AcceleratorKind::kSkippingOctree:
      return visit_blocks(view.skipping_octree);
    case AcceleratorKind::kThresholdOctree:
      return visit_blocks(view.threshold_octree);
    case AcceleratorKind::kResidency:
      return visit_blocks(view.residency);
  }
}

}  // namespace voxlume
