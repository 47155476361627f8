#pragma once
#include <string>
#include <vector>

#include "render/render_loop.h"
#include "scene/compile.h"
#include "voxlume/image.h"

namespace voxlume::study {

/// A volume and how it is shown.
struct Dataset {
  std::string name;
  SceneDescription scene;  ///< resolved, with the environment and one area light
  Volume volume;
  VolumeStatistics statistics;
  float size_mm;  ///< radius of the bounding sphere
};

/// `path` is a volume; `preset` its transfer function.
Dataset load_dataset(const std::string& name, const std::string& path, const std::string& preset, int width,
                     int height);

/// What moves.
struct Animation {
  std::string name, title;
  /// Changes the scene for t in [0,1].
  void (*set)(SceneDescription& scene, const Dataset& data, double t);
};

/// Camera orbit, rotating area light, moving point light whose colour changes, transfer-function edit (in the
/// middle of which everything below bone vanishes from one frame to the next).
const std::vector<Animation>& animations();

/// The scene of a frame; random numbers are those of `seed`.
std::unique_ptr<CompiledScene> compile_frame(const Dataset& data, const Animation& animation, double t,
                                             std::uint64_t seed);

/// Renders samples on all threads. With `classes` the film has what denoisers need.
Film render_frame(const CompiledScene& scene, int spp, std::uint32_t frame, bool classes);

}  // namespace voxlume::study
