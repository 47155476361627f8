#pragma once
#include <vector>

#include "camera/camera.h"
#include "denoise/frame.h"
#include "film/film.h"
#include "integrator/primary_ray.h"

namespace voxlume {

/// Traces samples of each frame again in the scene of the next, for A-SVGF (schied2018 section 4.1): with the
/// same random numbers, and through an image point that has moved with the sample's first scattering.
///
/// Every 3 x 3 pixels give one of their samples 0 that scattered: that of a pixel picked by a hash, or of the
/// next that has one. Light behind all matter never enters: a sample that misses matter now counts as dark.
class GradientSampler {
 public:
  /// Gives `frame` its gradients, or none where no frame of that size came before, and keeps what the next
  /// frame needs. `scene` is what `film` was rendered with; the film keeps classes, has sample 0 of every
  /// pixel, and is of the size of `frame`.
  void fill(const SceneView& scene, const Film& film, DenoiseFrame& frame);

  /// The next frame is a first one.
  void forget() { width_ = height_ = 0; }

 private:
  /// A sample as its own frame had it.
  struct Sample {
    SampleStream stream;
    float center_px, center_py;  ///< middle of its pixel
    Vec3f p_world;               ///< of the first scattering
    float luminance;
  };
  /// A sample as this frame sees it.
  struct Moved {
    const Sample* sample = nullptr;
    float center_px = 0, center_py = 0;
    float depth_mm = 0;  ///< of its first scattering, along the viewing axis
  };

  std::vector<Moved> move(const SceneView& scene) const;
  void trace_again(const SceneView& scene, DenoiseFrame& frame) const;
  static bool tells(const Moved& moved, Vec3f eye_mm, const PixelSample& now, float size_mm);
  void keep(const SceneView& scene, const Film& film);

  std::vector<Sample> samples_;
  CameraView camera_{};
  int width_ = 0, height_ = 0;  ///< of the picture
};

}  // namespace voxlume
