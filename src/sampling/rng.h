#pragma once
#include <array>
#include <cstdint>

namespace voxlume {

/// One block of Philox4x32-7 (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3"): a bijection
/// of the 128-bit counter chosen by the 64-bit key. Seven rounds are the fewest that pass BigCrush.
constexpr std::array<std::uint32_t, 4> philox4x32_7(std::array<std::uint32_t, 4> counter,
                                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 7; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53u} * counter[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57u} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += 0x9E3779B9u;
    key[1] += 0xBB67AE85u;
  }
  return counter;
}

/// The top 24 bits as a float in [0, 1 - 2^-24].
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// The random stream of one camera sample: a function of (seed, frame, pixel, sample, dimension) alone, so
/// that no thread count, tile order or resumption changes a picture. Dimensions are drawn in order.
class Rng {
 public:
  /// `pixel` is the pixel's index in the image (row * width + column).
  constexpr Rng(std::uint64_t seed, std::uint32_t frame, std::uint32_t pixel, std::uint32_t sample)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        counter_{0, sample, pixel, frame} {}

  /// The next dimension, uniform in [0, 1).
  constexpr float next() {
    const std::uint32_t lane = dimension_++ & 3u;
    if (lane == 0) {
      block_ = philox4x32_7(counter_, key_);
      ++counter_[0];
    }
    return unit_float(block_[lane]);
  }

 private:
  std::array<std::uint32_t, 2> key_;
  std::array<std::uint32_t, 4> counter_;
  std::array<std::uint32_t, 4> block_{};
  std::uint32_t dimension_ = 0;
};

}  // namespace voxlume
