#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <thread>

#include "test_files.h"
#include "volume_io/isolated_read.h"

namespace voxlume::test {
namespace {

std::size_t open_files() {
  std::size_t count = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator("/proc/self/fd")) ++count;
  return count;
}

TEST(Isolation, MemoryLimitIsCheckedBeforeAnythingIsAllocated) {
  const TemporaryFolder folder;
  write_volume(make_test_volume(VoxelType::kI16, {10, 10, 10}), folder / "a.nrrd");
  ReadOptions options;
  options.memory_limit_bytes = 1999;
  expect_error(ErrorCode::kOutOfMemory,
               "10x10x10 i16 voxels need 2000 bytes of memory; 1999 bytes is the limit given",
               [&] { read_volume(folder / "a.nrrd", options); });
  options.memory_limit_bytes = 2000;
  EXPECT_EQ(read_volume(folder / "a.nrrd", options).byte_count(), 2000u);
}

TEST(Isolation, MoreThanTheMachineHasIsRefused) {
  const TemporaryFolder folder;
  // A sparse data file holds what the header promises: only memory stands in the way, as the byte order
  // forces a copy.
  write_bytes(folder / "a.mhd",
              "ObjectType = Image\nNDims = 3\nDimSize = 32768 8192 8192\nElementType = "
              "MET_USHORT\nBinaryDataByteOrderMSB = True\nElementDataFile = a.raw\n");
  write_bytes(folder / "a.raw", "");
  fs::resize_file(folder / "a.raw", 1ull << 42);
  expect_error(ErrorCode::kOutOfMemory, "need 4398.0 GB of memory", [&] { read_volume(folder / "a.mhd"); });
}

TEST(Isolation, LeavesNoDescriptorNoChildNoOutput) {
  const TemporaryFolder folder;
  write_volume(make_test_volume(VoxelType::kI16), folder / "a.nrrd");
  write_bytes(folder / "bad.nrrd", "NRRD0004\ntype: nothing\n");
  write_bytes(folder / "bad.h5", "\x89HDF\r\n\x1a\n and then nothing");
  write_bytes(folder / "bad.tif", std::string("II*\0\x08\0\0\0", 8));
  const std::size_t before = open_files();
  testing::internal::CaptureStderr();
  testing::internal::CaptureStdout();
  {
    const Volume volume = read_volume(folder / "a.nrrd");
    for (const char* name : {"bad.nrrd", "bad.h5", "bad.tif"})
      EXPECT_THROW(read_volume(folder / name), Error) << name;
  }
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(open_files(), before);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
}

TEST(Isolation, VoxelsOutliveTheFileAndCopiesOfTheVolume) {
  const TemporaryFolder folder;
  const Volume original = make_test_volume(VoxelType::kI16);
  write_volume(original, folder / "a.nii.gz");
  Volume copy;
  {
    const Volume volume = read_volume(folder / "a.nii.gz");
    copy = volume;
  }
  fs::remove(folder / "a.nii.gz");
  expect_same_voxels(original, copy);
}

TEST(Isolation, ManyThreadsReadAndWriteAtOnce) {
  const TemporaryFolder folder;
  const Volume original = make_test_volume(VoxelType::kI16, {20, 20, 20});
  const char* extensions[] = {".nrrd", ".mha", ".h5", ".tif"};
  std::atomic<int> good{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 5; ++i) {
        const fs::path path = folder / (std::to_string(t) + "-" + std::to_string(i) + extensions[t]);
        write_volume(original, path);
        const Volume back = read_volume(path);
        good += std::memcmp(back.voxels.get(), original.voxels.get(), original.byte_count()) == 0;
      }
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(good, 20);
}

TEST(Isolation, InProcessReadingGivesTheSame) {
  const TemporaryFolder folder;
  const Volume original = make_test_volume(VoxelType::kU16);
  write_volume(original, folder / "a.nrrd");
  expect_same_voxels(original, read_in_process(folder / "a.nrrd", {}));
  expect_error(ErrorCode::kBadFormat, "empty", [&] {
    write_bytes(folder / "b.nrrd", "");
    read_in_process(folder / "b.nrrd", {});
  });
}

}  // namespace
}  // namespace voxlume::test
