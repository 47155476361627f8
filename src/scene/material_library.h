#pragma once
#include <string_view>
#include <vector>

#include "voxlume/scene.h"

namespace voxlume {

/// A material that scenes may name without defining it.
struct LibraryMaterial {
  NamedMaterialDescription description;  ///< its name included; no opacity
  std::string_view summary;              ///< one line for `voxlume materials`
};

/// Every material of the library, in the order in which they are listed.
const std::vector<LibraryMaterial>& material_library();

/// The scene's materials with what `like` gives filled in, then the library's. Throws Error kBadParameter
/// with the JSON path of a name that is empty or there twice, or of a `like` that the library has not.
std::vector<NamedMaterialDescription> all_materials(const std::vector<NamedMaterialDescription>& own);

}  // namespace voxlume
