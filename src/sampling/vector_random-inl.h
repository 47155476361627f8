// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_SAMPLING_VECTOR_RANDOM_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_SAMPLING_VECTOR_RANDOM_INL_H_
#undef VOXLUME_SAMPLING_VECTOR_RANDOM_INL_H_
#else
#define VOXLUME_SAMPLING_VECTOR_RANDOM_INL_H_
#endif

#include <hwy/highway.h>

#include "sampling/logarithm.h"
#include "sampling/rng.h"
#include "sampling/sobol.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// negative_log.
template <class D>
hn::Vec<D> vector_negative_log(D d, hn::Vec<D> x) {
  const hn::RebindToSigned<D> di;
  const auto bits = hn::BitCast(di, x);
  const auto exponent = hn::ShiftRight<23>(hn::Sub(bits, hn::Set(di, kSqrtHalfBits)));
  const auto f = hn::Sub(hn::BitCast(d, hn::Sub(bits, hn::ShiftLeft<23>(exponent))), hn::Set(d, 1.0f));
  auto p = hn::Set(d, kLogPolynomial[0]);
  for (int i = 1; i < 9; ++i) p = hn::Add(hn::Mul(p, f), hn::Set(d, kLogPolynomial[i]));
  const auto f2 = hn::Mul(f, f), e = hn::ConvertTo(d, exponent);
  const auto tail = hn::Sub(hn::Add(hn::Mul(hn::Mul(p, f), f2), hn::Mul(e, hn::Set(d, kLn2Low))),
                            hn::Mul(hn::Set(d, 0.5f), f2));
  const auto log = hn::Add(hn::Add(tail, f), hn::Mul(e, hn::Set(d, kLn2High)));
  return hn::Sub(hn::Zero(d), log);
}

/// unit_float.
template <class D>
hn::Vec<D> vector_unit_float(D d, hn::Vec<hn::RebindToUnsigned<D>> bits) {
  const hn::RebindToSigned<D> di;
  return hn::Mul(hn::ConvertTo(d, hn::BitCast(di, hn::ShiftRight<8>(bits))), hn::Set(d, 0x1p-24f));
}

/// The states of one Rng a lane.
template <class D>
struct VectorRng {
  using U = hn::Vec<hn::RebindToUnsigned<D>>;
  U s0, s1, s2, s3;

  /// Rng::next().
  hn::Vec<D> next(D d) {
    const U bits = hn::Add(hn::RotateRight<32 - 7>(hn::Add(s0, s3)), s0);
    const U shifted = hn::ShiftLeft<9>(s1);
    s2 = hn::Xor(s2, s0);
    s3 = hn::Xor(s3, s1);
    s1 = hn::Xor(s1, s2);
    s0 = hn::Xor(s0, s3);
    s2 = hn::Xor(s2, shifted);
    s3 = hn::RotateRight<32 - 11>(s3);
    return vector_unit_float(d, bits);
  }
};

/// mix_bits.
template <class DU>
hn::Vec<DU> vector_mix_bits(DU du, hn::Vec<DU> x) {
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<16>(x)), hn::Set(du, kMixFactor0));
  x = hn::Mul(hn::Xor(x, hn::ShiftRight<15>(x)), hn::Set(du, kMixFactor1));
  return hn::Xor(x, hn::ShiftRight<16>(x));
}

/// reverse_bits.
template <class DU>
hn::Vec<DU> vector_reverse_bits(DU du, hn::Vec<DU> x) {
  const auto m1 = hn::Set(du, 0x55555555u), m2 = hn::Set(du, 0x33333333u), m4 = hn::Set(du, 0x0f0f0f0fu),
             m8 = hn::Set(du, 0x00ff00ffu);
  x = hn::Or(hn::And(hn::ShiftRight<1>(x), m1), hn::ShiftLeft<1>(hn::And(x, m1)));
  x = hn::Or(hn::And(hn::ShiftRight<2>(x), m2), hn::ShiftLeft<2>(hn::And(x, m2)));
  x = hn::Or(hn::And(hn::ShiftRight<4>(x), m4), hn::ShiftLeft<4>(hn::And(x, m4)));
  x = hn::Or(hn::And(hn::ShiftRight<8>(x), m8), hn::ShiftLeft<8>(hn::And(x, m8)));
  return hn::RotateRight<16>(x);
}

/// scramble_reversed.
template <class DU>
hn::Vec<DU> vector_scramble_reversed(DU du, hn::Vec<DU> x, hn::Vec<DU> seed) {
  x = hn::Xor(x, hn::Mul(x, hn::Set(du, 0x3d20adeau)));
  x = hn::Add(x, seed);
  x = hn::Mul(x, hn::Or(hn::ShiftRight<16>(seed), hn::Set(du, 1u)));
  x = hn::Xor(x, hn::Mul(x, hn::Set(du, 0x05526c56u)));
  return hn::Xor(x, hn::Mul(x, hn::Set(du, 0x53a22864u)));
}

/// pascal_product.
template <class DU>
hn::Vec<DU> vector_pascal_product(DU du, hn::Vec<DU> x) {
  x = hn::Xor(x, hn::ShiftRight<1>(hn::And(x, hn::Set(du, 0xaaaaaaaau))));
  x = hn::Xor(x, hn::ShiftRight<2>(hn::And(x, hn::Set(du, 0xccccccccu))));
  x = hn::Xor(x, hn::ShiftRight<4>(hn::And(x, hn::Set(du, 0xf0f0f0f0u))));
  x = hn::Xor(x, hn::ShiftRight<8>(hn::And(x, hn::Set(du, 0xff00ff00u))));
  return hn::Xor(x, hn::ShiftRight<16>(hn::And(x, hn::Set(du, 0xffff0000u))));
}

/// The sum of the columns that the bits of `index` choose.
template <class DU>
hn::Vec<DU> vector_column_sum(DU du, const std::uint32_t (&columns)[32], hn::Vec<DU> index) {
  const hn::RebindToSigned<DU> di;
  auto sum = hn::Zero(du);
  for (int j = 31; j >= 0; --j) {
    const auto chosen = hn::BitCast(du, hn::BroadcastSignBit(hn::BitCast(di, index)));
    sum = hn::Xor(sum, hn::And(chosen, hn::Set(du, columns[j])));
    index = hn::Add(index, index);
  }
  return sum;
}

/// The first kCount numbers of sobol_quad; pixel_seed as sobol_pixel_seed gives it.
template <class D, int kCount>
void vector_sobol_quad(D d, hn::Vec<hn::RebindToUnsigned<D>> pixel_seed,
                       hn::Vec<hn::RebindToUnsigned<D>> sample, SobolSet set, hn::Vec<D> (&u)[kCount]) {
  const hn::RebindToUnsigned<D> du;
  const auto seed = vector_mix_bits(
      du, hn::Add(pixel_seed, hn::Set(du, static_cast<std::uint32_t>(set) * kPhiloxKeyStep0)));
  const auto index =
      vector_reverse_bits(du, vector_scramble_reversed(du, vector_reverse_bits(du, sample), seed));
  for (int i = 0; i < kCount; ++i) {
    const auto point = i == 0   ? index
                       : i == 1 ? vector_pascal_product(du, index)
                       : i == 2 ? vector_column_sum(du, kSobolColumns.third, index)
                                : vector_column_sum(du, kSobolColumns.fourth, index);
    const auto own = vector_mix_bits(du, hn::Xor(seed, hn::Set(du, kSobolDimensionSeeds[i])));
    u[i] = vector_unit_float(d, vector_reverse_bits(du, vector_scramble_reversed(du, point, own)));
  }
}

#if HWY_TARGET != HWY_SCALAR
/// Rng(seed, frame, pixel, sample).
template <class D>
VectorRng<D> seed_vector_rng(D, std::uint64_t seed, std::uint32_t frame, typename VectorRng<D>::U pixel,
                             typename VectorRng<D>::U sample) {
  const hn::RebindToUnsigned<D> du;
  const hn::Repartition<std::uint64_t, decltype(du)> du64;
  using U = typename VectorRng<D>::U;
  const auto high = [&](U a, std::uint32_t b) {
    const U factor = hn::Set(du, b);
    const auto even = hn::MulEven(a, factor);
    const auto odd = hn::MulEven(hn::BitCast(du, hn::ShiftRight<32>(hn::BitCast(du64, a))), factor);
    return hn::OddEven(hn::BitCast(du, odd), hn::BitCast(du, hn::ShiftRight<32>(even)));
  };
  U c0 = hn::Zero(du), c1 = sample, c2 = pixel, c3 = hn::Set(du, frame);
  auto k0 = static_cast<std::uint32_t>(seed), k1 = static_cast<std::uint32_t>(seed >> 32);
  for (int round = 0; round < 7; ++round) {
    const U n0 = hn::Xor(hn::Xor(high(c2, kPhiloxFactor1), c1), hn::Set(du, k0));
    const U n2 = hn::Xor(hn::Xor(high(c0, kPhiloxFactor0), c3), hn::Set(du, k1));
    c1 = hn::Mul(c2, hn::Set(du, kPhiloxFactor1));
    c3 = hn::Mul(c0, hn::Set(du, kPhiloxFactor0));
    c0 = n0;
    c2 = n2;
    k0 += kPhiloxKeyStep0;
    k1 += kPhiloxKeyStep1;
  }
  const auto stuck = hn::Eq(hn::Or(hn::Or(c0, c1), hn::Or(c2, c3)), hn::Zero(du));
  return {hn::IfThenElse(stuck, hn::Set(du, 1), c0), c1, c2, c3};
}
#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
