// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_INTEGRATOR_PRIMARY_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_INTEGRATOR_PRIMARY_RAY_INL_H_
#undef VOXLUME_INTEGRATOR_PRIMARY_RAY_INL_H_
#else
#define VOXLUME_INTEGRATOR_PRIMARY_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include <numbers>

#include "integrator/primary_ray.h"
#include "integrator/vector_ray-inl.h"
#include "sampling/vector_random-inl.h"
#include "sampling/warp.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

class PrimaryRayVector {
 public:
  PrimaryRayVector(const SceneView& scene, PrimaryRayBatch& batch) : scene_(scene), batch_(batch) {}

  void fill() {
    for (std::size_t v = 0; v < PrimaryRayBatch::kCount; v += hn::MaxLanes(kF)) fill(v);
  }

 private:
  static constexpr hn::CappedTag<float, 16> kF{};
  static constexpr hn::RebindToSigned<decltype(kF)> kI{};
  static constexpr hn::RebindToUnsigned<decltype(kF)> kU{};
  using F = hn::Vec<decltype(kF)>;
  using Vec = Vector3<F>;

  static F set(float x) { return hn::Set(kF, x); }
  static void store(const Vec& from, PrimaryRayBatch::Column<float> (&to)[3], std::size_t v) {
    hn::Store(from.x, kF, to[0].data() + v);
    hn::Store(from.y, kF, to[1].data() + v);
    hn::Store(from.z, kF, to[2].data() + v);
  }

  static F inverse_erf(F x) {
    const F one = set(1.0f);
    const F w = vector_negative_log(kF, hn::Mul(hn::Sub(one, x), hn::Add(one, x)));
    const auto centre = hn::Lt(w, set(kErfSplit));
    const F s = hn::IfThenElse(centre, hn::Sub(w, set(2.5f)), hn::Sub(hn::Sqrt(w), set(3.0f)));
    F p = hn::IfThenElse(centre, set(kErfCentre[0]), set(kErfTail[0]));
    for (int i = 1; i < 9; ++i)
      p = hn::Add(hn::IfThenElse(centre, set(kErfCentre[i]), set(kErfTail[i])), hn::Mul(p, s));
    return hn::Mul(p, x);
  }

  F sample_filter(F u) const {
    const F centred = hn::Sub(hn::Mul(set(2.0f), u), set(1.0f));
    const float radius_px = scene_.filter_radius_px;
    if (scene_.filter == PixelFilter::kBox) return hn::Mul(set(radius_px), centred);
    const float sigma = radius_px * (1.0f / 3.0f);
    const F offset =
        hn::Mul(set(sigma * std::numbers::sqrt2_v<float>), inverse_erf(hn::Mul(centred, set(kErfOfCut))));
    return hn::Min(hn::Max(offset, set(-radius_px)), set(radius_px));
  }

  void fill(std::size_t v) {
    const auto x = hn::Load(kI, batch_.x.data() + v), y = hn::Load(kI, batch_.y.data() + v);
    const auto pixel = hn::Add(hn::Mul(y, hn::Set(kI, scene_.width)), x);
    const auto sample = hn::BitCast(kU, hn::Load(kI, batch_.sample.data() + v));
    const std::uint32_t picture = sobol_picture_seed(scene_.seed, scene_.frame);
    const auto pixel_seed = vector_mix_bits(kU, hn::Xor(hn::BitCast(kU, pixel), hn::Set(kU, picture)));
    auto rng = seed_vector_rng(kF, scene_.seed, scene_.frame, hn::BitCast(kU, pixel), sample);
    F image[2], flight[4], scattering[4], light[4];
    if (scene_.sampler == Sampler::kSobol) {
      vector_sobol_quad(kF, pixel_seed, sample, SobolSet::kCamera, image);
      vector_sobol_quad(kF, pixel_seed, sample, SobolSet::kFirstFlight, flight);
      vector_sobol_quad(kF, pixel_seed, sample, SobolSet::kFirstScattering, scattering);
      vector_sobol_quad(kF, pixel_seed, sample, SobolSet::kFirstLight, light);
    } else {
      for (F& u : image) u = rng.next(kF);
      for (int i = 0; i < 2; ++i) rng.next(kF);  // the lens
      for (int i = 0; i < 4; ++i) flight[i] = scattering[i] = light[i] = set(-1.0f);
    }
    const F half = set(0.5f);
    const F px = hn::Add(hn::Add(hn::ConvertTo(kF, x), half), sample_filter(image[0]));
    const F py = hn::Add(hn::Add(hn::ConvertTo(kF, y), half), sample_filter(image[1]));
    for (int i = 0; i < 4; ++i) {
      hn::Store(flight[i], kF, batch_.first_flight[i].data() + v);
      hn::Store(scattering[i], kF, batch_.first_scattering[i].data() + v);
      hn::Store(light[i], kF, batch_.first_light[i].data() + v);
    }
    hn::Store(rng.s0, kU, batch_.rng[0].data() + v);
    hn::Store(rng.s1, kU, batch_.rng[1].data() + v);
    hn::Store(rng.s2, kU, batch_.rng[2].data() + v);
    hn::Store(rng.s3, kU, batch_.rng[3].data() + v);
    hn::Store(px, kF, batch_.px.data() + v);
    hn::Store(py, kF, batch_.py.data() + v);

    const CameraView& camera = scene_.camera;
    const F one = set(1.0f), two = set(2.0f);
    const F across =
        hn::Mul(hn::Sub(hn::Div(hn::Mul(two, px), set(camera.width_px)), one), set(camera.half_width));
    const F along =
        hn::Mul(hn::Sub(one, hn::Div(hn::Mul(two, py), set(camera.height_px))), set(camera.half_height));
    const Vec offset = broadcast<F>(camera.right) * across + broadcast<F>(camera.up) * along;
    Vec origin = broadcast<F>(camera.eye_mm), direction = broadcast<F>(camera.forward);
    if (camera.orthographic)
      origin = origin + offset;
    else
      direction = direction + offset;
    direction = normalize(direction);

    const Affinef& index = scene_.medium.grid.index_from_world;
    const Vec origin_index = mapped_point(index, origin);
    const Vec direction_index = mapped_vector(index, direction);
    F t_near, t_far;
    const bool clipped = true;
    vector_visible_part(scene_, origin_index, direction_index, origin, direction,
                        set(std::numeric_limits<float>::infinity()), clipped, t_near, t_far);
    hn::Store(t_near, kF, batch_.t_near.data() + v);
    hn::Store(t_far, kF, batch_.t_far.data() + v);
    store(origin, batch_.origin_world, v);
    store(direction, batch_.direction_world, v);
    store(origin_index, batch_.origin_index, v);
    store(direction_index, batch_.direction_index, v);
  }

  const SceneView& scene_;
  PrimaryRayBatch& batch_;
};

inline void fill_primary_rays(const SceneView& scene, PrimaryRayBatch& batch) {
  PrimaryRayVector(scene, batch).fill();
}

#endif

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
