#pragma once
#include <cstdint>

#include "sampling/rng.h"

namespace voxlume {

// Points of the first two dimensions of Sobol's sequence, each pair of a pixel's dimensions in an order and
// with an Owen scrambling of its own (Burley 2020, "Practical Hash-based Owen Scrambling"): samples of a
// pixel are stratified against each other in every pair, and each alone is uniform.

/// Which two dimensions of a camera sample a pair gives.
enum class SobolPair : std::uint32_t { kImage, kLens, kFirstFlight, kFirstLight, kFirstDirection };

inline constexpr std::uint32_t kMixFactor0 = 0x7feb352du, kMixFactor1 = 0x846ca68bu;

/// An invertible hash of 32 bits (Wellons 2018, "lowbias32").
constexpr std::uint32_t mix_bits(std::uint32_t x) {
  x = (x ^ (x >> 16)) * kMixFactor0;
  x = (x ^ (x >> 15)) * kMixFactor1;
  return x ^ (x >> 16);
}

constexpr std::uint32_t reverse_bits(std::uint32_t x) {
  x = (x >> 1 & 0x55555555u) | (x & 0x55555555u) << 1;
  x = (x >> 2 & 0x33333333u) | (x & 0x33333333u) << 2;
  x = (x >> 4 & 0x0f0f0f0fu) | (x & 0x0f0f0f0fu) << 4;
  x = (x >> 8 & 0x00ff00ffu) | (x & 0x00ff00ffu) << 8;
  return x >> 16 | x << 16;
}

/// A permutation in which a bit changes by what is below it alone: Owen scrambling of reversed bits (Laine
/// and Karras 2011, with Vegdahl's constants of 2021).
constexpr std::uint32_t scramble_reversed(std::uint32_t x, std::uint32_t seed) {
  x ^= x * 0x3d20adeau;
  x += seed;
  x *= seed >> 16 | 1u;
  x ^= x * 0x05526c56u;
  x ^= x * 0x53a22864u;
  return x;
}

/// Sobol's second dimension, reversed: the product with Pascal's triangle mod 2.
constexpr std::uint32_t pascal_product(std::uint32_t x) {
  x ^= (x & 0xaaaaaaaau) >> 1;
  x ^= (x & 0xccccccccu) >> 2;
  x ^= (x & 0xf0f0f0f0u) >> 4;
  x ^= (x & 0xff00ff00u) >> 8;
  return x ^ (x & 0xffff0000u) >> 16;
}

constexpr std::uint32_t sobol_picture_seed(std::uint64_t seed, std::uint32_t frame) {
  return mix_bits(static_cast<std::uint32_t>(seed) ^
                  mix_bits(static_cast<std::uint32_t>(seed >> 32) ^ mix_bits(frame)));
}

/// What the pairs of one pixel are scrambled by.
constexpr std::uint32_t sobol_pixel_seed(std::uint64_t seed, std::uint32_t frame, std::uint32_t pixel) {
  return mix_bits(pixel ^ sobol_picture_seed(seed, frame));
}

struct UnitPair {
  float u0, u1;  ///< multiples of 2^-24 in [0, 1)
};

/// Sample `sample` of a pair.
constexpr UnitPair sobol_pair(std::uint32_t pixel_seed, std::uint32_t sample, SobolPair pair) {
  const std::uint32_t seed = mix_bits(pixel_seed + static_cast<std::uint32_t>(pair) * kPhiloxKeyStep0);
  const std::uint32_t index = reverse_bits(scramble_reversed(reverse_bits(sample), seed));
  const std::uint32_t bits0 = scramble_reversed(index, mix_bits(seed ^ 0x55555555u));
  const std::uint32_t bits1 = scramble_reversed(pascal_product(index), mix_bits(seed ^ 0xaaaaaaaau));
  return {unit_float(reverse_bits(bits0)), unit_float(reverse_bits(bits1))};
}

}  // namespace voxlume
