#include "metrics/error_colors.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace voxlume {
namespace {

// Evenly spaced. In CIELAB: lightness 97 t, hue from -65 to 100 degrees, and as much chroma as fits into sRGB
// there and leaves black and white at the ends.
constexpr std::array<std::uint8_t, 3> kColors[] = {
    {0, 0, 0},      {19, 8, 62},    {53, 0, 86},     {83, 0, 89},     {111, 0, 92},    {140, 1, 94},
    {169, 1, 93},   {198, 1, 89},   {229, 1, 80},    {255, 29, 65},   {255, 89, 64},   {255, 125, 70},
    {255, 153, 82}, {255, 179, 99}, {255, 204, 123}, {255, 227, 156}, {255, 247, 209},
};
constexpr int kSteps = static_cast<int>(std::size(kColors)) - 1;

}  // namespace

std::array<std::uint8_t, 3> error_color(float error) {
  const float position = std::clamp(error, 0.0f, 1.0f) * kSteps;
  const int step = std::min(static_cast<int>(position), kSteps - 1);
  std::array<std::uint8_t, 3> color;
  for (int c = 0; c < 3; ++c) {
    color[c] = static_cast<std::uint8_t>(
        std::lround(std::lerp(kColors[step][c], kColors[step + 1][c], position - static_cast<float>(step))));
  }
  return color;
}

Image8 error_colors(const FlipError& error) {
  Image8 out;
  out.width = error.width;
  out.height = error.height;
  out.channels = 3;
  out.values.reserve(error.map.size() * 3);
  for (const float value : error.map) {
    const std::array<std::uint8_t, 3> color = error_color(value);
    out.values.insert(out.values.end(), color.begin(), color.end());
  }
  return out;
}

}  // namespace voxlume
