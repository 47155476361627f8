#pragma once
#include <memory>
#include <span>
#include <vector>

#include "material/albedo_table.h"
#include "material/material.h"
#include "voxlume/scene.h"

namespace voxlume {

/// A scene's materials as kernels see them.
class Materials {
 public:
  /// `base` is what named materials leave open. Throws Error as all_materials does.
  Materials(const MaterialDescription& base, const std::vector<NamedMaterialDescription>& own);

  /// The scene's own and the library's, in the order in which rules number them.
  std::span<const NamedMaterialDescription> named() const { return named_; }
  /// The base material, then the named ones.
  const Material* views() const { return views_.data(); }

 private:
  std::vector<NamedMaterialDescription> named_;
  std::vector<Material> views_;
  std::vector<std::shared_ptr<const GlassAlbedo>> glass_;  ///< what views_ point to
};

}  // namespace voxlume
