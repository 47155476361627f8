// Included once for every instruction set; hence no include guard of the usual kind.
#if defined(VOXLUME_INTEGRATOR_VECTOR_RAY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef VOXLUME_INTEGRATOR_VECTOR_RAY_INL_H_
#undef VOXLUME_INTEGRATOR_VECTOR_RAY_INL_H_
#else
#define VOXLUME_INTEGRATOR_VECTOR_RAY_INL_H_
#endif

#include <hwy/highway.h>

#include "integrator/scene_view.h"
#include "sampling/vector_math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace voxlume {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// clip_ray: cuts [t_near, t_far] to `box`, or makes it empty.
template <class F>
void vector_clip_ray(const Box3f& box, const Vector3<F>& origin, const Vector3<F>& direction, F& t_near,
                     F& t_far) {
  const F zero = broadcast<F>(0.0f), one = broadcast<F>(1.0f);
  auto misses = hn::Lt(zero, zero);
  const auto cut = [&](F o, F d, float lower_, float upper_) HWY_ATTR {
    const F lower = broadcast<F>(lower_), upper = broadcast<F>(upper_);
    const auto still = hn::Eq(d, zero);
    misses = hn::Or(misses, hn::And(still, hn::Or(hn::Lt(o, lower), hn::Gt(o, upper))));
    const F inverse = one / hn::IfThenElse(still, one, d);
    const F t0 = (lower - o) * inverse, t1 = (upper - o) * inverse;
    t_near = hn::IfThenElse(still, t_near, hn::Max(t_near, hn::Min(t0, t1)));
    t_far = hn::IfThenElse(still, t_far, hn::Min(t_far, hn::Max(t0, t1)));
  };
  cut(origin.x, direction.x, box.lower.x, box.upper.x);
  cut(origin.y, direction.y, box.lower.y, box.upper.y);
  cut(origin.z, direction.z, box.lower.z, box.upper.z);
  t_near = hn::IfThenElse(misses, one, t_near);
  t_far = hn::IfThenElse(misses, zero, t_far);
}

/// visible_part.
template <class F>
void vector_visible_part(const SceneView& scene, const Vector3<F>& origin_index,
                         const Vector3<F>& direction_index, const Vector3<F>& origin_world,
                         const Vector3<F>& direction_world, F t_max, bool clipped, F& t_near, F& t_far) {
  t_near = broadcast<F>(0.0f);
  t_far = t_max;
  vector_clip_ray(scene.domain_index, origin_index, direction_index, t_near, t_far);
  if (!clipped) return;
  F clip_near = t_near, clip_far = t_far;
  vector_clip_ray(scene.clip_world, origin_world, direction_world, clip_near, clip_far);
  const auto enters = hn::Lt(t_near, t_far);
  t_near = hn::IfThenElse(enters, clip_near, t_near);
  t_far = hn::IfThenElse(enters, clip_far, t_far);
}

}  // namespace HWY_NAMESPACE
}  // namespace voxlume
HWY_AFTER_NAMESPACE();

#endif
