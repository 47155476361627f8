#pragma once
#include <optional>
#include <variant>

#include "accel/accelerator_view.h"
#include "accel/hierarchy.h"
#include "accel/majorant_grid.h"
#include "accel/octree.h"
#include "accel/residency.h"

namespace voxlume {

struct AcceleratorChoice {
  AcceleratorKind kind = AcceleratorKind::kHierarchy;
  int cell_voxels = 0;                    ///< edge of the finest cells; 0: the kind's own choice
  HierarchyCosts costs;                   ///< kHierarchy
  OctreeThresholds thresholds;            ///< kThresholdOctree
  CellMinima minima = CellMinima::kNone;  ///< of kMacrocell
};

/// Bounds of the extinction of one volume, by the chosen structure. Its value ranges are built once; update()
/// must follow before view() is used.
class Accelerator {
 public:
  Accelerator(const GridView& grid, const AcceleratorChoice& choice);

  void update(const TransferFunction& transfer);
  /// The same under rules of the main volume and its proxies; `main` is the constructor's grid. What the
  /// volumes hold in the cells is found at the first call and after forget_volumes(). Throws Error
  /// kUnsupported for the structures that bound one function of one volume only.
  void update(const GridView& main, const Classifier& classifier);
  /// To be called when other volumes are to be read by rules.
  void forget_volumes() { bounds_.reset(); }
  AcceleratorView view() const;

 private:
  using Structure =
      std::variant<MajorantGrid, MajorantHierarchy, SkippingOctree, ThresholdOctree, ResidencyOctree>;
  static Structure build(const GridView& grid, const AcceleratorChoice& choice);
  Structure structure_;
  std::optional<RuleBounds> bounds_;
};

}  // namespace voxlume
