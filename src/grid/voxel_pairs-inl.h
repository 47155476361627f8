// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_GRID_VOXEL_PAIRS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_GRID_VOXEL_PAIRS_INL_H_
#undef VOXLUME_GRID_VOXEL_PAIRS_INL_H_
#else
#define VOXLUME_GRID_VOXEL_PAIRS_INL_H_
#endif

#include <hwy/highway.h>

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The 8 voxels around a point for each lane of a vector, in 8 columns of kCount lanes from lane v on: four
/// pairs of neighbours along i. Scalar loads beat gathers here, and a pair of narrow voxels is one load.
template <class Voxel, std::size_t kCount>
class VoxelPairs {
 public:
  using Columns = std::array<std::uint32_t, kCount>[8];
  VoxelPairs(Columns& columns, std::size_t v) : columns_(columns), v_(v) {}

  /// Fetches the pairs of `lane`, whose first voxel is `at`.
  void fetch(std::size_t lane, const Voxel* at, std::int64_t next_j, std::int64_t next_k) {
    const std::int64_t offset[4] = {0, next_j, next_k, next_j + next_k};
    for (int r = 0; r < 4; ++r) put(lane, r, at + offset[r]);
  }

  /// What lies at those fractions of the way from the first voxel to the last, as interpolate has it.
  template <class D>
  hn::Vec<D> interpolate(D d, const hn::Vec<D> (&fraction)[3]) const {
    hn::Vec<D> row[4];
    for (int r = 0; r < 4; ++r) {
      hn::Vec<D> lower, upper;
      get(d, r, lower, upper);
      row[r] = hn::Add(lower, hn::Mul(fraction[0], hn::Sub(upper, lower)));
    }
    const auto v0 = hn::Add(row[0], hn::Mul(fraction[1], hn::Sub(row[1], row[0])));
    const auto v1 = hn::Add(row[2], hn::Mul(fraction[1], hn::Sub(row[3], row[2])));
    return hn::Add(v0, hn::Mul(fraction[2], hn::Sub(v1, v0)));
  }

 private:
  static constexpr bool kPacked = sizeof(Voxel) <= 2;

  /// The lower and upper voxel of row r (0: j, k; 1: j+1; 2: k+1; 3: both) as floats.
  template <class D>
  void get(D d, int r, hn::Vec<D>& lower, hn::Vec<D>& upper) const {
    const hn::RebindToSigned<D> di;
    const hn::RebindToUnsigned<D> du;
    if constexpr (kPacked) {
      constexpr int kBits = 8 * sizeof(Voxel);
      const auto pair = hn::Load(du, columns_[r].data() + v_);
      if constexpr (std::is_signed_v<Voxel>) {
        const auto bits = hn::BitCast(di, pair);
        lower = hn::ConvertTo(d, hn::ShiftRight<32 - kBits>(hn::ShiftLeft<32 - kBits>(bits)));
        upper = hn::ConvertTo(d, hn::ShiftRight<32 - kBits>(hn::ShiftLeft<32 - 2 * kBits>(bits)));
      } else {
        lower = hn::ConvertTo(d, hn::BitCast(di, hn::And(pair, hn::Set(du, (1u << kBits) - 1))));
        upper = hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<kBits>(pair)));
      }
    } else {
      lower = hn::BitCast(d, hn::Load(du, columns_[r].data() + v_));
      upper = hn::BitCast(d, hn::Load(du, columns_[r + 4].data() + v_));
    }
  }

  void put(std::size_t lane, int r, const Voxel* at) {
    if constexpr (kPacked) {
      std::conditional_t<sizeof(Voxel) == 1, std::uint16_t, std::uint32_t> pair;
      std::memcpy(&pair, at, sizeof pair);
      columns_[r][v_ + lane] = pair;
    } else {
      columns_[r][v_ + lane] = std::bit_cast<std::uint32_t>(static_cast<float>(at[0]));
      columns_[r + 4][v_ + lane] = std::bit_cast<std::uint32_t>(static_cast<float>(at[1]));
    }
  }

  Columns& columns_;
  std::size_t v_;
};

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
