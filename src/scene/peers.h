#pragma once
#include "voxlume/scene.h"

namespace voxlume {

/// Writes out what the scene's integrator stands for, where that is another renderer's picture of the scene
/// (docs/peers.md): exposure-render and rmss scatter once and have Exposure Render's shading in place of
/// coexistence; ar2t becomes path tracing under a rule that gives materials by the opacity of the transfer
/// function's own points, which comes before the scene's rules. Once more changes nothing. Throws Error
/// kUnsupported (/render/integrator) for ar2t without such points, or with rules that are not merged by
/// priority.
void write_out_integrator(SceneDescription& scene);

}  // namespace voxlume
