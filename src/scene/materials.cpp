#include "scene/materials.h"

#include <map>
#include <mutex>

#include "integrator/scene_view.h"
#include "scene/material_library.h"

namespace voxlume {
namespace {

constexpr double kUsualIor = 1.5;

/// The table of an index of refraction: that of the usual glass is made once, others are shared while a scene
/// has them.
std::shared_ptr<const GlassAlbedo> glass_table(float ior) {
  static const auto usual = std::make_shared<const GlassAlbedo>(static_cast<float>(kUsualIor));
  if (ior == usual->ior()) return usual;
  static std::mutex mutex;
  static std::map<float, std::weak_ptr<const GlassAlbedo>> others;
  const std::lock_guard lock(mutex);
  std::erase_if(others, [](const auto& one) { return one.second.expired(); });
  std::shared_ptr<const GlassAlbedo> table = others[ior].lock();
  if (!table) others[ior] = table = std::make_shared<const GlassAlbedo>(ior);
  return table;
}

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
    if (view.transmission > 0) {
      glass_.push_back(glass_table(view.ior));
      view.glass = glass_.back().get();
    }
    views_.push_back(view);
  }
}

}  // namespace voxlume
