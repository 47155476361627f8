#include "base/parallel.h"

#include <gtest/gtest.h>

namespace voxlume {
namespace {

TEST(Parallel, StopsWhereItsWorkIsNotWanted) {
  std::atomic<bool> cancel{false};
  std::atomic<int> done{0};
  const auto work = [&](std::int64_t i) {
    ++done;
    if (i == 10) cancel = true;
  };
  {
    const CancelScope scope(cancel);
    EXPECT_THROW(parallel_for(1'000'000, 1, work), Cancelled);
    EXPECT_LT(done, 1'000'000);
    done = 0;
    EXPECT_THROW(parallel_for(100, 1, work), Cancelled);  // from the start
    EXPECT_EQ(done, 0);
  }
  parallel_for(100, 7, work);  // and no longer
  EXPECT_EQ(done, 100);
}

TEST(Parallel, CancelsTheCallersWorkAlone) {
  std::atomic<bool> cancel{true}, outer{false};
  const CancelScope scope(outer);
  std::atomic<int> done{0};
  {
    const CancelScope inner(cancel);
    EXPECT_THROW(parallel_for(1, 1, [&](std::int64_t) { ++done; }), Cancelled);
  }
  parallel_for(3, 1, [&](std::int64_t) { ++done; });
  EXPECT_EQ(done, 3);
}

}  // namespace
}  // namespace voxlume
