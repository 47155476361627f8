#include "scene/materials.h"

#include "integrator/scene_view.h"
#include "scene/material_library.h"

namespace voxlume {
namespace {

constexpr double kUsualIor = 1.5;

}  // namespace

Materials::Materials(const MaterialDescription& base, const std::vector<NamedMaterialDescription>& own)
    : named_(all_materials(own)) {
  Material first{};
  first.alpha = static_cast<float>(base.roughness * base.roughness);
  first.f0 = kMostDielectricF0 * static_cast<float>(base.specular);
  first.g = static_cast<float>(base.anisotropy);
  first.ior = static_cast<float>(kUsualIor);
  views_.push_back(first);
  for (const NamedMaterialDescription& named : named_) {
    Material view = first;
    const auto number = [](const std::optional<double>& x, double otherwise) {
      return static_cast<float>(x.value_or(otherwise));
    };
    const double roughness = named.roughness.value_or(base.roughness);
    view.alpha = static_cast<float>(roughness * roughness);
    view.f0 = kMostDielectricF0 * number(named.specular, base.specular);
    view.metallic = number(named.metallic, 0);
    view.transmission = number(named.transmission, 0);
    view.ior = number(named.ior, kUsualIor);
    view.diffuse_roughness = number(named.diffuse_roughness, 0);
    view.g = number(named.anisotropy, base.anisotropy);
    view.g_back = number(named.back_anisotropy, 0);
    view.back_share = number(named.back_share, 0);
    if (view.transmission > 0) view.glass = glass(view.ior);
    views_.push_back(view);
  }
}

const GlassAlbedo* Materials::glass(float ior) {
  std::unique_ptr<GlassAlbedo>& table = glass_[ior];
  if (!table) table = std::make_unique<GlassAlbedo>(ior);
  return table.get();
}

}  // namespace voxlume
