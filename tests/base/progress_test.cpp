#include "base/progress.h"

#include <gtest/gtest.h>

#include <vector>

#include "base/parallel.h"

namespace voxlume {
namespace {

TEST(ProgressCounter, TellsOfEveryPercentOnceInOrder) {
  for (const int steps : {3, 100, 12345}) {
    std::vector<double> shares;  // told of by one thread at a time
    const Progress tell = [&](double share) { shares.push_back(share); };
    ProgressCounter counter(steps, tell);
    parallel_for(steps, 1, [&](std::int64_t) { counter.add(); });
    ASSERT_FALSE(shares.empty());
    for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]);
    EXPECT_LE(shares.size(), 100u);
    EXPECT_EQ(shares.back(), 1);
  }
}

TEST(ProgressCounter, TellsNobodyWhereNobodyListens) {
  const Progress nobody;
  ProgressCounter counter(2, nobody);
  counter.add(2);
}

}  // namespace
}  // namespace voxlume
