#pragma once
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/vec.h"
#include "voxlume/scene.h"

namespace voxlume {

/// One linear piece of a curve of colours, in force on [start, next piece's start).
struct ExtinctionColorPiece {
  float start;         ///< data units; -inf for the first piece
  float anchor;        ///< data value at which `color` holds
  Vec3f color, slope;  ///< slope: per data unit
};

/// The extinction colour of a transfer function's points as kernels see it.
struct ExtinctionColorView {
  const ExtinctionColorPiece* pieces = nullptr;
  std::int32_t piece_count = 0;  ///< 0: white everywhere
};

/// What multiplies mu_t channel by channel at a data value; each channel in [0, 1].
inline Vec3f extinction_color_at(const ExtinctionColorView& colors, float value) noexcept {
  if (colors.piece_count == 0) return Vec3f(1);
  const auto before = [](float v, const ExtinctionColorPiece& piece) { return v < piece.start; };
  const ExtinctionColorPiece& piece =
      *(std::upper_bound(colors.pieces + 1, colors.pieces + colors.piece_count, value, before) - 1);
  return min(max(piece.color + piece.slope * (value - piece.anchor), Vec3f(0)), Vec3f(1));
}

/// The curve through the points that give an extinction colour. Immutable.
class ExtinctionColorCurve {
 public:
  /// `points` are sorted by value.
  explicit ExtinctionColorCurve(const std::vector<TransferPoint>& points);

  /// Points into this.
  ExtinctionColorView view() const { return {pieces_.data(), static_cast<std::int32_t>(pieces_.size())}; }

 private:
  std::vector<ExtinctionColorPiece> pieces_;
};

}  // namespace voxlume
