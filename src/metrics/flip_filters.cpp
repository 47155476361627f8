#include "metrics/flip_filters.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace voxlume {
namespace {

// A Gaussian of the contrast sensitivity, sqrt(pi / b) exp(-pi^2 x^2 / b) with x in degrees; a and b are of
// Andersson et al. 2020, table 1.
struct Sensitivity {
  double a, b;
};
constexpr Sensitivity kAchromatic{1, 0.0047}, kRedGreen{1, 0.0053};
constexpr Sensitivity kBlueYellow[] = {{34.1, 0.04}, {13.5, 0.025}};
constexpr double kFeatureWidthDegrees = 0.082;

template <class Function>
std::vector<double> sampled(int radius, Function function) {
  std::vector<double> values;
  for (int k = -radius; k <= radius; ++k) values.push_back(function(k));
  return values;
}

double sum_of(const std::vector<double>& values) {
  double sum = 0;
  for (double value : values) sum += value;
  return sum;
}

std::vector<double> gaussian(int radius, double sigma) {
  return sampled(radius, [=](double x) { return std::exp(-x * x / (2 * sigma * sigma)); });
}

// The values times `scale`, without the outer weights that are too small for single precision to notice.
FlipKernel make_kernel(const std::vector<double>& values, double scale) {
  double largest = 0;
  for (double value : values) largest = std::max(largest, std::abs(value));
  std::size_t skipped = 0;
  while (std::abs(values[skipped]) < 1e-9 * largest) ++skipped;
  FlipKernel kernel;
  for (std::size_t i = skipped; i < values.size() - skipped; ++i) {
    kernel.weights.push_back(static_cast<float>(values[i] * scale));
  }
  kernel.radius = static_cast<int>(kernel.weights.size()) / 2;
  return kernel;
}

// Scales the positive weights to sum to 1 and the negative ones to -1.
FlipKernel make_derivative(std::vector<double> values) {
  double positive = 0, negative = 0;
  for (double value : values) (value > 0 ? positive : negative) += std::abs(value);
  for (double& value : values) value /= value > 0 ? positive : negative;
  return make_kernel(values, 1);
}

// exp(-pi^2 x^2 / b) is a Gaussian with this sigma [degrees].
double sigma_of(const Sensitivity& s) { return std::sqrt(s.b / 2) / std::numbers::pi; }

}  // namespace

FlipFilters make_flip_filters(double pixels_per_degree) {
  FlipFilters filters;
  const int radius = static_cast<int>(std::ceil(3 * sigma_of(kBlueYellow[0]) * pixels_per_degree));
  const auto sensitivity = [&](const Sensitivity& s) {
    return gaussian(radius, sigma_of(s) * pixels_per_degree);
  };
  const auto normalised = [](const std::vector<double>& values) {
    return make_kernel(values, 1 / sum_of(values));
  };
  filters.achromatic = normalised(sensitivity(kAchromatic));
  filters.red_green = normalised(sensitivity(kRedGreen));
  double share[2], total = 0;
  for (int i = 0; i < 2; ++i) {
    const double sum = sum_of(sensitivity(kBlueYellow[i]));
    share[i] = kBlueYellow[i].a * std::sqrt(std::numbers::pi / kBlueYellow[i].b);
    total += share[i] * sum * sum;
  }
  for (int i = 0; i < 2; ++i) {
    filters.blue_yellow[i] = make_kernel(sensitivity(kBlueYellow[i]), std::sqrt(share[i] / total));
  }

  const double sigma = 0.5 * kFeatureWidthDegrees * pixels_per_degree;
  const int feature_radius = static_cast<int>(std::ceil(3 * sigma));
  const std::vector<double> smooth = gaussian(feature_radius, sigma);
  std::vector<double> edge = smooth, point = smooth;
  for (int k = -feature_radius; k <= feature_radius; ++k) {
    edge[k + feature_radius] *= -k;
    point[k + feature_radius] *= k * k / (sigma * sigma) - 1;
  }
  filters.across = normalised(smooth);
  filters.edge = make_derivative(edge);
  filters.point = make_derivative(point);
  filters.radius = std::max(radius, feature_radius);
  return filters;
}

void apply_flip_kernel(const float* in, int stride, int step, const FlipKernel& kernel, int rows,
                       float* out) {
  const float* weights = &kernel.weights[kernel.radius];
  for (int y = 0; y < rows; ++y, in += stride, out += kFlipTile) {
    float sum[kFlipTile] = {};
    for (int k = -kernel.radius; k <= kernel.radius; ++k) {
      const float weight = weights[k];
      const float* from = in + k * step;
      for (int x = 0; x < kFlipTile; ++x) sum[x] += weight * from[x];
    }
    std::copy_n(sum, kFlipTile, out);
  }
}

}  // namespace voxlume
