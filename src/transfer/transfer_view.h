#pragma once
#include <cstdint>

#include "base/vec.h"
#include "sampling/elementary.h"

namespace voxlume {

/// One linear piece of a transfer function, in force on [start, next piece's start).
struct TransferPiece {
  float start;             ///< data units; -inf for the first piece
  float anchor;            ///< data value at which the constants hold
  float mu_t, mu_t_slope;  ///< 1/mm, 1/mm per data unit
  Vec3f albedo, albedo_slope;
  Vec3f emission, emission_slope;
};

/// The extinction of a TransferPiece, for vector code.
struct ExtinctionPiece {
  float start;             ///< data units
  float anchor;            ///< data units
  float mu_t, mu_t_slope;  ///< 1/mm, 1/mm per data unit
};

/// Optical coefficients at a point.
struct Coefficients {
  float mu_t;      ///< 1/mm
  Vec3f albedo;    ///< mu_s / mu_t
  Vec3f emission;  ///< L_e; the source term is mu_t * L_e
};

/// A compiled 1-D function as kernels see it. Piecewise linear in mu_t: opacity curves are cut finely when
/// compiled.
struct TransferView {
  const TransferPiece* pieces = nullptr;
  std::int32_t piece_count = 0;
  const ExtinctionPiece* extinction =
      nullptr;  ///< of every piece, and one that starts at NaN, which nothing reaches
  /// Per bucket, a piece in force at its lower end or before; ~piece where more than one begins behind that.
  const std::int32_t* bucket_piece = nullptr;
  const float* bucket_split = nullptr;  ///< per bucket, where the next piece starts; NaN after the last
  std::int32_t bucket_count = 0;
  float bucket_origin = 0, buckets_per_unit = 0;
  float reference_length_mm = 1;  ///< divided by the density scale: opacity = 1 - exp(-mu_t * this)
};

inline const TransferPiece& find_piece(const TransferView& tf, float value) noexcept {
  // Written so that NaN falls into bucket 0.
  const float at = (value - tf.bucket_origin) * tf.buckets_per_unit;
  const std::int32_t bucket =
      at > 0 ? (at < static_cast<float>(tf.bucket_count - 1) ? static_cast<std::int32_t>(at)
                                                             : tf.bucket_count - 1)
             : 0;
  std::int32_t piece = tf.bucket_piece[bucket];
  if (piece < 0) piece = ~piece;
  while (value >= tf.extinction[piece + 1].start) ++piece;
  return tf.pieces[piece];
}

/// Extinction [1/mm] at a data value; 0 for NaN.
inline float classify_mu_t(const TransferView& tf, float value) noexcept {
  const TransferPiece& piece = find_piece(tf, value);
  const float mu_t = piece.mu_t + piece.mu_t_slope * (value - piece.anchor);
  return mu_t > 0 ? mu_t : 0;
}

/// Opacity over the reference length, in [0,1): what the surface share is modulated by.
inline float opacity_of(const TransferView& tf, float mu_t) noexcept {
  return one_minus_exp(mu_t * tf.reference_length_mm);
}

/// All coefficients at a data value.
inline Coefficients classify(const TransferView& tf, float value) noexcept {
  const TransferPiece& piece = find_piece(tf, value);
  const float offset = value - piece.anchor;
  const float mu_t = piece.mu_t + piece.mu_t_slope * offset;
  if (!(mu_t > 0)) return {};
  return {mu_t, min(max(piece.albedo + piece.albedo_slope * offset, Vec3f(0)), Vec3f(1)),
          max(piece.emission + piece.emission_slope * offset, Vec3f(0))};
}

}  // namespace voxlume
