#include "metrics/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "metrics/pixel_values.h"

namespace voxlume {
namespace {

constexpr int kWindow = 11;
constexpr double kWindowSigma = 1.5;

// Mean over the R, G and B values.
double mean_squared_difference(const Image& image, const Image& reference, PixelValues values) {
  double sum = 0;
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (int c = 0; c < 3; ++c) {
      const double difference =
          pixel_value(image.rgba[4 * i + c], values) - pixel_value(reference.rgba[4 * i + c], values);
      sum += difference * difference;
    }
  }
  return sum / (3.0 * static_cast<double>(image.pixel_count()));
}

// Nearest rank: the smallest value that at least this share of the R, G and B values do not exceed.
double quantile(const Image& image, double share) {
  std::vector<float> values;
  values.reserve(image.pixel_count() * 3);
  for (std::size_t i = 0; i < image.pixel_count(); ++i) {
    for (int c = 0; c < 3; ++c) values.push_back(image.rgba[4 * i + c]);
  }
  const double count = static_cast<double>(values.size());
  const auto rank = static_cast<std::size_t>(std::clamp(std::ceil(share * count), 1.0, count)) - 1;
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rank), values.end());
  return values[rank];
}

// Luma of the display values: the luminance weights on the encoded channels.
std::vector<double> luma(const Image& image) {
  std::vector<double> out(image.pixel_count());
  for (std::size_t i = 0; i < out.size(); ++i) {
    const float* rgb = &image.rgba[4 * i];
    out[i] = 0.2126 * pixel_value(rgb[0], PixelValues::kDisplay) +
             0.7152 * pixel_value(rgb[1], PixelValues::kDisplay) +
             0.0722 * pixel_value(rgb[2], PixelValues::kDisplay);
  }
  return out;
}

std::array<double, kWindow> window_weights() {
  std::array<double, kWindow> weights;
  double sum = 0;
  for (int i = 0; i < kWindow; ++i) {
    const double offset = i - kWindow / 2;
    sum += weights[i] = std::exp(-offset * offset / (2 * kWindowSigma * kWindowSigma));
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

// Gaussian means of a[i] * b[i] over every window inside the picture: (width - 10) x (height - 10) values.
std::vector<double> windowed_product(const std::vector<double>& a, const std::vector<double>& b, int width,
                                     int height) {
  static const std::array<double, kWindow> weights = window_weights();
  const int columns = width - kWindow + 1, rows = height - kWindow + 1;
  std::vector<double> across(static_cast<std::size_t>(columns) * height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < columns; ++x) {
      const std::size_t first = static_cast<std::size_t>(y) * width + x;
      double sum = 0;
      for (int k = 0; k < kWindow; ++k) sum += weights[k] * a[first + k] * b[first + k];
      across[static_cast<std::size_t>(y) * columns + x] = sum;
    }
  }
  std::vector<double> out(static_cast<std::size_t>(columns) * rows);
  for (std::size_t i = 0; i < out.size(); ++i) {
    for (int k = 0; k < kWindow; ++k) {
      out[i] += weights[k] * across[i + static_cast<std::size_t>(k) * columns];
    }
  }
  return out;
}

}  // namespace

double rmse(const Image& image, const Image& reference, PixelValues values) {
  check_pair(image, reference);
  return std::sqrt(mean_squared_difference(image, reference, values));
}

std::optional<double> psnr(const Image& image, const Image& reference) {
  check_pair(image, reference);
  const double error = mean_squared_difference(image, reference, PixelValues::kDisplay);
  if (error == 0) return std::nullopt;
  return -10 * std::log10(error);
}

std::optional<double> psnr_hdr(const Image& image, const Image& reference) {
  check_pair(image, reference);
  const double error = mean_squared_difference(image, reference, PixelValues::kLinear);
  const double peak = quantile(reference, 0.999);
  if (error == 0 || !(peak > 0)) return std::nullopt;
  return 10 * std::log10(peak * peak / error);
}

std::optional<double> ssim(const Image& image, const Image& reference) {
  check_pair(image, reference);
  const int width = image.width, height = image.height;
  if (width < kWindow || height < kWindow) return std::nullopt;
  constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
  const std::vector<double> a = luma(image), b = luma(reference), ones(a.size(), 1.0);
  const std::vector<double> mean_a = windowed_product(a, ones, width, height);
  const std::vector<double> mean_b = windowed_product(b, ones, width, height);
  const std::vector<double> aa = windowed_product(a, a, width, height);
  const std::vector<double> bb = windowed_product(b, b, width, height);
  const std::vector<double> ab = windowed_product(a, b, width, height);
  double sum = 0;
  for (std::size_t i = 0; i < ab.size(); ++i) {
    const double product = mean_a[i] * mean_b[i];
    const double squares = mean_a[i] * mean_a[i] + mean_b[i] * mean_b[i];
    const double covariance = ab[i] - product, variances = aa[i] + bb[i] - squares;
    sum += (2 * product + kC1) * (2 * covariance + kC2) / ((squares + kC1) * (variances + kC2));
  }
  return sum / static_cast<double>(ab.size());
}

}  // namespace voxlume
