#pragma once
#include <span>
#include <vector>

namespace voxlume {

// Discrete distributions that are exact for the renderer's random numbers: cumulative probabilities are
// multiples of 2^-24, as is every u, so that an index is drawn with precisely the probability that is
// reported for it.

/// Probabilities of `count` bins. cdf[0] = 0, cdf[count] = 1.
struct Distribution1DView {
  const float* cdf = nullptr;
  int count = 0;
};

/// A bin, where in it ([0,1), uniform), and the bin's probability (> 0).
struct BinSample {
  int index;
  float offset;
  float probability;
};

/// Probability of bin `index` in [0, count).
inline float bin_probability(const Distribution1DView& d, int index) noexcept {
  return d.cdf[index + 1] - d.cdf[index];
}

/// Draws a bin; u in [0, 1 - 2^-24]. Bins of probability 0 are never drawn.
inline BinSample sample_bin(const Distribution1DView& d, float u) noexcept {
  int low = 0;  // invariant: cdf[low] <= u < cdf[high]
  int high = d.count;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    if (d.cdf[middle] <= u)
      low = middle;
    else
      high = middle;
  }
  const float probability = bin_probability(d, low);
  return {low, (u - d.cdf[low]) / probability, probability};
}

/// A position in [0,1) and its density there.
struct PositionSample {
  float x;
  float pdf;
};

/// Draws from the piecewise constant density over [0,1) that has equally wide bins.
inline PositionSample sample_position(const Distribution1DView& d, float u) noexcept {
  const BinSample bin = sample_bin(d, u);
  const float x = (static_cast<float>(bin.index) + bin.offset) / static_cast<float>(d.count);
  return {x < 1.0f ? x : 0x1.fffffep-1f, bin.probability * static_cast<float>(d.count)};
}

/// Density of sample_position at x in [0,1).
inline float position_pdf(const Distribution1DView& d, float x) noexcept {
  const int index = static_cast<int>(x * static_cast<float>(d.count));
  return bin_probability(d, index < d.count ? index : d.count - 1) * static_cast<float>(d.count);
}

/// Probabilities of the texels of a picture: a row first, then a column given the row.
struct Distribution2DView {
  Distribution1DView rows;
  const float* column_cdf = nullptr;  ///< height x (width + 1)
  int width = 0;

  Distribution1DView columns(int row) const noexcept {
    return {column_cdf + static_cast<std::size_t>(row) * (static_cast<std::size_t>(width) + 1), width};
  }
};

/// A texel, where in it ([0,1), uniform), and the texel's probability (> 0).
struct TexelSample {
  int column, row;
  float column_offset, row_offset;
  float probability;
};

/// Draws a texel; u in [0, 1 - 2^-24].
inline TexelSample sample_texel(const Distribution2DView& d, float u_column, float u_row) noexcept {
  const BinSample row = sample_bin(d.rows, u_row);
  const BinSample column = sample_bin(d.columns(row.index), u_column);
  return {column.index, row.index, column.offset, row.offset, column.probability * row.probability};
}

/// Probability of a texel.
inline float texel_probability(const Distribution2DView& d, int column, int row) noexcept {
  return bin_probability(d.rows, row) * bin_probability(d.columns(row), column);
}

/// Owns the table behind a Distribution1DView.
class Distribution1D {
 public:
  Distribution1D() = default;
  /// `weights`: finite, >= 0, at most 2^23 of them. A bin of positive weight gets at least the probability
  /// 2^-24. When all weights are 0 the bins are equally likely.
  explicit Distribution1D(std::span<const double> weights);

  /// Valid while this lives, also after a move.
  Distribution1DView view() const { return {cdf_.data(), static_cast<int>(cdf_.size()) - 1}; }

 private:
  std::vector<float> cdf_{0.0f};
};

/// Owns the tables behind a Distribution2DView.
class Distribution2D {
 public:
  Distribution2D() = default;
  /// `weights`: width x height, row after row; as for Distribution1D.
  Distribution2D(std::span<const double> weights, int width, int height);

  /// Valid while this lives, also after a move.
  Distribution2DView view() const { return {rows_.view(), column_cdf_.data(), width_}; }

 private:
  Distribution1D rows_;
  std::vector<float> column_cdf_;
  int width_ = 0;
};

}  // namespace voxlume
