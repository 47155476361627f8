#pragma once
#include <array>
#include <bit>
#include <cstdint>

namespace voxlume {

inline constexpr std::uint32_t kPhiloxFactor0 = 0xD2511F53u, kPhiloxFactor1 = 0xCD9E8D57u;
inline constexpr std::uint32_t kPhiloxKeyStep0 = 0x9E3779B9u, kPhiloxKeyStep1 = 0xBB67AE85u;

/// One block of Philox4x32-7 (Salmon et al. 2011, "Parallel random numbers: as easy as 1, 2, 3"): a bijection
/// of the 128-bit counter chosen by the 64-bit key. Seven rounds are the fewest that pass BigCrush.
constexpr std::array<std::uint32_t, 4> philox4x32_7(std::array<std::uint32_t, 4> counter,
                                                    std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 7; ++round) {
    const std::uint64_t p0 = std::uint64_t{kPhiloxFactor0} * counter[0];
    const std::uint64_t p1 = std::uint64_t{kPhiloxFactor1} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += kPhiloxKeyStep0;
    key[1] += kPhiloxKeyStep1;
  }
  return counter;
}

/// The top 24 bits as a float in [0, 1 - 2^-24].
constexpr float unit_float(std::uint32_t bits) { return static_cast<float>(bits >> 8) * 0x1p-24f; }

/// The random stream of one camera sample: a function of (seed, frame, pixel, sample, dimension) alone, so
/// that no thread count, tile order or resumption changes a picture. Philox gives each sample a state of 128
/// bits of its own, from which xoshiro128++ (Blackman and Vigna 2021, "Scrambled linear pseudorandom number
/// generators") draws one dimension after the other in a few operations, which suit vector lanes.
class Rng {
 public:
  /// `pixel` is the pixel's index in the image (row * width + column).
  constexpr Rng(std::uint64_t seed, std::uint32_t frame, std::uint32_t pixel, std::uint32_t sample)
      : state_(philox4x32_7({0, sample, pixel, frame},
                            {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)})) {
    // The one state that xoshiro never leaves.
    if ((state_[0] | state_[1] | state_[2] | state_[3]) == 0) state_[0] = 1;
  }
  constexpr Rng() : state_{1, 0, 0, 0} {}
  /// Goes on where another stream stands.
  constexpr explicit Rng(const std::array<std::uint32_t, 4>& state) : state_(state) {}

  /// The next dimension, uniform in [0, 1).
  constexpr float next() {
    const std::uint32_t bits = std::rotl(state_[0] + state_[3], 7) + state_[0];
    const std::uint32_t shifted = state_[1] << 9;
    state_[2] ^= state_[0];
    state_[3] ^= state_[1];
    state_[1] ^= state_[2];
    state_[0] ^= state_[3];
    state_[2] ^= shifted;
    state_[3] = std::rotl(state_[3], 11);
    return unit_float(bits);
  }

  constexpr const std::array<std::uint32_t, 4>& state() const { return state_; }

 private:
  std::array<std::uint32_t, 4> state_;
};

}  // namespace voxlume
