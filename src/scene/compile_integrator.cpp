#include "scene/compile.h"

namespace voxlume {

void CompiledScene::put_integrator(const SceneDescription& local, const SceneSphere& sphere,
                                   bool same_light) {
  const RenderDescription& render = local.render;
  if (!same_light) {
    environment_guide_.reset();
    virtual_lights_.reset();
    if (render.integrator == Integrator::kRmss && view_.lights.has_environment)
      environment_guide_.emplace(view_);
    if (render.integrator == Integrator::kVplDvr) {
      VirtualLightChoice choice;
      choice.count = render.virtual_lights;
      choice.max_scatter = render.max_scatter;
      choice.step_mm = view_.trackers.step_mm;
      choice.nearest_mm = static_cast<float>(render.virtual_light_radius) * sphere.radius_mm;
      choice.seed = render.seed;
      virtual_lights_.emplace(view_, sphere, choice);
    }
  }
  view_.lights.guide = environment_guide_ ? environment_guide_->view() : EnvironmentGuideView{};
  view_.virtual_lights = virtual_lights_ ? virtual_lights_->view() : VirtualLightsView{};
  if (virtual_lights_) view_.max_scatter = 1;
}

}  // namespace voxlume
