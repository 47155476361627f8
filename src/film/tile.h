#pragma once

namespace voxlume {

/// Pixels x0 <= x < x1, y0 <= y < y1; row 0 is the top of the picture.
struct TileRect {
  int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

  constexpr int width() const { return x1 - x0; }
  constexpr int height() const { return y1 - y0; }
  constexpr int pixel_count() const { return width() * height(); }
  friend constexpr bool operator==(const TileRect&, const TileRect&) = default;
};

}  // namespace voxlume
