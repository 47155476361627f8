#include "base/vector_targets.h"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tracking/vector_tracker.cpp"
#include <hwy/foreach_target.h>

#include "tracking/vector_tracker-inl.h"

#if HWY_ONCE
#include <hwy/targets.h>

namespace voxlume {
namespace {

struct Target {
  SimdTarget name;
  std::int64_t highway;
  VectorTracker (*select)(VoxelType);
};

// Widest first.
constexpr Target kTargets[] = {
#if HWY_TARGETS & HWY_AVX3
    {SimdTarget::kAvx512, HWY_AVX3, &N_AVX3::select_tracker},
#endif
#if HWY_TARGETS & HWY_AVX2
    {SimdTarget::kAvx2, HWY_AVX2, &N_AVX2::select_tracker},
#endif
#if HWY_TARGETS & HWY_SSE4
    {SimdTarget::kSse4, HWY_SSE4, &N_SSE4::select_tracker},
#endif
#if HWY_TARGETS & HWY_NEON
    {SimdTarget::kNeon, HWY_NEON, &N_NEON::select_tracker},
#endif
    {SimdTarget::kScalar, 0, nullptr},
};

bool runs_here(const Target& target) {
  return target.highway == 0 || (hwy::SupportedTargets() & target.highway) != 0;
}

}  // namespace

SimdTarget best_simd_target() {
  for (const Target& target : kTargets)
    if (runs_here(target)) return target.name;
  return SimdTarget::kScalar;
}

bool has_simd_target(SimdTarget name) {
  for (const Target& target : kTargets)
    if (target.name == name) return runs_here(target);
  return false;
}

const char* simd_name(SimdTarget target) {
  switch (target) {
    case SimdTarget::kSse4:
      return "sse4";
    case SimdTarget::kAvx2:
      return "avx2";
    case SimdTarget::kAvx512:
      return "avx512";
    case SimdTarget::kNeon:
      return "neon";
    case SimdTarget::kScalar:
      break;
  }
  return "scalar";
}

VectorTracker vector_tracker(SimdTarget name, const Medium& medium) {
  if (medium.accelerator.kind != AcceleratorKind::kHierarchy || medium.grid.size[0] < 2) return nullptr;
  for (const Target& target : kTargets)
    if (target.name == name && target.select) return target.select(medium.grid.type);
  return nullptr;
}

}  // namespace voxlume
#endif  // HWY_ONCE
