#include "render/frame_files.h"

#include <gtest/gtest.h>

#include "voxlume/error.h"

namespace voxlume {
namespace {

TEST(FramePattern, NumbersFrames) {
  EXPECT_EQ(FramePattern("out/f-####.png", "-o").path(7), "out/f-0007.png");
  EXPECT_EQ(FramePattern("####", "-o").path(123456), "123456");
  EXPECT_EQ(FramePattern("a#b.exr", "-o").path(0), "a0b.exr");
  EXPECT_EQ(FramePattern("dir#/{}%d##.png", "-o").path(3), "dir#/{}%d03.png");
}

TEST(FramePattern, IsOneRunInTheFilesOwnName) {
  EXPECT_TRUE(FramePattern::is_pattern("f-#.png"));
  EXPECT_FALSE(FramePattern::is_pattern("take#2/f.png"));
  EXPECT_THROW(FramePattern("f.png", "-o"), Error);
  EXPECT_THROW(FramePattern("#-#.png", "-o"), Error);
}

}  // namespace
}  // namespace voxlume
