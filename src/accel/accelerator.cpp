#include "accel/accelerator.h"

namespace voxlume {

Accelerator::Structure Accelerator::build(const GridView& grid, const AcceleratorChoice& choice) {
  const int given = choice.cell_voxels;
  switch (choice.kind) {
    case AcceleratorKind::kMacrocell:
      return MajorantGrid(grid, given > 0 ? given : default_macrocell_voxels(grid), choice.minima);
    case AcceleratorKind::kHierarchy:
      break;
  }
  return MajorantHierarchy(grid, given > 0 ? given : default_hierarchy_voxels(grid), choice.costs);
}

Accelerator::Accelerator(const GridView& grid, const AcceleratorChoice& choice)
    : structure_(build(grid, choice)) {}

void Accelerator::update(const TransferFunction& transfer) {
  std::visit([&](auto& structure) { structure.update(transfer); }, structure_);
}

AcceleratorView Accelerator::view() const {
  return std::visit([](const auto& structure) -> AcceleratorView { return structure.view(); }, structure_);
}

}  // namespace voxlume
