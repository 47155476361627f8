#include "server/target.h"

#include <gtest/gtest.h>

namespace voxlume::server {
namespace {

TEST(Target, IsTakenApart) {
  const auto target = parse_target("/api/slice?axis=x&mm=-3.5&of=a%20b+c%2Bd&flag");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/api/slice");
  EXPECT_EQ(target->value("axis"), "x");
  EXPECT_EQ(target->value("mm"), "-3.5");
  EXPECT_EQ(target->value("of"), "a b c+d");
  EXPECT_TRUE(target->query.contains("flag"));
  EXPECT_EQ(target->value("absent"), "");
}

TEST(Target, PathKeepsItsPlus) { EXPECT_EQ(parse_target("/a+b%2f")->path, "/a+b/"); }

TEST(Target, OfTwiceGivenKeysTheLastCounts) { EXPECT_EQ(parse_target("/?a=1&a=2")->value("a"), "2"); }

TEST(Target, WithWrongEscapesOrZeroBytesIsNone) {
  for (const char* wrong :
       {"", "x", "*", "http://a/", "/%", "/%4", "/%zz", "/%00", "/?a=%0", "/?%00=1", "/?a=%"})
    EXPECT_FALSE(parse_target(wrong)) << wrong;
}

TEST(Target, OddQueriesAreHarmless) {
  for (const char* odd : {"/?", "/?&", "/?&&=&", "/?=", "/??"}) EXPECT_TRUE(parse_target(odd)) << odd;
}

}  // namespace
}  // namespace voxlume::server
