// What readers tell of how far they are.
#include <fmt/format.h>
#include <sys/wait.h>

#include <atomic>

#include "base/parallel.h"
#include "dicom_builder.h"
#include "test_files.h"

namespace voxlume::test {
namespace {

/// What is told while `path` is read: growing shares.
std::vector<double> shares_of(const fs::path& path, ReadOptions options = {}) {
  std::vector<double> shares;
  options.progress = [&](double share) { shares.push_back(share); };
  read_volume(path, options);
  for (std::size_t i = 1; i < shares.size(); ++i) EXPECT_GT(shares[i], shares[i - 1]) << path;
  EXPECT_GT(shares.at(0), 0) << path;
  EXPECT_EQ(shares.back(), 1) << path;
  return shares;
}

/// 2.2 MB, which gzip leaves about as they are.
Volume noise() {
  return make_volume(VoxelType::kI16, {110, 100, 100}, [n = 1u](auto, auto, auto) mutable {
    return static_cast<double>((n = n * 1664525u + 1013904223u) >> 17);
  });
}

TEST(Progress, OfWhatIsInflatedComesInManyShares) {
  const TemporaryFolder folder;
  for (const char* name : {"a.nrrd", "a.nii.gz"}) {
    write_volume(noise(), folder / name);
    EXPECT_GE(shares_of(folder / name).size(), 8u) << name;
  }
}

TEST(Progress, OfRawVoxelsThatAreSwapped) {
  const TemporaryFolder folder;
  const Volume volume = noise();
  write_bytes(folder / "a.raw", {static_cast<const char*>(volume.voxels.get()), volume.byte_count()});
  EXPECT_GE(shares_of(folder / "a.raw", {.raw = parse_raw_spec("110x100x100,i16,1,1,1,big")}).size(), 8u);
}

TEST(Progress, OfVoxelsThatAreMappedIsItsEndAlone) {
  const TemporaryFolder folder;
  write_volume(noise(), folder / "a.mha");
  EXPECT_EQ(shares_of(folder / "a.mha"), std::vector<double>{1});
}

TEST(Progress, OfSeriesCountsFiles) {
  const TemporaryFolder folder;
  const DicomBuilder dicom;
  fs::create_directory(folder / "dicom");
  fs::create_directory(folder / "tiff");
  for (int i = 0; i < 20; ++i) {
    write_bytes(folder / fmt::format("dicom/{}.dcm", i), dicom.slice(i, {0, 0, 2.0 * i}, 1024 + i));
    write_volume(make_test_volume(VoxelType::kU8, {7, 5, 1}), folder / fmt::format("tiff/{:02}.tif", i));
  }
  for (const char* name : {"dicom", "tiff"}) EXPECT_GE(shares_of(folder / name).size(), 30u) << name;
}

TEST(Progress, MayFindThatTheVolumeIsNotWantedAnyMore) {
  const TemporaryFolder folder;
  write_volume(noise(), folder / "a.nrrd");
  std::atomic<bool> outdated{false};
  const CancelScope scope(outdated);
  std::vector<double> shares;
  ReadOptions options;
  options.progress = [&](double share) {
    shares.push_back(share);
    outdated = true;
  };
  EXPECT_THROW(read_volume(folder / "a.nrrd", options), Cancelled);
  ASSERT_FALSE(shares.empty());
  EXPECT_LT(shares.back(), 1);
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1) << "the reader has ended";
}

TEST(Progress, EndsWithAnError) {
  const TemporaryFolder folder;
  write_volume(noise(), folder / "a.nii.gz");
  fs::resize_file(folder / "a.nii.gz", fs::file_size(folder / "a.nii.gz") - 4);  // into the checksum
  std::vector<double> shares;
  ReadOptions options;
  options.progress = [&](double share) { shares.push_back(share); };
  EXPECT_THROW(read_volume(folder / "a.nii.gz", options), Error);
  ASSERT_FALSE(shares.empty());
  EXPECT_LT(shares.back(), 1);
}

}  // namespace
}  // namespace voxlume::test
