#pragma once
#include <gtest/gtest.h>

#include <algorithm>

#include "test_scene.h"

namespace voxlume::test {

/// As many equal contributions would have this mean and variance: below some dozens a mean is not normal.
inline double effective_count(const Moments& m) { return m.sum2 > 0 ? m.sum * m.sum / m.sum2 : 0; }

/// Compares the means of the 8x8-pixel blocks that hold enough light for their z values to be normal, and of
/// the picture.
inline void expect_same_mean(const Estimate& a, const Estimate& b) {
  double sum2 = 0, worst = 0;
  int blocks = 0;
  for (int by = 0; by < a.height / 8; ++by) {
    for (int bx = 0; bx < a.width / 8; ++bx) {
      const Moments ma = a.block(bx, by, 8), mb = b.block(bx, by, 8);
      if (effective_count(ma) < 40 || effective_count(mb) < 40) continue;
      const double z = welch_z(ma, mb);
      worst = std::max(worst, std::abs(z));
      sum2 += z * z;
      ++blocks;
    }
  }
  ASSERT_GE(blocks, 4);
  EXPECT_LT(worst, 4);
  EXPECT_LT(sum2, blocks + 4.5 * std::sqrt(2.0 * blocks)) << blocks << " blocks";
  const Moments total_a = a.total(), total_b = b.total();
  EXPECT_LT(std::abs(welch_z(total_a, total_b)), 4) << total_a.mean() << " against " << total_b.mean();
}

}  // namespace voxlume::test
