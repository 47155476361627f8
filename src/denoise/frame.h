#pragma once
#include <array>
#include <optional>

#include "camera/camera.h"
#include "denoise/plane.h"

namespace voxlume {

/// Samples of a pixel that scattered alike at first, of which a pixel has up to two classes. Means over the
/// samples of the class of fx and later (RadianceParts, film/film.h); fl is the ratio of the means of direct
/// light and fx, so that fx fl + later is the mean radiance exactly. Zero in an empty class.
struct SampleClass {
  Plane count;  ///< n_k; 0: the pixel has no such class
  Planes3 fx_diffuse, fx_specular, fl_diffuse, fl_specular, later;
};

/// Two luminances of one sample in every 3 x 3 pixels: the sample of the frame before, and the same sample
/// (same random numbers, seen from where its first scattering has moved to) in this frame's scene
/// (schied2018 section 4). Planes of ceil(width / 3) x ceil(height / 3).
struct GradientSamples {
  Plane now, before;
  Plane valid;  ///< 1, or 0 where nothing could be shaded again
};

/// A rendered frame as denoisers see it. All planes have the frame's size, row by row from the top, and are
/// finite: pixels with a value that is not are empty (alpha 0) instead. `radiance` has the light from matter
/// alone; the background stays outside every filter.
struct DenoiseFrame {
  int width = 0, height = 0;
  CameraView camera{};
  /// A length that stands for the size of what is seen [mm]: the radius of the volume's bounding sphere.
  float size_mm = 1;
  Planes3 radiance;    ///< mean over all samples of what scattered: premultiplied by alpha; linear Rec. 709
  Plane alpha;         ///< share of samples that scattered, or their mean opacity; [0,1]
  Planes3 background;  ///< what is behind, not multiplied by 1 - alpha
  Plane depth_mm;  ///< from the eye to the matter that stands for the pixel (xu2024 5.2); 0 where alpha is 0
  Planes3 normal;  ///< of the first scattering, LPS, mean over samples that scattered, not normalised
  Planes3 albedo;  ///< of the first scattering, mean over samples that scattered
  Plane variance;  ///< of the mean luminance of `radiance`, an unbiased estimate; 0 for one sample
  Plane samples;   ///< of the pixel
  std::optional<std::array<SampleClass, 2>> classes;  ///< for the decoupled denoiser
  std::optional<GradientSamples> gradients;           ///< for A-SVGF, from the second frame on
};

/// An empty frame of zeros without classes and gradients. width, height >= 1.
DenoiseFrame make_denoise_frame(int width, int height);

/// Gives the frame empty classes.
void add_classes(DenoiseFrame& frame);

/// What a denoiser makes of a frame.
struct DenoisedFrame {
  Planes3 radiance;  ///< of matter, premultiplied by alpha, >= 0
  Plane alpha;       ///< [0,1]

  /// Makes the planes anew when they have another size.
  void resize(int width, int height);
};

}  // namespace voxlume
