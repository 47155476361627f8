#pragma once

/// Programmer errors only; off in release builds (NDEBUG). Prints both operands and stops.
#ifdef NDEBUG
#define VOXLUME_ASSERT_LE(a, b) ((void)0)
#define VOXLUME_ASSERT(condition) ((void)0)
#else
#include <cstdio>
#include <cstdlib>
#define VOXLUME_ASSERT_LE(a, b)                                                                        \
  ((a) <= (b) ? (void)0                                                                                \
              : (std::fprintf(stderr, "%s:%d: %s <= %s failed: %g > %g\n", __FILE__, __LINE__, #a, #b, \
                              static_cast<double>(a), static_cast<double>(b)),                         \
                 std::abort()))
#define VOXLUME_ASSERT(condition) \
  ((condition) ? (void)0          \
               : (std::fprintf(stderr, "%s:%d: %s failed\n", __FILE__, __LINE__, #condition), std::abort()))
#endif
