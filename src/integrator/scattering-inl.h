// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_INTEGRATOR_SCATTERING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_INTEGRATOR_SCATTERING_INL_H_
#undef VOXLUME_INTEGRATOR_SCATTERING_INL_H_
#else
#define VOXLUME_INTEGRATOR_SCATTERING_INL_H_
#endif

#include <hwy/highway.h>

#include <bit>

#include "grid/vector_gradient-inl.h"
#include "integrator/scattering.h"
#include "integrator/vector_ray-inl.h"
#include "light/vector_light-inl.h"
#include "material/vector_scatter-inl.h"
#include "transfer/vector_transfer-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

/// scatter_at, a vector of scatterings at a time.
class ScatteringVector {
 public:
  ScatteringVector(const SceneView& scene, ScatteringBatch& batch) : scene_(scene), batch_(batch) {}

  void fill() {
    for (int v = 0; v < batch_.count; v += static_cast<int>(kN)) fill(static_cast<std::size_t>(v));
  }

 private:
  static constexpr hn::CappedTag<float, 16> kF{};
  static constexpr hn::RebindToSigned<decltype(kF)> kI{};
  static constexpr hn::RebindToUnsigned<decltype(kF)> kU{};
  static constexpr std::size_t kN = hn::MaxLanes(kF);
  using F = hn::Vec<decltype(kF)>;
  using Mask = hn::Mask<decltype(kF)>;
  using V3 = Vector3<F>;
  using Column = ScatteringBatch::Column<float>;

  static F load(const Column& a, std::size_t v) { return hn::Load(kF, a.data() + v); }
  static V3 load(const Column (&a)[3], std::size_t v) {
    return {load(a[0], v), load(a[1], v), load(a[2], v)};
  }
  static void store(F x, Column& a, std::size_t v) { hn::Store(x, kF, a.data() + v); }
  static void store(const V3& x, Column (&a)[3], std::size_t v) {
    store(x.x, a[0], v);
    store(x.y, a[1], v);
    store(x.z, a[2], v);
  }
  static void store(Mask x, ScatteringBatch::Column<std::uint32_t>& a, std::size_t v) {
    hn::Store(hn::BitCast(kU, hn::VecFromMask(kF, x)), kU, a.data() + v);
  }
  static Vec3f one_of(const Column (&a)[3], std::size_t i) { return {a[0][i], a[1][i], a[2][i]}; }
  static void put(Vec3f x, Column (&a)[3], std::size_t i) {
    for (int c = 0; c < 3; ++c) a[c][i] = x[c];
  }

  /// Calls use(i) for the batch's columns i of the lanes in `where` that are taken.
  template <class Use>
  void for_each(Mask where, std::size_t v, Use&& use) const {
    std::uint8_t bytes[8] = {};
    hn::StoreMaskBits(kF, where, bytes);
    for (std::uint32_t bits = bytes[0] | bytes[1] << 8; bits; bits &= bits - 1) {
      const std::size_t i = v + static_cast<std::size_t>(std::countr_zero(bits));
      if (i < static_cast<std::size_t>(batch_.count)) use(i);
    }
  }

  void fill(std::size_t v) {
    const VectorScatterPoint<F> point = matter(v);
    const V3 wo = load(batch_.wo, v);
    const VectorScatterChoice<F> choice = vector_scatter_choice(point, wo);
    store(choice.specular, batch_.specular, v);
    store(choice.surface, batch_.surface, v);
    store(choice.any, batch_.any, v);
    if (batch_.samples_light) {
      sample_light(v);
      const auto toward = vector_eval_scatter(point, choice, wo, load(batch_.light_wi, v));
      store(toward.value, batch_.light_value, v);
      store(toward.pdf, batch_.light_value_pdf, v);
      ray(load(batch_.light_wi, v), load(batch_.light_mm, v), batch_.light_direction_index, batch_.light_near,
          batch_.light_far, v);
    }
    if (batch_.turns) {
      const auto turn = vector_sample_scatter(point, choice, wo, load(batch_.u_lobe, v),
                                              load(batch_.direction0, v), load(batch_.direction1, v));
      store(turn.wi, batch_.turn_wi, v);
      store(turn.value, batch_.turn_value, v);
      store(turn.pdf, batch_.turn_pdf, v);
      ray(turn.wi, hn::Inf(kF), batch_.turn_direction_index, batch_.turn_near, batch_.turn_far, v);
      store(vector_meets_rect_light(scene_.lights, load(batch_.p_world, v), turn.wi), batch_.turn_meets_rect,
            v);
    }
  }

  /// ray_from.
  void ray(const V3& direction, F t_max, Column (&direction_index)[3], Column& near, Column& far,
           std::size_t v) {
    const V3 index = mapped_vector(scene_.medium.grid.index_from_world, direction);
    F t_near, t_far;
    vector_visible_part(scene_, load(batch_.p_index, v), index, load(batch_.p_world, v), direction, t_max,
                        !scene_.clip_blocks_light, t_near, t_far);
    store(index, direction_index, v);
    store(t_near, near, v);
    store(t_far, far, v);
  }

  /// classify of the data; also the extinction.
  F classify_matter(std::size_t v) {
    const TransferView& transfer = scene_.medium.transfer;
    const F value = load(batch_.value, v), zero = hn::Zero(kF);
    const auto everywhere = hn::Eq(hn::Zero(kI), hn::Zero(kI));
    const auto word = hn::ShiftLeft<4>(vector_find_piece(kF, transfer, everywhere, value));
    static_assert(sizeof(TransferPiece) == 16 * sizeof(float));
    const auto* table = &transfer.pieces->start;
    const auto field = [&](std::size_t at) { return hn::GatherIndex(kF, table + at / sizeof(float), word); };
    const F offset = value - field(offsetof(TransferPiece, anchor));
    const auto linear = [&](std::size_t at, std::size_t slope) { return field(at) + field(slope) * offset; };
    const F mu_t = linear(offsetof(TransferPiece, mu_t), offsetof(TransferPiece, mu_t_slope));
    const Mask matters = hn::Gt(mu_t, zero);
    for (std::size_t c = 0; c < 3; ++c) {
      const std::size_t at = c * sizeof(float);
      const F albedo =
          linear(offsetof(TransferPiece, albedo) + at, offsetof(TransferPiece, albedo_slope) + at);
      store(hn::IfThenElseZero(matters, clamped_color(albedo)), batch_.albedo[c], v);
      F emission = zero;
      if (scene_.matter_emits)
        emission =
            linear(offsetof(TransferPiece, emission) + at, offsetof(TransferPiece, emission_slope) + at);
      store(hn::IfThenElseZero(hn::And(matters, hn::Gt(emission, zero)), emission), batch_.emission[c], v);
    }
    return hn::IfThenElseZero(matters, mu_t);
  }
  /// min(max(x, 0), 1) of base/vec.h.
  static F clamped_color(F x) {
    const F zero = hn::Zero(kF), one = hn::Set(kF, 1.0f);
    const F above = hn::IfThenElse(hn::Gt(x, zero), x, zero);
    return hn::IfThenElse(hn::Lt(above, one), above, one);
  }

  /// matter_at, and Exposure Render's choice between surface and medium.
  VectorScatterPoint<F> matter(std::size_t v) {
    const ScatteringView& scattering = scene_.scattering;
    const F zero = hn::Zero(kF);
    const V3 p_index = load(batch_.p_index, v),
             p_world = mapped_point(scene_.medium.grid.world_from_index, p_index);
    store(p_world, batch_.p_world, v);
    const F mu_t = classify_matter(v);
    if (scene_.labels.color_count)
      for_each(hn::Eq(zero, zero), v, [&](std::size_t i) {
        put(labelled_albedo(scene_.labels, one_of(batch_.p_world, i), one_of(batch_.albedo, i)),
            batch_.albedo, i);
      });
    V3 normal{zero, zero, zero};
    F share = zero;
    if (scattering.shading != Shading::kPhase) surface(v, p_index, p_world, mu_t, normal, share);
    F p_brdf = share;
    if (scattering.shading == Shading::kExposureRender)
      p_brdf = hn::IfThenElseZero(hn::Lt(load(batch_.u_surface, v), share), hn::Set(kF, 1.0f));
    store(normal, batch_.normal, v);
    store(share, batch_.surface_share, v);
    store(p_brdf, batch_.p_brdf, v);
    return {normal, p_brdf, load(batch_.albedo, v), scattering.g, scattering.alpha, scattering.f0};
  }

  static Mask contains(const Box3f& box, const V3& p) {
    const auto within = [](F x, float lower, float upper) {
      return hn::And(hn::Ge(x, hn::Set(kF, lower)), hn::Le(x, hn::Set(kF, upper)));
    };
    return hn::And(within(p.x, box.lower.x, box.upper.x),
                   hn::And(within(p.y, box.lower.y, box.upper.y), within(p.z, box.lower.z, box.upper.z)));
  }

  /// The normal and the surface's share, both 0 where there is no surface.
  void surface(std::size_t v, const V3& p_index, const V3& p_world, F mu_t, V3& normal, F& share) {
    const ScatteringView& scattering = scene_.scattering;
    const F zero = hn::Zero(kF);
    V3 faces{zero, zero, zero};
    const FaceReach reach(scene_.clip_world, scene_.medium.grid);
    const Mask deep = hn::And(contains(reach.deep_index, p_index), contains(reach.deep_world, p_world));
    if (!hn::AllTrue(kF, deep)) {
      store(faces, batch_.normal, v);
      for_each(hn::Not(deep), v, [&](std::size_t i) {
        put(face_normals(scene_.clip_world, scene_.medium.grid, one_of(batch_.p_index, i),
                         one_of(batch_.p_world, i)),
            batch_.normal, i);
      });
      faces = load(batch_.normal, v);
    }
    const V3 gradient = vector_gradient(kF, scene_.medium.grid, p_index);
    const V3 outward = gradient * hn::Set(kF, -scattering.inverse_gradient_scale) + faces;
    const F magnitude = length(outward);
    const Mask has_surface = hn::And(hn::Gt(magnitude, hn::Set(kF, 1e-6f)), hn::Lt(magnitude, hn::Inf(kF)));
    normal = choose_or_zero(has_surface, outward / magnitude);
    share = hn::Set(kF, 1.0f);
    if (scattering.shading != Shading::kBrdf) {
      const F opacity = vector_one_minus_exp(mu_t * hn::Set(kF, scene_.medium.transfer.reference_length_mm));
      share = vector_surface_share(scattering.surface_share, scattering.gradient_factor,
                                   scattering.opacity_modulated, opacity, magnitude);
    }
    share = hn::IfThenElseZero(has_surface, share);
  }

  void sample_light(std::size_t v) {
    const F u_light = load(batch_.u_light, v), u0 = load(batch_.light0, v), u1 = load(batch_.light1, v);
    Mask left;
    const auto sample = vector_sample_light(scene_.lights, load(batch_.p_world, v), u_light, u0, u1, left);
    store(sample.wi, batch_.light_wi, v);
    store(sample.distance_mm, batch_.light_mm, v);
    store(sample.radiance, batch_.light_radiance, v);
    store(sample.pdf, batch_.light_pdf, v);
    store(sample.delta, batch_.light_delta, v);
    for_each(left, v, [&](std::size_t i) {
      const LightSample one = voxlume::sample_light(scene_.lights, one_of(batch_.p_world, i),
                                                    batch_.u_light[i], batch_.light0[i], batch_.light1[i]);
      put(one.wi, batch_.light_wi, i);
      put(one.radiance, batch_.light_radiance, i);
      batch_.light_mm[i] = one.distance_mm;
      batch_.light_pdf[i] = one.pdf;
      batch_.light_delta[i] = one.delta;
    });
  }

  const SceneView& scene_;
  ScatteringBatch& batch_;
};

inline void fill_scatterings(const SceneView& scene, ScatteringBatch& batch) {
  ScatteringVector(scene, batch).fill();
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
