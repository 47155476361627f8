#include <algorithm>
#include <vector>

#include "film/film.h"

namespace voxlume {
namespace {

/// Edge of the squares of pixels that share what few blocks tell.
constexpr int kCell = 16;
/// What a square tells counts in each of its pixels like as many blocks of the pixel's own.
constexpr double kCellBlocks = 8;

/// Shares of the pixels of a square.
struct Cell {
  double sum = 0;
  int count = 0;
};

}  // namespace

double Film::variance_between_blocks_at(std::size_t i) const noexcept {
  const double blocks = counts_[i] / kBlock, sum = sums_[i].block_luminance;
  const double variance = (sums_[i].block_squares - sum * sum / blocks) / (blocks - 1);
  return variance > 0 ? variance / kBlock / counts_[i] : 0;
}

std::vector<float> Film::variance_shares() const {
  std::vector<float> shares(pixel_count(), 1.0f);
  const int columns = (width_ + kCell - 1) / kCell, rows = (height_ + kCell - 1) / kCell;
  std::vector<Cell> cells(static_cast<std::size_t>(columns) * rows);
  const auto for_measured = [&](const auto& body) {
    for (int y = 0; y < height_; ++y) {
      for (int x = 0; x < width_; ++x) {
        const std::size_t i = index(x, y);
        if (counts_[i] < 2 * kBlock) continue;
        const double independent = variance_of_mean_at(i);
        if (independent == 0) continue;
        body(i, variance_between_blocks_at(i) / independent,
             cells[static_cast<std::size_t>(y / kCell) * columns + x / kCell]);
      }
    }
  };
  // A mean of shares, not a share of sums: those would be what the noisiest pixels, edges, have, which
  // stratification helps most.
  for_measured([](std::size_t, double own, Cell& cell) {
    cell.sum += own;
    ++cell.count;
  });
  for_measured([&](std::size_t i, double own, const Cell& cell) {
    const double freedom = counts_[i] / kBlock - 1;
    shares[i] =
        static_cast<float>((kCellBlocks * cell.sum / cell.count + freedom * own) / (kCellBlocks + freedom));
  });
  return shares;
}

}  // namespace voxlume
