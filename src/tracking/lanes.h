#pragma once
#include <array>
#include <cstdint>

#include "tracking/tracking.h"

namespace voxlume {

/// Many rays under way at once, a column of every array each. The vector tracker moves them on together; who
/// owns the lanes puts rays in and takes results out.
struct alignas(64) Lanes {
  static constexpr int kCount = 64;
  template <class T>
  using PerLane = std::array<T, kCount>;

  enum State : std::uint32_t { kIdle, kStart, kCross, kLookUp, kDone };

  // Given with kStart.
  alignas(64) PerLane<std::uint32_t> state{};
  alignas(64) PerLane<std::uint32_t> is_shadow{};  ///< all ones: transmittance; 0: free flight
  alignas(64) PerLane<std::uint32_t> rng[4]{};
  alignas(64) PerLane<float> origin[3]{};     ///< index space; from kStart on inside the domain
  alignas(64) PerLane<float> direction[3]{};  ///< index units per mm
  alignas(64) PerLane<float> length_mm{};
  alignas(64) PerLane<float> u_collision{}, u_depth{};            ///< as in TrackRay
  alignas(64) PerLane<float> rate_in_matter{}, rate_elsewhere{};  ///< CollisionRates

  // Results, with kDone.
  alignas(64) PerLane<std::uint32_t> is_real{};  ///< of a free flight: all ones where it collided
  alignas(64) PerLane<float> transmittance{};
  alignas(64) PerLane<float> value{};
  alignas(64) PerLane<float> position[3]{};             ///< index space
  alignas(64) PerLane<float> start_mm{}, entered_mm{};  ///< of the segment, and the way into it
  alignas(64) PerLane<std::uint32_t> steps{}, violations{};

  // The tracker's own.
  alignas(64) PerLane<float> inverse[3]{};
  alignas(64) PerLane<float> threshold{};  ///< transmittance below which the flight ends or roulette sets in
  alignas(64) PerLane<float> tau{}, rate{}, mu_maj{}, run_mm{}, exit_mm{};
  alignas(64) PerLane<std::int32_t> cell[3]{}, next_cell[3]{};
  alignas(64) PerLane<std::uint32_t> word{};
  alignas(64) PerLane<std::int32_t> next_word_at{};  ///< where the next cell's word is
  /// The 8 voxels around the last look-up, as VoxelPairs lays them out, and the index of the first of them
  /// (-1 along i: none): the next look-up is often between the same.
  alignas(64) PerLane<std::uint32_t> pairs[8]{};
  alignas(64) PerLane<std::int32_t> fetched[3]{};

  /// Puts a ray into a lane.
  void put(int lane, const TrackRay& track, bool shadow, const Rng& stream) noexcept {
    const Vec3f from = track.ray.origin_index + track.ray.direction_index * track.t_near;
    for (int a = 0; a < 3; ++a) {
      origin[a][lane] = from[a];
      direction[a][lane] = track.ray.direction_index[a];
    }
    u_collision[lane] = track.u_collision;
    u_depth[lane] = track.u_depth;
    const CollisionRates rates = collision_rates(track.fine);
    rate_in_matter[lane] = rates.in_matter;
    rate_elsewhere[lane] = rates.elsewhere;
    length_mm[lane] = track.t_far - track.t_near;
    is_shadow[lane] = shadow ? ~0u : 0u;
    for (int i = 0; i < 4; ++i) rng[i][lane] = stream.state()[i];
    steps[lane] = violations[lane] = 0;
    state[lane] = kStart;
  }
  Rng stream(int lane) const noexcept {
    return Rng(std::array{rng[0][lane], rng[1][lane], rng[2][lane], rng[3][lane]});
  }
  /// The result of a free flight that began at t_near.
  Collision collision(int lane, float t_near) const noexcept {
    if (!is_real[lane]) return {};
    return {true,
            t_near + (start_mm[lane] + entered_mm[lane]),
            {position[0][lane], position[1][lane], position[2][lane]},
            value[lane]};
  }
};

/// Moves the rays of `lanes` on until at least a few are done, or none is left under way. Same random numbers
/// and arithmetic as sample_free_flight and estimate_transmittance over a HierarchyWalk.
using VectorTracker = void (*)(const Medium& medium, Lanes& lanes);

enum class SimdTarget { kScalar, kSse4, kAvx2, kAvx512, kNeon };

/// The widest target that this machine runs and the library was built for.
SimdTarget best_simd_target();
bool has_simd_target(SimdTarget target);
/// "avx2" and so on.
const char* simd_name(SimdTarget target);

/// The tracker of a target for a medium, or nullptr where scalar code has to serve: another accelerator than
/// the hierarchy, or a volume one voxel wide. The target must be one the machine has.
VectorTracker vector_tracker(SimdTarget target, const Medium& medium);

}  // namespace voxlume
