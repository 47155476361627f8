#include "base/atomic_file.h"

#include <gtest/gtest.h>

#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume {
namespace {

namespace fs = std::filesystem;

ErrorCode code_of(const fs::path& path) {
  try {
    write_file_atomically(path, "x");
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << path << " was written";
  return ErrorCode::kInternal;
}

TEST(AtomicFile, WritesAndReplaces) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder / "a", "one");
  EXPECT_EQ(test::read_bytes(folder / "a"), "one");
  write_file_atomically(folder / "a", "two");
  EXPECT_EQ(test::read_bytes(folder / "a"), "two");
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(AtomicFile, FailureLeavesTheOldFileAndNoOther) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder / "a", "old");
  const auto fail_half_way = [](const fs::path& temporary) {
    test::write_bytes(temporary, "ne");
    throw std::runtime_error("half way");
  };
  EXPECT_THROW(write_file_atomically(folder / "a", fail_half_way), std::runtime_error);
  EXPECT_EQ(test::read_bytes(folder / "a"), "old");
  EXPECT_EQ(folder.entry_count(), 1u);
}

TEST(AtomicFile, TemporaryIsInTheSameFolder) {
  const test::TemporaryFolder folder;
  write_file_atomically(folder / "a", [&](const fs::path& temporary) {
    EXPECT_EQ(temporary.parent_path(), folder.path());
    EXPECT_NE(temporary, folder / "a");
    test::write_bytes(temporary, "x");
  });
  EXPECT_EQ(test::read_bytes(folder / "a"), "x");
}

TEST(AtomicFile, FollowsLinksAndKeepsPermissions) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder / "real");
  write_file_atomically(folder / "real/a", "old");
  fs::permissions(folder / "real/a", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real/a", folder / "link");
  write_file_atomically(folder / "link", "new");
  EXPECT_TRUE(fs::is_symlink(folder / "link"));
  EXPECT_EQ(test::read_bytes(folder / "real/a"), "new");
  EXPECT_EQ(fs::status(folder / "real/a").permissions(), fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("real/b", folder / "dangling");
  write_file_atomically(folder / "dangling", "made");
  EXPECT_EQ(test::read_bytes(folder / "real/b"), "made");
}

TEST(AtomicFile, DevicesAreWrittenInPlace) {
  write_file_atomically("/dev/null", "x");
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST(AtomicFile, ErrorsNameTheCause) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(code_of(folder.path()), ErrorCode::kBadParameter);
  EXPECT_EQ(code_of(folder / "missing/a"), ErrorCode::kFileNotFound);
  EXPECT_EQ(code_of("/dev/full"), ErrorCode::kInternal);
}

TEST(AtomicFile, BareNameIsWrittenToTheCurrentFolder) {
  const test::TemporaryFolder folder;
  const fs::path before = fs::current_path();
  fs::current_path(folder.path());
  write_file_atomically("bare", "x");
  fs::current_path(before);
  EXPECT_EQ(test::read_bytes(folder / "bare"), "x");
}

}  // namespace
}  // namespace voxlume
