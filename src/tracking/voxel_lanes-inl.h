// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_TRACKING_VOXEL_LANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_TRACKING_VOXEL_LANES_INL_H_
#undef VOXLUME_TRACKING_VOXEL_LANES_INL_H_
#else
#define VOXLUME_TRACKING_VOXEL_LANES_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>
#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The 8 voxels around a point for each of kN lanes: four pairs of neighbours along i. Scalar loads beat
/// gathers here, and a pair of narrow voxels is one load.
template <class Voxel, std::size_t kN>
class VoxelPairs {
 public:
  /// Fetches the pairs of `lane`, whose first voxel is `at`.
  void fetch(int lane, const Voxel* at, std::int64_t next_j, std::int64_t next_k) {
    const std::int64_t offset[4] = {0, next_j, next_k, next_j + next_k};
    for (int r = 0; r < 4; ++r) put(lane, r, at + offset[r]);
  }

  /// The lower and upper voxel of row r (0: j, k; 1: j+1; 2: k+1; 3: both) as floats.
  template <class D>
  void get(D d, int r, hn::Vec<D>& lower, hn::Vec<D>& upper) const {
    const hn::RebindToSigned<D> di;
    const hn::RebindToUnsigned<D> du;
    if constexpr (sizeof(Voxel) <= 2) {
      constexpr int kBits = 8 * sizeof(Voxel);
      if constexpr (std::is_signed_v<Voxel>) {
        const auto pair = hn::BitCast(di, hn::Load(du, packed_[r]));
        lower = hn::ConvertTo(d, hn::ShiftRight<32 - kBits>(hn::ShiftLeft<32 - kBits>(pair)));
        upper = hn::ConvertTo(d, hn::ShiftRight<32 - kBits>(hn::ShiftLeft<32 - 2 * kBits>(pair)));
      } else {
        const auto pair = hn::Load(du, packed_[r]);
        lower = hn::ConvertTo(d, hn::BitCast(di, hn::And(pair, hn::Set(du, (1u << kBits) - 1))));
        upper = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<kBits>(pair)));
      }
    } else {
      lower = hn::Load(d, wide_[r][0]);
      upper = hn::Load(d, wide_[r][1]);
    }
  }

 private:
  void put(int lane, int r, const Voxel* at) {
    if constexpr (sizeof(Voxel) <= 2) {
      using Pair = std::conditional_t<sizeof(Voxel) == 1, std::uint16_t, std::uint32_t>;
      Pair pair;
      std::memcpy(&pair, at, sizeof pair);
      packed_[r][lane] = pair;
    } else {
      wide_[r][0][lane] = static_cast<float>(at[0]);
      wide_[r][1][lane] = static_cast<float>(at[1]);
    }
  }

  static constexpr bool kPacked = sizeof(Voxel) <= 2;
  alignas(64) std::uint32_t packed_[4][kPacked ? kN : 1]{};
  alignas(64) float wide_[4][2][kPacked ? 1 : kN]{};
};

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
