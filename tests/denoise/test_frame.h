#pragma once
#include <cmath>
#include <random>

#include "denoise/frame.h"

namespace voxlume {

/// What a test scene has in a pixel, without noise.
struct TestPixel {
  Vec3f radiance{0.5f};  ///< of matter, premultiplied by alpha
  float alpha = 1;
  float depth_mm = 500;
  Vec3f normal{0, -1, 0};
  Vec3f albedo{0.8f};
};

inline CameraView test_camera(int width, int height, double azimuth_deg = 0) {
  CameraDescription description;
  description.azimuth_deg = azimuth_deg;
  return compile_camera(description, Vec3f(0), 150, width, height);
}

/// A frame of `pixel(x, y)`, with one class at every pixel that has matter. `spp` samples a pixel scatter
/// the radiance by a factor of mean 1 and standard deviation `sigma` each (a gamma distribution, as noise is:
/// never negative, and skewed); sigma 0 gives exact values.
template <class PixelFunction>
DenoiseFrame test_frame(int width, int height, const PixelFunction& pixel, double sigma = 0,
                        unsigned seed = 1, int spp = 4, double azimuth_deg = 0) {
  DenoiseFrame frame = make_denoise_frame(width, height);
  add_classes(frame);
  frame.camera = test_camera(width, height, azimuth_deg);
  frame.size_mm = 150;
  std::mt19937 random(seed);
  std::gamma_distribution<double> factor(sigma > 0 ? 1 / (sigma * sigma) : 1, sigma * sigma);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const TestPixel p = pixel(x, y);
      double sum = 0, squares = 0;
      for (int i = 0; i < spp; ++i) {
        const double f = sigma > 0 ? factor(random) : 1;
        sum += f;
        squares += f * f;
      }
      const double mean = sum / spp;
      const double variance = spp > 1 ? std::max(0.0, squares - spp * mean * mean) / (spp - 1) / spp : 0;
      const double y_luminance = luminance(Vec3d(p.radiance));
      frame.variance.at(x, y) = static_cast<float>(variance * y_luminance * y_luminance);
      frame.alpha.at(x, y) = p.alpha;
      frame.depth_mm.at(x, y) = p.alpha > 0 ? p.depth_mm : 0;
      frame.samples.at(x, y) = static_cast<float>(spp);
      SampleClass& one = (*frame.classes)[0];
      one.count.at(x, y) = std::round(p.alpha * static_cast<float>(spp));
      for (int c = 0; c < 3; ++c) {
        frame.radiance[c].at(x, y) = p.radiance[c] * static_cast<float>(mean);
        frame.normal[c].at(x, y) = p.alpha > 0 ? p.normal[c] : 0;
        frame.albedo[c].at(x, y) = p.alpha > 0 ? p.albedo[c] : 0;
        if (!(p.alpha > 0)) continue;
        one.fx_diffuse[c].at(x, y) = p.albedo[c];
        one.fl_diffuse[c].at(x, y) = p.radiance[c] * static_cast<float>(mean) / (p.alpha * p.albedo[c]);
      }
    }
  }
  return frame;
}

/// Root of the mean squared difference of two pictures.
inline double difference(const Planes3& a, const Planes3& b) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    for (int y = 0; y < a[c].height(); ++y) {
      for (int x = 0; x < a[c].width(); ++x) {
        const double d = a[c].at(x, y) - b[c].at(x, y);
        sum += d * d;
      }
    }
  }
  return std::sqrt(sum / (3.0 * a[0].width() * a[0].height()));
}

}  // namespace voxlume
