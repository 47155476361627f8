#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <vector>

#include "voxlume/image.h"

// LDR-FLIP as it is defined: double precision, every filter a whole 2-D kernel, no tiles.

namespace voxlume::test {

using Rgb = std::array<double, 3>;

inline Rgb reference_xyz(const Rgb& rgb) {
  return {(10135552 * rgb[0] + 8788810 * rgb[1] + 4435075 * rgb[2]) / 23359437,
          (2613072 * rgb[0] + 8788810 * rgb[1] + 887015 * rgb[2]) / 12288897,
          (1425312 * rgb[0] + 8788810 * rgb[1] + 70074185 * rgb[2]) / 80288307};
}

/// Hunt-adjusted CIELAB of linear RGB in [0,1].
inline Rgb reference_lab(const Rgb& rgb) {
  const Rgb xyz = reference_xyz(rgb);
  const auto f = [](double t) { return t > 216.0 / 24389 ? std::cbrt(t) : t * (841.0 / 108) + 4.0 / 29; };
  const double lightness = 116 * f(xyz[1]) - 16;
  return {lightness, 0.01 * lightness * 500 * (f(xyz[0]) - f(xyz[1])),
          0.01 * lightness * 200 * (f(xyz[1]) - f(xyz[2]))};
}

/// The remapped difference of two colours, in [0,1].
inline double reference_color_error(const Rgb& rgb, const Rgb& other) {
  const auto distance = [](const Rgb& p, const Rgb& q) {
    const Rgb a = reference_lab(p), b = reference_lab(q);
    return std::pow(std::abs(a[0] - b[0]) + std::hypot(a[1] - b[1], a[2] - b[2]), 0.7);
  };
  const double largest = distance({0, 1, 0}, {0, 0, 1}), e = distance(rgb, other);
  return e < 0.4 * largest ? 0.95 * e / (0.4 * largest) : 0.95 + 0.05 * (e - 0.4 * largest) / (0.6 * largest);
}

/// A 2-D kernel: kernel(dx, dy), for |dx|, |dy| <= radius.
struct Kernel2 {
  int radius;
  std::vector<double> weights;
  Kernel2(int r, const std::function<double(double, double)>& function) : radius(r) {
    double positive = 0, negative = 0;
    for (int y = -r; y <= r; ++y) {
      for (int x = -r; x <= r; ++x) {
        weights.push_back(function(x, y));
        (weights.back() > 0 ? positive : negative) += std::abs(weights.back());
      }
    }
    for (double& weight : weights) weight /= weight > 0 ? positive : negative;
  }
};

/// What one picture looks like: the colour at a pixel as the eye blurs it, and its features.
class ReferenceLook {
 public:
  ReferenceLook(const Image& image, double ppd) : image_(image) {
    const double pi = std::numbers::pi;
    const int radius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const auto gaussian = [=](double a, double b, double x, double y) {
      return a * std::sqrt(pi / b) * std::exp(-pi * pi * (x * x + y * y) / (ppd * ppd * b));
    };
    sensitivity_.emplace_back(radius, [=](double x, double y) { return gaussian(1, 0.0047, x, y); });
    sensitivity_.emplace_back(radius, [=](double x, double y) { return gaussian(1, 0.0053, x, y); });
    sensitivity_.emplace_back(
        radius, [=](double x, double y) { return gaussian(34.1, 0.04, x, y) + gaussian(13.5, 0.025, x, y); });
    const double s = 0.5 * 0.082 * ppd;
    const int feature_radius = static_cast<int>(std::ceil(3 * s));
    const auto g = [=](double x, double y) { return std::exp(-(x * x + y * y) / (2 * s * s)); };
    features_.emplace_back(feature_radius, [=](double x, double y) { return -x * g(x, y); });
    features_.emplace_back(feature_radius, [=](double x, double y) { return -y * g(x, y); });
    features_.emplace_back(feature_radius,
                           [=](double x, double y) { return (x * x / (s * s) - 1) * g(x, y); });
    features_.emplace_back(feature_radius,
                           [=](double x, double y) { return (y * y / (s * s) - 1) * g(x, y); });
  }

  /// Linear RGB in [0,1].
  Rgb blurred(int x, int y) const {
    Rgb channels;
    for (int c = 0; c < 3; ++c) channels[c] = filtered(sensitivity_[c], x, y, c);
    const double yn = (channels[0] + 16) / 116;
    const double xyz_x = (yn + channels[1] / 500) * 23359437 / 24577794,
                 xyz_z = (yn - channels[2] / 200) * 80288307 / 73733382;
    Rgb rgb = {3.241003275 * xyz_x - 1.537398934 * yn - 0.498615819 * xyz_z,
               -0.969224334 * xyz_x + 1.875930071 * yn + 0.041554224 * xyz_z,
               0.055639423 * xyz_x - 0.204011202 * yn + 1.057148933 * xyz_z};
    for (double& value : rgb) value = std::clamp(value, 0.0, 1.0);
    return rgb;
  }
  double edge(int x, int y) const {
    return std::hypot(filtered(features_[0], x, y, 0), filtered(features_[1], x, y, 0)) / 116;
  }
  double point(int x, int y) const {
    return std::hypot(filtered(features_[2], x, y, 0), filtered(features_[3], x, y, 0)) / 116;
  }

 private:
  double opponent(int x, int y, int channel) const {
    const float* p = image_.pixel(std::clamp(x, 0, image_.width - 1), std::clamp(y, 0, image_.height - 1));
    Rgb rgb;
    for (int c = 0; c < 3; ++c) rgb[c] = std::clamp<double>(p[c], 0, 1);
    const Rgb xyz = reference_xyz(rgb);
    return channel == 0   ? 116 * xyz[1] - 16
           : channel == 1 ? 500 * (xyz[0] - xyz[1])
                          : 200 * (xyz[1] - xyz[2]);
  }
  double filtered(const Kernel2& kernel, int x, int y, int channel) const {
    double sum = 0;
    auto weight = kernel.weights.begin();
    for (int dy = -kernel.radius; dy <= kernel.radius; ++dy) {
      for (int dx = -kernel.radius; dx <= kernel.radius; ++dx)
        sum += *weight++ * opponent(x + dx, y + dy, channel);
    }
    return sum;
  }

  const Image& image_;
  std::vector<Kernel2> sensitivity_, features_;
};

struct ReferenceFlip {
  std::vector<double> error, color_error;  ///< with features, and without
};

inline ReferenceFlip reference_flip(const Image& image, const Image& reference, double ppd) {
  const ReferenceLook a(image, ppd), b(reference, ppd);
  ReferenceFlip out;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const double color = reference_color_error(a.blurred(x, y), b.blurred(x, y));
      const double feature =
          std::max(std::abs(a.edge(x, y) - b.edge(x, y)), std::abs(a.point(x, y) - b.point(x, y)));
      out.color_error.push_back(color);
      out.error.push_back(std::pow(color, 1 - std::sqrt(feature / std::numbers::sqrt2)));
    }
  }
  return out;
}

}  // namespace voxlume::test
