#include "scene/peers.h"

#include <algorithm>
#include <string>

#include "transfer/classifier_view.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

/// A material of AR2T and the opacity from which it holds. The thresholds are ours: the paper's are for its
/// own volumes.
struct OpacityMaterial {
  double from_opacity;
  NamedMaterialDescription material;
};

std::vector<OpacityMaterial> ar2t_materials() {
  NamedMaterialDescription dielectric, matte, glossy, metal;
  dielectric.name = "ar2t dielectric";
  dielectric.transmission = 1;
  dielectric.ior = 1.5;
  dielectric.roughness = 0.2;
  matte.name = "ar2t matte";
  matte.specular = 0;
  glossy.name = "ar2t glossy";
  glossy.specular = 1;
  glossy.roughness = 0.3;
  metal.name = "ar2t metal";
  metal.metallic = 1;
  metal.roughness = 0.35;
  return {{0, dielectric}, {0.1, matte}, {0.4, glossy}, {0.7, metal}};
}

[[noreturn]] void refuse(const char* where, const std::string& why) {
  throw Error(ErrorCode::kUnsupported, where, why);
}

}  // namespace

void apply_integrator(SceneDescription& scene) {
  const Integrator integrator = scene.render.integrator;
  if (integrator == Integrator::kRayMarch) scene.render.max_scatter = 1;
  if (integrator != Integrator::kExposureRender && integrator != Integrator::kRmss) return;
  scene.render.max_scatter = 1;
  if (scene.material.shading == Shading::kCoexistence) scene.material.shading = Shading::kExposureRender;
}

/// AR2T (Denisova et al. 2022, "AR2T: advanced realistic rendering technique for biomedical volumes"):
/// dielectric where the opacity is low, metal where it is high, matte and glossy surfaces between.
SceneDescription with_opacity_materials(SceneDescription scene) {
  TransferDescription& transfer = scene.transfer;
  if (transfer.points.empty()) refuse("/render/integrator", "ar2t needs a transfer function with points");
  if (!transfer.rules.empty() && transfer.merge != Merge::kPriority)
    refuse("/render/integrator", "ar2t needs rules that are merged by priority");
  if (transfer.rules.size() + 2 > static_cast<std::size_t>(kMostRules))
    refuse("/transfer/rules", "found " + std::to_string(transfer.rules.size()) +
                                  " rules; ar2t, which adds one, takes at most " +
                                  std::to_string(kMostRules - 2));
  RuleDescription rule;
  rule.kind = RuleKind::kMaterialSteps;
  rule.volume = "opacity";
  for (const OpacityMaterial& step : ar2t_materials()) {
    TransferPoint point;
    point.value = step.from_opacity;
    point.material = step.material.name;
    rule.points.push_back(point);
    const bool known =
        std::any_of(scene.materials.begin(), scene.materials.end(),
                    [&](const NamedMaterialDescription& m) { return m.name == step.material.name; });
    if (!known) scene.materials.push_back(step.material);
  }
  transfer.rules.insert(transfer.rules.begin(), rule);
  transfer.merge = Merge::kPriority;
  return scene;
}

}  // namespace voxlume
