#pragma once
#include <map>
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
  const GlassAlbedo* glass(float ior);

  std::vector<NamedMaterialDescription> named_;
  std::vector<Material> views_;
  std::map<float, std::unique_ptr<GlassAlbedo>> glass_;  ///< by index of refraction
};

}  // namespace voxlume
