#pragma once
#include <array>
#include <cstdint>

#include "sampling/rng.h"

namespace voxlume {

// Points of the first four dimensions of Sobol's sequence, each set of a pixel's dimensions in an order and
// with an Owen scrambling of its own (Burley 2020, "Practical Hash-based Owen Scrambling"): samples of a
// pixel are stratified against each other in every set, and each alone is uniform.

/// Which four dimensions of a camera sample a set gives.
enum class SobolSet : std::uint32_t { kCamera, kFirstFlight, kFirstScattering, kFirstLight };

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

/// Columns of Sobol's third and fourth dimensions, reversed, with the primitive polynomials x^2 + x + 1 and
/// x^3 + x + 1 and the first direction numbers of Joe and Kuo 2008.
struct SobolColumns {
  std::uint32_t third[32], fourth[32];
};

constexpr SobolColumns make_sobol_columns() {
  SobolColumns columns{{1, 3}, {1, 3, 1}};  // odd numbers below 2^(j + 1), which column j has at its top
  std::uint32_t* const third = columns.third;
  std::uint32_t* const fourth = columns.fourth;
  for (int j = 2; j < 32; ++j) third[j] = third[j - 2] ^ third[j - 1] << 1 ^ third[j - 2] << 2;
  for (int j = 3; j < 32; ++j) fourth[j] = fourth[j - 3] ^ fourth[j - 2] << 2 ^ fourth[j - 3] << 3;
  for (int j = 0; j < 32; ++j) {
    third[j] = reverse_bits(third[j] << (31 - j));
    fourth[j] = reverse_bits(fourth[j] << (31 - j));
  }
  return columns;
}

inline constexpr SobolColumns kSobolColumns = make_sobol_columns();

/// The columns' sums for every value of every byte of an index.
struct SobolBytes {
  std::uint32_t third[4][256], fourth[4][256];
};

constexpr SobolBytes make_sobol_bytes() {
  SobolBytes bytes{};
  for (int b = 0; b < 4; ++b)
    for (int bit = 0; bit < 8; ++bit)
      for (int low = 0; low < 1 << bit; ++low) {
        bytes.third[b][low | 1 << bit] = bytes.third[b][low] ^ kSobolColumns.third[8 * b + bit];
        bytes.fourth[b][low | 1 << bit] = bytes.fourth[b][low] ^ kSobolColumns.fourth[8 * b + bit];
      }
  return bytes;
}

inline constexpr SobolBytes kSobolBytes = make_sobol_bytes();

/// Sobol's point `index`, reversed: its first dimension is the index itself.
constexpr std::array<std::uint32_t, 4> sobol_reversed(std::uint32_t index) {
  const auto product = [index](const std::uint32_t(&sums)[4][256]) {
    return sums[0][index & 255] ^ sums[1][index >> 8 & 255] ^ sums[2][index >> 16 & 255] ^
           sums[3][index >> 24];
  };
  return {index, pascal_product(index), product(kSobolBytes.third), product(kSobolBytes.fourth)};
}

constexpr std::uint32_t sobol_picture_seed(std::uint64_t seed, std::uint32_t frame) {
  return mix_bits(static_cast<std::uint32_t>(seed) ^
                  mix_bits(static_cast<std::uint32_t>(seed >> 32) ^ mix_bits(frame)));
}

/// What the sets of one pixel are scrambled by.
constexpr std::uint32_t sobol_pixel_seed(std::uint64_t seed, std::uint32_t frame, std::uint32_t pixel) {
  return mix_bits(pixel ^ sobol_picture_seed(seed, frame));
}

struct UnitPair {
  float u0, u1;  ///< multiples of 2^-24 in [0, 1)
  bool operator==(const UnitPair&) const = default;
};

/// Multiples of 2^-24 in [0, 1).
using UnitQuad = std::array<float, 4>;

/// What tells the scramblings of a set's dimensions apart.
inline constexpr std::uint32_t kSobolDimensionSeeds[4] = {0x55555555u, 0xaaaaaaaau, 0x33333333u, 0xccccccccu};

/// Sample `sample` of a set.
constexpr UnitQuad sobol_quad(std::uint32_t pixel_seed, std::uint32_t sample, SobolSet set) {
  const std::uint32_t seed = mix_bits(pixel_seed + static_cast<std::uint32_t>(set) * kPhiloxKeyStep0);
  const auto point = sobol_reversed(reverse_bits(scramble_reversed(reverse_bits(sample), seed)));
  UnitQuad u{};
  for (int d = 0; d < 4; ++d)
    u[d] = unit_float(reverse_bits(scramble_reversed(point[d], mix_bits(seed ^ kSobolDimensionSeeds[d]))));
  return u;
}

}  // namespace voxlume
