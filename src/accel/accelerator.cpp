#include "accel/accelerator.h"

#include "voxlume/error.h"

namespace voxlume {

Accelerator::Structure Accelerator::build(const GridView& grid, const AcceleratorChoice& choice) {
  const auto voxels = [&](int own_choice) {
    return choice.cell_voxels > 0 ? choice.cell_voxels : own_choice;
  };
  switch (choice.kind) {
    case AcceleratorKind::kMacrocell:
      return MajorantGrid(grid, voxels(default_macrocell_voxels(grid)), choice.minima);
    case AcceleratorKind::kSkippingOctree:
      return SkippingOctree(grid, voxels(default_macrocell_voxels(grid)));
    case AcceleratorKind::kThresholdOctree:
      return ThresholdOctree(grid, voxels(default_hierarchy_voxels(grid)), choice.thresholds);
    case AcceleratorKind::kResidency:
      return ResidencyOctree(grid, voxels(default_brick_voxels(grid)));
    case AcceleratorKind::kHierarchy:
      break;
  }
  return MajorantHierarchy(grid, voxels(default_hierarchy_voxels(grid)), choice.costs);
}

Accelerator::Accelerator(const GridView& grid, const AcceleratorChoice& choice)
    : structure_(build(grid, choice)) {}

void Accelerator::update(const TransferFunction& transfer) {
  std::visit([&](auto& structure) { structure.update(transfer); }, structure_);
}

void Accelerator::update(const GridView& main, const Classifier& classifier) {
  const auto update_by = [&](auto& structure, CellOrder order) {
    if (!bounds_) bounds_.emplace(main, structure.cell_voxels(), order, classifier.volumes());
    bounds_->prepare(classifier);
    structure.update(*bounds_);
  };
  if (auto* hierarchy = std::get_if<MajorantHierarchy>(&structure_)) {
    update_by(*hierarchy, CellOrder::kCubes);
  } else if (auto* grid = std::get_if<MajorantGrid>(&structure_)) {
    update_by(*grid, CellOrder::kRows);
  } else {
    throw Error(ErrorCode::kUnsupported, "/render/accelerator",
                "rules need auto, hierarchy (by cost), macrocell or none");
  }
}

AcceleratorView Accelerator::view() const {
  return std::visit([](const auto& structure) -> AcceleratorView { return structure.view(); }, structure_);
}

}  // namespace voxlume
