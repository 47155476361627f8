#include "server/roots.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include "server/folder_listing.h"
#include "support/temporary_folder.h"
#include "voxlume/error.h"

namespace voxlume::server {
namespace {

namespace fs = std::filesystem;
using test::write_bytes;

/// root/ with a file and links; beside it a folder of another name that begins alike, and a secret.
class RootsTest : public testing::Test {
 protected:
  void SetUp() override {
    fs::create_directories(root_ / "sub");
    fs::create_directories(folder_ / "root-other");
    write_bytes(root_ / "a.nrrd", "a");
    write_bytes(root_ / "sub/b.nrrd", "b");
    write_bytes(root_ / ".hidden", "h");
    write_bytes(folder_ / "secret", "s");
    write_bytes(folder_ / "root-other/c", "c");
    fs::create_symlink("../secret", root_ / "out");
    fs::create_symlink("..", root_ / "up");
    fs::create_symlink("a.nrrd", root_ / "in");
    fs::create_symlink("nothing", root_ / "dangling");
  }
  std::string refusal(const std::string& text) const {
    try {
      Roots(root_).resolve(text);
    } catch (const Error& error) {
      return error.message();
    }
    return "";
  }

  test::TemporaryFolder folder_;
  const fs::path root_ = fs::canonical(folder_.path()) / "root";
};

TEST_F(RootsTest, FilesBelowAreFoundByWhateverName) {
  const Roots roots(root_);
  for (const std::string text : {"a.nrrd", "./a.nrrd", "sub/../a.nrrd", "in", "sub//..//a.nrrd"})
    EXPECT_EQ(roots.resolve(text), root_ / "a.nrrd") << text;
  EXPECT_EQ(roots.resolve((root_ / "a.nrrd").string()), root_ / "a.nrrd");
  EXPECT_EQ(roots.resolve("sub"), root_ / "sub");
  EXPECT_EQ(roots.resolve(""), root_);
}

TEST_F(RootsTest, WhatLeadsOutsideIsRefused) {
  for (const std::string text : {"..", "../secret", "../", "sub/../../secret", "/etc/passwd", "/", "out",
                                 "up", "up/secret", "../root-other/c", "sub/../../root-other"})
    EXPECT_THAT(refusal(text), testing::HasSubstr("outside")) << text;
  EXPECT_THAT(refusal((folder_.path() / "secret").string()), testing::HasSubstr("outside"));
}

TEST_F(RootsTest, OutsideNothingShowsWhatExists) {
  EXPECT_EQ(refusal("../secret"), refusal("../no-secret"));
  EXPECT_EQ(refusal("/etc/passwd"), refusal("/etc/no-passwd"));
}

TEST_F(RootsTest, WhatIsNeitherFileNorFolderIsNotThere) {
  for (const std::string text : {"nothing", "dangling", "a.nrrd/x"})
    EXPECT_THAT(refusal(text), testing::HasSubstr("no such")) << text;
  ASSERT_EQ(::mkfifo((root_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal("pipe"), testing::HasSubstr("no such"));
}

TEST_F(RootsTest, ZeroBytesAndEndlessNamesAreRefused) {
  EXPECT_NE(refusal(std::string("a.nrrd\0/../../secret", 21)), "");
  EXPECT_NE(refusal(std::string(10000, 'x')), "");
}

TEST_F(RootsTest, SingleFilesCanBeAdded) {
  Roots roots(root_);
  roots.add(folder_.path() / "secret");
  roots.add(folder_.path() / "not there");
  EXPECT_EQ(roots.resolve("../secret").filename(), "secret");
  EXPECT_THROW(roots.resolve("../root-other/c"), Error);
}

TEST_F(RootsTest, VoxelsThatAHeaderNamesAreInsideToo) {
  const Roots roots(root_);
  write_bytes(root_ / "v.raw", "v");
  const auto opens = [&](const std::string& text) {
    write_bytes(root_ / "h", text);
    try {
      roots.resolve_to_open("h");
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  EXPECT_TRUE(opens("ObjectType = Image\nElementDataFile = LOCAL\n/etc/passwd"));
  EXPECT_TRUE(opens("ObjectType = Image\nElementDataFile = v.raw\n"));
  EXPECT_TRUE(opens("NRRD0004\ndata file: sub/../v.raw\r\n\n"));
  EXPECT_TRUE(opens("NRRD0004\ntype: int16\n\n"));
  EXPECT_TRUE(opens("NRRD0004\ndata file: LIST\nv.raw\nsub/b.nrrd\n"));
  EXPECT_FALSE(opens("NRRD0004\ndata file: LIST 2\nv.raw\n/etc/passwd\n"));
  EXPECT_FALSE(opens("NRRD0004\ndata file: ../secret-%d 1 2 1\n\n"));
  EXPECT_TRUE(opens(""));
  for (const char* outside : {"/etc/passwd", "../secret", "out", "sub/../../secret", " \"/etc/passwd\""}) {
    EXPECT_FALSE(opens("ObjectType = Image\nElementDataFile = " + std::string(outside) + "\n")) << outside;
    EXPECT_FALSE(opens("NRRD0004\ndata file: " + std::string(outside) + "\n\n")) << outside;
    EXPECT_FALSE(opens("NRRD0004\nDatafile:" + std::string(outside) + "\n\n")) << outside;
  }
}

TEST_F(RootsTest, SlicesOfAFolderAreInsideToo) {
  Roots roots(root_);
  fs::create_directories(root_ / "series/below");
  write_bytes(root_ / "series/1.dcm", "1");
  fs::create_symlink("../a.nrrd", root_ / "series/2.dcm");
  fs::create_symlink("nothing", root_ / "series/3.dcm");
  fs::create_symlink(folder_.path(), root_ / "series/folder");
  EXPECT_EQ(roots.resolve_to_open("series"), root_ / "series");
  fs::create_symlink(folder_.path() / "secret", root_ / "series/4.dcm");
  try {
    roots.resolve_to_open("series");
    FAIL() << "a slice outside";
  } catch (const Error& error) {
    EXPECT_THAT(error.message(), testing::AllOf(testing::HasSubstr("4.dcm"), testing::HasSubstr("outside")));
  }
  EXPECT_EQ(roots.resolve("series"), root_ / "series");  // it can be listed
  // What the user named himself is as it is.
  roots.add(root_ / "series");
  EXPECT_EQ(roots.resolve_to_open("series"), root_ / "series");
}

TEST_F(RootsTest, PathsOfAScene) {
  const Roots roots(root_);
  SceneDescription scene;
  scene.volume.path = "phantom";
  scene.environment = EnvironmentDescription{.image = "sub/b.nrrd", .color = {}};
  roots.resolve_paths(scene);
  EXPECT_EQ(scene.volume.path, "phantom");
  EXPECT_EQ(scene.environment->image, (root_ / "sub/b.nrrd").string());
  scene.environment->image = "../secret";
  EXPECT_THROW(roots.resolve_paths(scene), Error);
  EXPECT_NO_THROW(roots.resolve_paths(scene, {"../secret"}));
}

TEST_F(RootsTest, ListingShowsFoldersFirstAndNothingOutside) {
  const Roots roots(root_);
  write_bytes(root_ / "x.json", "{}");
  write_bytes(root_ / "y.exr", "e");
  const auto listing = folder_listing(roots, "");
  EXPECT_EQ(listing["path"], "");
  std::vector<std::string> seen;
  for (const auto& entry : listing["entries"])
    seen.push_back(entry["path"].get<std::string>() + " " + entry["kind"].get<std::string>());
  EXPECT_THAT(seen, testing::ElementsAre("sub folder", "a.nrrd volume", "in other", "x.json scene",
                                         "y.exr environment"));
  EXPECT_EQ(listing["entries"][1]["bytes"], 1);
  EXPECT_EQ(folder_listing(roots, "sub")["entries"][0]["path"], "sub/b.nrrd");
  for (const char* wrong : {"..", "up", "a.nrrd", "nothing", "/"})
    EXPECT_THROW(folder_listing(roots, wrong), Error) << wrong;
}

}  // namespace
}  // namespace voxlume::server
