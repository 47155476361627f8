#pragma once
#include "voxlume/scene.h"

namespace voxlume {

/// Sets what the scene's integrator demands of its other fields (docs/peers.md): ray-march scatters once,
/// exposure-render and rmss do and have Exposure Render's shading in place of coexistence. Once more changes
/// nothing.
void apply_integrator(SceneDescription& scene);

/// The scene with the rule that ar2t stands for, which gives materials by the opacity of the transfer
/// function's own points, before its own rules; materials of the scene that have their names take their
/// places. Throws Error kUnsupported, at /render/integrator, without such points or with rules that are not
/// merged by priority, and at /transfer/rules where there is no room for one more.
SceneDescription with_opacity_materials(SceneDescription scene);

}  // namespace voxlume
