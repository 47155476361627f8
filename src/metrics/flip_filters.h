#pragma once
#include <vector>

namespace voxlume {

// The filters of FLIP (Andersson et al. 2020, sections 4.1 and 4.2), each a product of one filter along x and
// one along y, and how they are laid over a tile of a picture.

/// One axis of a filter.
struct FlipKernel {
  int radius = 0;              ///< [pixels]
  std::vector<float> weights;  ///< 2 radius + 1 values; weights[radius + k] belongs to the pixel k further on
};

/// All filters at one viewing distance.
struct FlipFilters {
  // Contrast sensitivity: the same kernel along x and y, summing to 1. That of blue and yellow is the sum of
  // two products; the weights of each hold the root of its share.
  FlipKernel achromatic, red_green, blue_yellow[2];
  // Features: a Gaussian across, the first (edges) or second (points) derivative along. The positive weights
  // of a derivative sum to 1, the negative ones to -1.
  FlipKernel across, edge, point;
  int radius = 0;  ///< the largest of all [pixels]
};

/// `pixels_per_degree` of visual angle, in [1, 1000].
FlipFilters make_flip_filters(double pixels_per_degree);

/// A tile is kFlipTile x kFlipTile pixels. Filters read a margin around it.
inline constexpr int kFlipTile = 64;

/// Filters `rows` rows of kFlipTile values: out[y * kFlipTile + x] is the sum over k in [-radius, radius] of
/// weights[radius + k] * in[y * stride + x + k * step]. With step 1 the filter runs along x, with step
/// `stride` along y; every value it reaches must exist. `out` must not overlap `in`.
void apply_flip_kernel(const float* in, int stride, int step, const FlipKernel& kernel, int rows, float* out);

}  // namespace voxlume
