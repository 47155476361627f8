#include "base/progress_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <vector>

namespace voxlume {
namespace {

using testing::DoubleEq;
using testing::ElementsAre;

TEST(PartOf, APartTellsOfItsShareOfTheWhole) {
  std::vector<double> told;
  const Progress whole = [&](double share) { told.push_back(share); };
  part_of(whole, 0, 4)(0.5);
  part_of(whole, 3, 4)(0.5);
  part_of(whole, 3, 4)(1.5);
  EXPECT_THAT(told, ElementsAre(DoubleEq(0.125), DoubleEq(0.875), DoubleEq(1)));
  EXPECT_FALSE(part_of({}, 0, 2));
}

TEST(LongWork, TellsOfGrowingSharesAndOfTheEnd) {
  std::vector<double> told;
  const Progress tell = [&](double share) { told.push_back(share); };
  {
    LongWork work(tell, 0);
    work.is_done(0.25);
    work.is_done(0.2);
    work.is_done(0.25);
  }
  EXPECT_THAT(told, ElementsAre(0.25, 1));
  told.clear();
  { LongWork(tell, 0).is_done(1); }
  EXPECT_THAT(told, ElementsAre(1));
}

TEST(LongWork, TellsNothingOfWhatIsSoonOver) {
  int told = 0;
  const Progress tell = [&](double) { ++told; };
  { LongWork(tell, 1000).is_done(0.5); }
  { LongWork(tell, 0); }
  EXPECT_EQ(told, 0);
  LongWork({}, 0).is_done(0.5);
}

}  // namespace
}  // namespace voxlume
