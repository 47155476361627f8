#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "base/vec.h"

namespace voxlume {

/// What one camera sample contributes to its pixel.
struct PixelSample {
  Vec3f radiance{};    ///< linear Rec. 709; includes the background unless that is transparent
  float alpha = 0;     ///< 1 when the camera ray scattered, else 0; a marched ray's opacity
  Vec3f albedo{};      ///< of the first scattering; ignored when alpha is 0, as are the next two
  Vec3f normal{};      ///< of the first scattering, LPS, unit length or zero
  float depth_mm = 0;  ///< from the eye to the first scattering
};

/// What a camera sample's radiance is made of: radiance = direct_diffuse + direct_specular + later + behind,
/// and direct = fx fl by channel (xu2024 eq. 8), where fl is what shadows and the choice of light make noisy.
/// Zeros for a sample that did not scatter.
struct RadianceParts {
  /// How the first scattering would look without shadows (integrator/unshadowed.h): of high detail and little
  /// noise. The phase function belongs to the diffuse part.
  Vec3f fx_diffuse{}, fx_specular{};
  /// Light that the first scattering scatters to the eye. Zero in a channel without fx.
  Vec3f direct_diffuse{}, direct_specular{};
  Vec3f later{};  ///< emission, ambient light, light of later scatterings, and what has no fx
  /// What the sample's radiance has beside that, from behind matter that it sees through in part.
  Vec3f behind{};
  /// Whether the extinction at the first scattering is that of matter that stands for the pixel.
  bool dense = false;
};

/// Samples of one pixel that scattered alike at first: sums over them.
struct ClassSums {
  std::uint32_t count = 0;
  Vec3f fx_diffuse{}, fx_specular{}, direct_diffuse{}, direct_specular{}, later{};
};

/// The samples of a pixel that scattered, in two classes (xu2024 section 5.1).
struct PixelClasses {
  Vec3d radiance{};              ///< sum over both classes, without what is from behind
  double luminance_squared = 0;  ///< sum over both classes
  ClassSums classes[2];
  float dense_depth_mm = 0;   ///< least depth of a dense sample; 0 without one
  float median_depth_mm = 0;  ///< of the first samples that scattered and were added together
  /// Of sample 0; 0 unless it scattered and is finite.
  float first_luminance = 0, first_depth_mm = 0;
};

/// Which sums a film keeps beyond radiance, alpha and their error.
struct FilmLayers {
  bool depth = false, normal = false, albedo = false;
  bool classes = false;  ///< PixelClasses
  friend bool operator==(const FilmLayers&, const FilmLayers&) = default;
};

/// The pixels of a picture while it is rendered: sums in double precision and the number of samples of each
/// pixel. A pixel's samples are added in sample order by one thread at a time; then the sums, and everything
/// derived from them, do not depend on the number of threads or the order of the pixels.
class Film {
 public:
  /// 1 <= width, height <= 65536. Throws Error kBadParameter, or kOutOfMemory when the sums cannot be held.
  Film(int width, int height, FilmLayers layers = {});

  /// Adds one sample to pixel (x, y). A radiance, normal, albedo or depth that is not finite becomes zero,
  /// and the sample is counted in nonfinite_samples(); the pixel's sample count grows all the same.
  void add(int x, int y, const PixelSample& sample) noexcept;

  /// Adds samples of pixel (x, y) to its classes; they are also to be added by add(), in the same order.
  /// The first samples that scattered are divided at the largest gap between their luminances of fx_diffuse,
  /// where those differ by `kOneClass` at all (xu2024 section 5.1); later ones join the class whose mean is
  /// nearer.
  /// Samples that are not finite are left out. The film must keep classes; samples.size() == parts.size().
  void add_classes(int x, int y, std::span<const PixelSample> samples, std::span<const RadianceParts> parts);
  /// Luminances that differ by less are alike. xu2024 has 0.1 / sr, which is a third of all that a white
  /// Lambert surface spans.
  static constexpr float kOneClass = 0.1f;

  int width() const noexcept { return width_; }
  int height() const noexcept { return height_; }
  FilmLayers layers() const noexcept { return layers_; }
  std::size_t pixel_count() const noexcept { return sums_.size(); }

  // Of one pixel. All are zero before its first sample.
  std::uint32_t sample_count(int x, int y) const noexcept { return counts_[index(x, y)]; }
  /// Mean radiance, linear Rec. 709.
  Vec3d mean(int x, int y) const noexcept;
  /// Share of samples that scattered, [0,1].
  double alpha(int x, int y) const noexcept;
  /// Estimate of the variance of the mean's luminance, unbiased for samples that are independent of each
  /// other; zero for fewer than two samples.
  double variance_of_mean(int x, int y) const noexcept;
  /// Square root of variance_of_mean().
  double standard_error(int x, int y) const noexcept;
  /// Means over the samples that scattered; zero when none did or when the film lacks the layer.
  /// The mean normal is not normalised.
  Vec3d albedo(int x, int y) const noexcept;
  Vec3d normal(int x, int y) const noexcept;
  double depth_mm(int x, int y) const noexcept;

  /// The classes of the samples that scattered; the film must keep them.
  const PixelClasses& classes(int x, int y) const noexcept { return classes_[index(x, y)]; }

  // Of the picture.
  /// What to multiply variance_of_mean() by, pixel by pixel, row after row: samples that are stratified
  /// against each other have less of it. Measured by how sums of kBlock consecutive samples differ; 1 in
  /// pixels with fewer than two of them.
  std::vector<float> variance_shares() const;
  /// Samples, the first a multiple of it, that are stratified against each other.
  static constexpr std::uint32_t kBlock = 16;
  /// Mean over pixels of standard error / (luminance + 0.01), with variance_shares(): the quantity that
  /// `--noise` bounds. Meaningful once pixels have several samples.
  double noise() const noexcept;
  /// Mean over pixels of the luminance of mean().
  double mean_luminance() const noexcept;
  std::uint64_t total_samples() const noexcept;
  std::uint64_t nonfinite_samples() const noexcept { return nonfinite_samples_; }

  /// Memory of a film of this kind, in bytes per pixel.
  static std::size_t bytes_per_pixel(FilmLayers layers) noexcept;

  /// Every accumulator as raw bytes, in a fixed order and with sizes that depend on size and layers alone.
  /// Copying them to another film of the same size and layers copies the film bit for bit.
  std::vector<std::span<const std::byte>> accumulators() const;
  std::vector<std::span<std::byte>> accumulators();

 private:
  struct Sums {
    Vec3d radiance;
    double luminance_squared = 0;
    double alpha = 0;
    double block_luminance = 0;  ///< sum over whole blocks of kBlock samples
    double block_squares = 0;    ///< sum over whole blocks of the square of what each has
  };

  std::size_t index(int x, int y) const noexcept { return static_cast<std::size_t>(y) * width_ + x; }
  Vec3d mean_at(std::size_t i) const noexcept;
  double variance_of_mean_at(std::size_t i) const noexcept;
  double variance_between_blocks_at(std::size_t i) const noexcept;

  int width_, height_;
  FilmLayers layers_;
  std::vector<Sums> sums_;
  std::vector<std::uint32_t> counts_;
  std::vector<double> depths_;  // weighted by alpha, as are the next two
  std::vector<Vec3d> normals_, albedos_;
  std::vector<PixelClasses> classes_;
  std::uint64_t nonfinite_samples_ = 0;  // written by many threads, through an atomic reference
};

}  // namespace voxlume
