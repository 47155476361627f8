#pragma once

/// The instruction sets that vector code is compiled for: those with vectors of a size known to the compiler,
/// and few enough to test each. Included before hwy/foreach_target.h.
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_AVX3_DL | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
