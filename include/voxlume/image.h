#pragma once
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace voxlume {

/// Extra values of every pixel, beside its colour.
struct ImageLayer {
  std::string name;                   ///< "albedo"
  std::vector<std::string> channels;  ///< {"R", "G", "B"}; EXR channels are called name.channel
  std::vector<float> values;          ///< row by row from the top, the channels of a pixel together
  friend bool operator==(const ImageLayer&, const ImageLayer&) = default;
};

/// A picture in linear Rec. 709, premultiplied by alpha.
///
/// The layers that voxlume writes, one for each name in ImageDescription::aovs:
///   layer     channels  unit        meaning
///   alpha     Y         1           share of the samples that scattered; A itself is 1 unless the background
///                                   is transparent
///   depth     Z         mm          from the eye to the first scattering, mean over samples that scattered
///   normal    X Y Z     1           at the first scattering, LPS, mean (not normalised) over those samples
///   albedo    R G B     1           at the first scattering, mean over those samples
///   samples   Y         1           samples of the pixel
///   variance  Y         radiance^2  variance of the pixel's mean luminance
///
/// The name "denoise" stands for everything that denoisers read (docs/denoising.md): normal, albedo, samples,
///   matter           R G B A  radiance    of what scattered, without background, premultiplied by A, the
///   share
///                                         of the samples that scattered
///   matter_depth     Z        mm          from the eye to the matter that stands for the pixel (xu2024 5.2)
///   matter_variance  Y        radiance^2  variance of the mean luminance of matter
///   background       R G B    radiance    behind the matter, not multiplied by 1 - A
///   class0.count, class1.count  Y         samples in each of two classes that scattered alike (xu2024 5.1)
///   classK.fx_diffuse, classK.fx_specular, classK.fl_diffuse, classK.fl_specular, classK.later  R G B
///                                         of the class: SampleClass in denoise/frame.h
/// The first scattering of depth, normal and albedo is that of the camera path; zero where nothing scattered.
///
/// Metadata that voxlume writes (EXR attributes, PNG text): "voxlume:scene" (the scene as JSON),
/// "voxlume:seed", "voxlume:version", "voxlume:camera" (docs/animation.md); with the layers of "denoise"
/// "voxlume:size_mm" (radius of the volume's bounding sphere); of frames of an animation also
/// "voxlume:frame", "voxlume:time_s" and "voxlume:digest" (differs whenever scene, settings or volume do); of
/// pictures that were denoised "voxlume:denoiser" (the method).
struct Image {
  int width = 0, height = 0;
  std::vector<float> rgba;  ///< width * height * 4, row by row from the top
  std::vector<ImageLayer> layers;
  std::map<std::string, std::string> metadata;

  Image() = default;
  /// Transparent black.
  Image(int w, int h) : width(w), height(h), rgba(static_cast<std::size_t>(w) * h * 4) {}

  std::size_t pixel_count() const { return static_cast<std::size_t>(width) * height; }
  /// The four channels of pixel (x, y).
  float* pixel(int x, int y) { return &rgba[(static_cast<std::size_t>(y) * width + x) * 4]; }
  const float* pixel(int x, int y) const { return &rgba[(static_cast<std::size_t>(y) * width + x) * 4]; }
  /// nullptr when there is none of that name.
  const ImageLayer* layer(const std::string& name) const {
    for (const ImageLayer& l : layers) {
      if (l.name == name) return &l;
    }
    return nullptr;
  }
};

/// A picture for display: sRGB-encoded, 8 bits a channel, straight alpha.
struct Image8 {
  int width = 0, height = 0;
  int channels = 3;                  ///< 3 (RGB) or 4 (RGBA)
  std::vector<std::uint8_t> values;  ///< width * height * channels, row by row from the top
  std::map<std::string, std::string> metadata;
};

/// An equirectangular map of radiance, linear Rec. 709.
struct EnvironmentImage {
  int width = 0, height = 0;  ///< width = 2 height
  std::vector<float> rgb;     ///< width * height * 3, row by row from the top; finite, >= 0
};

}  // namespace voxlume
