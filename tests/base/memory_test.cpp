#include "base/memory.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <memory>
#include <vector>

namespace voxlume {
namespace {

std::uint64_t resident_bytes() {
  std::uint64_t pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  return resident * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
}

TEST(Memory, LargeBlocksGoBackToTheSystem) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
  GTEST_SKIP() << "another allocator";
#endif
  constexpr std::size_t kBlock = 8 << 20, kBlocks = 40;
  std::vector<char>(30 << 20, 'x');  // having seen this freed, the C library would keep what follows
  give_back_large_blocks();
  const std::uint64_t before = resident_bytes();
  std::vector<std::unique_ptr<std::vector<char>>> large, small;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    large.push_back(std::make_unique<std::vector<char>>(kBlock, 'x'));
    small.push_back(std::make_unique<std::vector<char>>(1000, 'x'));  // stays, above it
  }
  EXPECT_GT(resident_bytes(), before + (kBlocks - 1) * kBlock);
  large.clear();
  EXPECT_LT(resident_bytes(), before + 2 * kBlock);
}

}  // namespace
}  // namespace voxlume
