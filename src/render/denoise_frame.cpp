#include "render/denoise_frame.h"

#include <algorithm>

#include "base/parallel.h"
#include "integrator/background.h"

namespace voxlume {
namespace {

/// Directions whose mean is the background behind a pixel that no sample missed.
constexpr int kBackgroundSide = 4;

void set(Planes3& planes, int x, int y, Vec3f value) {
  for (int c = 0; c < 3; ++c) planes[c].at(x, y) = value[c];
}

/// What is behind the pixel's centre; a blurred one by 4 x 4 directions.
Vec3f background_behind(const SceneView& scene, int x, int y) {
  const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
  const Vec3f direction = camera_ray(scene.camera, px, py, 0.5f, 0.5f).direction;
  if (!blurs_background(scene)) return background_radiance(scene, px, py, direction, 0.5f, 0.5f);
  Vec3f sum(0);
  for (int i = 0; i < kBackgroundSide; ++i) {
    for (int j = 0; j < kBackgroundSide; ++j) {
      const float u0 = (static_cast<float>(i) + 0.5f) / kBackgroundSide;
      const float u1 = (static_cast<float>(j) + 0.5f) / kBackgroundSide;
      sum += background_radiance(scene, px, py, direction, u0, u1);
    }
  }
  return sum * (1.0f / (kBackgroundSide * kBackgroundSide));
}

/// 0 where there is nothing to divide by.
Vec3f ratio(Vec3f a, Vec3f b) {
  return {b.x > 0 ? a.x / b.x : 0.0f, b.y > 0 ? a.y / b.y : 0.0f, b.z > 0 ? a.z / b.z : 0.0f};
}

void fill_class(const ClassSums& sums, SampleClass& out, int x, int y) {
  const float inverse = sums.count > 0 ? 1.0f / static_cast<float>(sums.count) : 0.0f;
  out.count.at(x, y) = static_cast<float>(sums.count);
  set(out.fx_diffuse, x, y, sums.fx_diffuse * inverse);
  set(out.fx_specular, x, y, sums.fx_specular * inverse);
  set(out.fl_diffuse, x, y, ratio(sums.direct_diffuse, sums.fx_diffuse));
  set(out.fl_specular, x, y, ratio(sums.direct_specular, sums.fx_specular));
  set(out.later, x, y, sums.later * inverse);
}

/// `variance_share`: of the pixel (Film::variance_shares).
void fill_pixel(const Film& film, const SceneView& scene, float variance_share, int x, int y,
                DenoiseFrame& frame) {
  const PixelClasses& pixel = film.classes(x, y);
  const double samples = std::max(film.sample_count(x, y), 1u);
  const double alpha = film.alpha(x, y), missed = samples * (1 - alpha);
  const double luminance_sum = luminance(pixel.radiance);
  const double spread = pixel.luminance_squared - luminance_sum * luminance_sum / samples;
  frame.variance.at(x, y) =
      samples > 1 ? static_cast<float>(variance_share * std::max(0.0, spread) / (samples - 1) / samples)
                  : 0.0f;
  frame.samples.at(x, y) = static_cast<float>(film.sample_count(x, y));
  frame.alpha.at(x, y) = static_cast<float>(alpha);
  frame.depth_mm.at(x, y) = pixel.dense_depth_mm > 0 ? pixel.dense_depth_mm : pixel.median_depth_mm;
  set(frame.radiance, x, y, Vec3f(pixel.radiance / samples));
  set(frame.normal, x, y, Vec3f(film.normal(x, y)));
  set(frame.albedo, x, y, Vec3f(film.albedo(x, y)));
  const Vec3d behind = missed > 0.5 ? (film.mean(x, y) * samples - pixel.radiance) / missed
                                    : Vec3d(background_behind(scene, x, y));
  set(frame.background, x, y, max(Vec3f(behind), Vec3f(0)));
  for (int k = 0; k < 2; ++k) fill_class(pixel.classes[k], (*frame.classes)[k], x, y);
}

}  // namespace

void fill_denoise_frame(const Film& film, const SceneView& scene, float size_mm, DenoiseFrame& frame) {
  if (frame.width != film.width() || frame.height != film.height() || !frame.classes) {
    frame = make_denoise_frame(film.width(), film.height());
    add_classes(frame);
  }
  frame.camera = scene.camera;
  frame.size_mm = size_mm;
  const std::vector<float> shares = film.variance_shares();
  parallel_for(film.height(), 8, [&](std::int64_t row) {
    const int y = static_cast<int>(row);
    const float* const shares_of_row = shares.data() + static_cast<std::size_t>(y) * film.width();
    for (int x = 0; x < film.width(); ++x) fill_pixel(film, scene, shares_of_row[x], x, y, frame);
  });
}

Image compose_picture(const DenoiseFrame& frame, const DenoisedFrame& denoised, bool transparent) {
  Image image(frame.width, frame.height);
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const float alpha = denoised.alpha.at(x, y);
      float* pixel = image.pixel(x, y);
      for (int c = 0; c < 3; ++c) {
        const float behind = transparent ? 0.0f : (1 - alpha) * frame.background[c].at(x, y);
        pixel[c] = denoised.radiance[c].at(x, y) + behind;
      }
      pixel[3] = transparent ? alpha : 1.0f;
    }
  }
  return image;
}

}  // namespace voxlume
