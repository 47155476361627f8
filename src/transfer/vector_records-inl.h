// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_TRANSFER_VECTOR_RECORDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_TRANSFER_VECTOR_RECORDS_INL_H_
#undef VOXLUME_TRANSFER_VECTOR_RECORDS_INL_H_
#else
#define VOXLUME_TRANSFER_VECTOR_RECORDS_INL_H_
#endif

#include <hwy/highway.h>

#include <cstdint>

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR
/// Record at[4 b] of four floats in block b of 16 bytes.
template <class D>
HWY_INLINE hn::Vec<D> vector_records_of_blocks(D d, const float* table, const std::int32_t* at) {
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  if constexpr (kLanes == 4) {
    return hn::LoadU(d, table + 4 * at[0]);
  } else {
    const hn::Half<D> half;
    return hn::Combine(d, vector_records_of_blocks(half, table, at + kLanes / 2),
                       vector_records_of_blocks(half, table, at));
  }
}
#endif

/// The four floats of every lane's record table[4 index .. 4 index + 3]. Records are loaded whole and
/// transposed four by four, which takes less than half the time of four gathers.
template <class D, class DI = hn::RebindToSigned<D>, class V = hn::Vec<D>>
HWY_INLINE void vector_load_records(D d, const float* table, hn::Vec<DI> index, V& r0, V& r1, V& r2, V& r3) {
  alignas(64) std::int32_t at[hn::MaxLanes(D())];
  hn::Store(index, DI(), at);
#if HWY_TARGET == HWY_SCALAR
  const float* const record = table + 4 * at[0];
  r0 = hn::LoadU(d, record), r1 = hn::LoadU(d, record + 1);
  r2 = hn::LoadU(d, record + 2), r3 = hn::LoadU(d, record + 3);
#else
  const hn::RepartitionToWide<hn::RebindToUnsigned<D>> wide;
  const V a = vector_records_of_blocks(d, table, at), b = vector_records_of_blocks(d, table, at + 1);
  const V c = vector_records_of_blocks(d, table, at + 2), e = vector_records_of_blocks(d, table, at + 3);
  const auto low_ab = hn::BitCast(wide, hn::InterleaveLower(d, a, b));
  const auto low_ce = hn::BitCast(wide, hn::InterleaveLower(d, c, e));
  const auto high_ab = hn::BitCast(wide, hn::InterleaveUpper(d, a, b));
  const auto high_ce = hn::BitCast(wide, hn::InterleaveUpper(d, c, e));
  r0 = hn::BitCast(d, hn::InterleaveLower(wide, low_ab, low_ce));
  r1 = hn::BitCast(d, hn::InterleaveUpper(wide, low_ab, low_ce));
  r2 = hn::BitCast(d, hn::InterleaveLower(wide, high_ab, high_ce));
  r3 = hn::BitCast(d, hn::InterleaveUpper(wide, high_ab, high_ce));
#endif
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
