#pragma once
#include "accel/hierarchy_view.h"
#include "accel/majorant_view.h"

namespace voxlume {

enum class AcceleratorKind { kMacrocell, kHierarchy };

/// One of the structures that bound the extinction along a ray.
struct AcceleratorView {
  AcceleratorKind kind = AcceleratorKind::kMacrocell;
  MajorantView macrocell;
  HierarchyView hierarchy;

  AcceleratorView() = default;
  AcceleratorView(const MajorantView& view) : kind(AcceleratorKind::kMacrocell), macrocell(view) {}
  AcceleratorView(const HierarchyView& view) : kind(AcceleratorKind::kHierarchy), hierarchy(view) {}
};

/// Calls visit(walk) with a walk of `origin + t * direction` from t = 0 to length_mm; walk.next(segment)
/// gives its runs in order. The origin is in the domain, up to rounding.
template <class Visit>
void with_walk(const AcceleratorView& view, Vec3f origin_index, Vec3f direction_index, float length_mm,
               Visit&& visit) noexcept {
  switch (view.kind) {
    case AcceleratorKind::kMacrocell: {
      MacrocellWalk walk(view.macrocell, origin_index, direction_index, 0.0f, length_mm);
      return visit(walk);
    }
    case AcceleratorKind::kHierarchy: {
      const HierarchyRay ray = make_hierarchy_ray(view.hierarchy, origin_index, direction_index, length_mm);
      HierarchyWalk walk(view.hierarchy, ray);
      return visit(walk);
    }
  }
}

}  // namespace voxlume
