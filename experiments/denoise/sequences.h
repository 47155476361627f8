#pragma once
#include <memory>
#include <string>
#include <vector>

#include "denoise/frame.h"
#include "render/gradient_samples.h"
#include "render/render_loop.h"
#include "scene/compile.h"
#include "voxlume/image.h"

namespace voxlume::study {

/// A volume and how it is shown.
struct Dataset {
  std::string name;
  SceneDescription scene;  ///< resolved; one area light that stands in the world, and the environment
  Volume volume;
  VolumeStatistics statistics;
  double size_mm;  ///< radius of the bounding sphere
  /// The transfer function that is edited, and below which share of its range of values matter fades.
  std::vector<TransferPoint> edited;
  double soft_share = 0.55;
};

/// head-ct, mri-head, phantom (built in), or of the head CT semi-transparent (narrow bands: isosurfaces
/// within one another), homogeneous (one extinction inside the skin, phase function alone) and spiky (thinner
/// bands, three scatterings). `environment` is a picture's file; without one the environment is constant.
/// Throws Error as open_volume and resolve do, kBadParameter for an unknown name.
Dataset load_dataset(const std::string& name, const std::string& environment, int width, int height);

/// What moves.
struct Animation {
  std::string name, title;
  /// Changes the scene for t in [0,1].
  void (*set)(SceneDescription& scene, const Dataset& data, double t);
};

/// Camera orbit, rotating area light, moving point light whose colour changes, transfer-function edit (in the
/// middle of which all soft matter vanishes from one frame to the next). Lights stay where they are while the
/// camera moves.
const std::vector<Animation>& animations();
/// By name; "still" is one in which nothing moves.
const Animation& find_animation(const std::string& name);

/// Frames that an animation takes. A shorter study shows its beginning at the same speed.
constexpr double kFramesOfATurn = 120;

/// A sequence as it is rendered. Its frames can be had in any order.
class Sequence {
 public:
  Sequence(const Dataset& data, const Animation& animation) : data_(data), animation_(animation) {}

  /// Goes to a frame of the animation.
  void go_to(int frame);
  /// Renders the moment with `spp` samples a pixel as denoisers see it, and the time it took [ms]. Pictures
  /// of one `seed` have the same noise.
  /// `gradients` has seen the frame before, if there was one, and sees this one.
  double render(int spp, std::uint32_t seed, GradientSampler& gradients, DenoiseFrame& out) const;
  /// Two plain pictures of the moment, of seeds `seed` and the next.
  std::pair<Image, Image> pictures(int spp, std::uint32_t seed) const;

  const Dataset& data() const { return data_; }
  const Animation& animation() const { return animation_; }
  std::string name() const { return data_.name + "-" + animation_.name; }
  const SceneView& view() const { return scene_->view(); }

 private:
  const Dataset& data_;
  const Animation& animation_;
  std::unique_ptr<CompiledScene> scene_;
};

}  // namespace voxlume::study
