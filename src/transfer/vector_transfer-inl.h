// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_TRANSFER_VECTOR_TRANSFER_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_TRANSFER_VECTOR_TRANSFER_INL_H_
#undef VOXLUME_TRANSFER_VECTOR_TRANSFER_INL_H_
#else
#define VOXLUME_TRANSFER_VECTOR_TRANSFER_INL_H_
#endif

#include <hwy/highway.h>

#include "transfer/transfer_view.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// The index of find_piece's piece, of the lanes in `where`.
template <class D, class DI = hn::RebindToSigned<D>>
hn::Vec<DI> vector_find_piece(D d, const TransferView& transfer, hn::Mask<DI> where, hn::Vec<D> value) {
  const DI di;
  const auto at =
      hn::Mul(hn::Sub(value, hn::Set(d, transfer.bucket_origin)), hn::Set(d, transfer.buckets_per_unit));
  const auto last = hn::Set(d, static_cast<float>(transfer.bucket_count - 1));
  const auto inside = hn::IfThenElseZero(hn::Gt(at, hn::Zero(d)), at);  // 0 for NaN
  const auto bucket = hn::ConvertTo(di, hn::Min(inside, last));
  const auto found = hn::GatherIndex(di, transfer.bucket_piece, bucket);
  const auto split = hn::GatherIndex(d, transfer.bucket_split, bucket);
  const auto one = hn::Set(di, 1);
  const auto crowded = hn::Lt(found, hn::Zero(di));
  auto piece = hn::IfThenElse(crowded, hn::Not(found), found);
  piece = hn::Add(piece, hn::IfThenElseZero(hn::RebindMask(di, hn::Ge(value, split)), one));
  const auto* table = &transfer.extinction->start;
  auto unsure = hn::And(where, crowded);
  while (!hn::AllFalse(di, unsure)) {
    const auto next = hn::GatherIndex(d, table + 4, hn::ShiftLeft<2>(piece));
    unsure = hn::And(unsure, hn::RebindMask(di, hn::Ge(value, next)));
    piece = hn::Add(piece, hn::IfThenElseZero(unsure, one));
  }
  return piece;
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
