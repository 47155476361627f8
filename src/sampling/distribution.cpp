#include "sampling/distribution.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/assert.h"

namespace voxlume {
namespace {

constexpr std::int64_t kSteps = std::int64_t{1} << 24;  // unit_float's resolution

/// Writes weights.size() + 1 cumulative probabilities.
void write_cdf(std::span<const double> weights, float* cdf) {
  const std::size_t count = weights.size();
  VOXLUME_ASSERT_LE(count, std::size_t{1} << 23);
  double total = 0;
  for (double w : weights) total += w;
  const bool equal = !(total > 0);
  if (equal) total = static_cast<double>(count);

  std::vector<std::int64_t> steps(count + 1, 0);
  const auto least = [&](std::size_t i) { return std::int64_t{equal || weights[i] > 0}; };
  double sum = 0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += equal ? 1.0 : weights[i];
    const auto nearest = static_cast<std::int64_t>(std::llround(sum / total * kSteps));
    steps[i + 1] = std::max(nearest, steps[i] + least(i));
  }
  // The least shares may have pushed the end beyond 1: take the excess back from the bins before it.
  steps[count] = kSteps;
  for (std::size_t i = count; i-- > 0;) steps[i] = std::min(steps[i], steps[i + 1] - least(i));
  for (std::size_t i = 0; i <= count; ++i) cdf[i] = static_cast<float>(steps[i]) * 0x1p-24f;
}

}  // namespace

Distribution1D::Distribution1D(std::span<const double> weights) : cdf_(weights.size() + 1) {
  if (!weights.empty()) write_cdf(weights, cdf_.data());
}

Distribution2D::Distribution2D(std::span<const double> weights, int width, int height)
    : column_cdf_(static_cast<std::size_t>(height) * (static_cast<std::size_t>(width) + 1)), width_(width) {
  std::vector<double> row_weights(static_cast<std::size_t>(height));
  for (std::size_t row = 0; row < row_weights.size(); ++row) {
    const auto texels =
        weights.subspan(row * static_cast<std::size_t>(width), static_cast<std::size_t>(width));
    for (double w : texels) row_weights[row] += w;
    write_cdf(texels, column_cdf_.data() + row * (static_cast<std::size_t>(width) + 1));
  }
  rows_ = Distribution1D(row_weights);
}

}  // namespace voxlume
