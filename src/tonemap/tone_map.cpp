#include "tonemap/tone_map.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "tonemap/srgb.h"

namespace voxlume {
namespace {

// Solves f(0.18 s) = 0.18 for the curve below.
constexpr float kMidGreyScale = 0.7231708f;

// Ordered dithering threshold in (0,1), mean 1/2: the 8 x 8 Bayer matrix, built from the bits of x and x^y.
float dither_threshold(int x, int y) {
  unsigned rank = 0;
  for (int bit = 0; bit < 3; ++bit) {
    const unsigned x_bit = (static_cast<unsigned>(x) >> bit) & 1u;
    const unsigned y_bit = (static_cast<unsigned>(y) >> bit) & 1u;
    rank = (rank << 2) | ((x_bit ^ y_bit) << 1) | y_bit;
  }
  return (static_cast<float>(rank) + 0.5f) / 64.0f;
}

// [0,1] to 0..255; `threshold` 1/2 rounds to nearest.
std::uint8_t quantise(float value, float threshold) {
  return static_cast<std::uint8_t>(std::clamp(std::floor(value * 255.0f + threshold), 0.0f, 255.0f));
}

float clamp_finite(float value) {
  if (!(value > 0.0f)) return 0.0f;  // also when not a number
  return std::min(value, 1.0f);
}

float display_value(float radiance, float scale, ToneCurve curve) {
  if (!std::isfinite(radiance)) return 0.0f;
  const float exposed = radiance * scale;
  return srgb_from_linear(curve == ToneCurve::kFilmic ? filmic(exposed) : clamp_finite(exposed));
}

void tone_map_row(const Image& image, int y, const ToneMap& settings, float scale, Image8& out) {
  for (int x = 0; x < image.width; ++x) {
    const float* in = image.pixel(x, y);
    std::uint8_t* to = &out.values[(static_cast<std::size_t>(y) * out.width + x) * out.channels];
    const float threshold = settings.dither ? dither_threshold(x, y) : 0.5f;
    const float alpha = settings.transparent ? clamp_finite(in[3]) : 1.0f;
    for (int c = 0; c < 3; ++c) {
      const float straight = alpha > 0.0f ? in[c] / alpha : 0.0f;
      to[c] = quantise(display_value(straight, scale, settings.curve), threshold);
    }
    if (settings.transparent) to[3] = quantise(alpha, threshold);
  }
}

}  // namespace

float filmic(float linear) {
  if (!(linear > 0.0f)) return 0.0f;
  // The curve passes 1 at y = 7.25; far above it the squares would overflow.
  const float y = kMidGreyScale * std::min(linear, 100.0f);
  return std::min(y * (2.51f * y + 0.03f) / (y * (2.43f * y + 0.59f) + 0.14f), 1.0f);
}

Image8 tone_map(const Image& image, const ToneMap& settings) {
  Image8 out;
  out.width = image.width;
  out.height = image.height;
  out.channels = settings.transparent ? 4 : 3;
  out.values.resize(image.pixel_count() * out.channels);
  out.metadata = image.metadata;
  const float scale = static_cast<float>(std::exp2(settings.exposure_ev));
  parallel_for(image.height, 16,
               [&](std::int64_t y) { tone_map_row(image, static_cast<int>(y), settings, scale, out); });
  return out;
}

}  // namespace voxlume
