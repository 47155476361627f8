#pragma once

namespace voxlume::simd {

/// one_minus_exp(mu_t[n] * length_mm) of `count` extinctions [1/mm], the same numbers, by the widest
/// instruction set that the machine has. `opacity` may be `mu_t`.
void find_opacities(const float* mu_t, int count, float length_mm, float* opacity) noexcept;

}  // namespace voxlume::simd
