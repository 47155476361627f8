#include <gmock/gmock.h>
#include <hdf5.h>

#include <utility>

#include "test_files.h"

namespace voxlume::test {
namespace {

constexpr const char* kGroup = "/ITKImage/0";
constexpr const char* kVoxels = "/ITKImage/0/VoxelData";

/// a.h5 as ITK writes it, with secret.h5, another one beside it.
class Hdf5Links : public testing::Test {
 protected:
  void SetUp() override {
    write_volume(make_test_volume(VoxelType::kU8), file_);
    write_volume(make_test_volume(VoxelType::kU8), other_);
    write_bytes(folder_ / "raw.bin", std::string(140, 'x'));
    id_ = H5Fopen(file_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    ASSERT_GE(id_, 0);
  }
  void TearDown() override { close(); }
  void close() {
    if (id_ >= 0) EXPECT_GE(H5Fclose(std::exchange(id_, -1)), 0);
  }
  void remove_voxels() { ASSERT_GE(H5Ldelete(id_, kVoxels, H5P_DEFAULT), 0); }
  /// Voxels like those that were removed, by other means.
  void create_voxels(hid_t properties) {
    const hsize_t size[] = {4, 5, 7};
    const hid_t space = H5Screate_simple(3, size, nullptr);
    const hid_t voxels =
        H5Dcreate2(id_, kVoxels, H5T_NATIVE_UCHAR, space, H5P_DEFAULT, properties, H5P_DEFAULT);
    EXPECT_GE(voxels, 0);
    H5Dclose(voxels);
    H5Sclose(space);
  }
  void expect_refused() {
    close();
    try {
      read_volume(file_);
      FAIL() << "it is read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kUnsupported) << error.what();
      EXPECT_THAT(error.message(), testing::HasSubstr("other files"));
    }
  }

  TemporaryFolder folder_;
  const fs::path file_ = folder_ / "a.h5", other_ = folder_ / "secret.h5";
  hid_t id_ = -1;
};

TEST_F(Hdf5Links, WithinTheFileAreFollowed) {
  ASSERT_GE(H5Lmove(id_, kVoxels, id_, "/voxels", H5P_DEFAULT, H5P_DEFAULT), 0);
  ASSERT_GE(H5Lcreate_soft("/voxels", id_, kVoxels, H5P_DEFAULT, H5P_DEFAULT), 0);
  close();
  const Volume volume = read_volume(file_);
  EXPECT_EQ(volume.size, (std::array<std::int64_t, 3>{7, 5, 4}));
}

TEST_F(Hdf5Links, ToAnotherFileAreRefused) {
  remove_voxels();
  ASSERT_GE(H5Lcreate_external("secret.h5", kVoxels, id_, kVoxels, H5P_DEFAULT, H5P_DEFAULT), 0);
  expect_refused();
}

TEST_F(Hdf5Links, ToAnotherFileAreRefusedByWhateverWay) {
  remove_voxels();
  ASSERT_GE(H5Lcreate_external("secret.h5", kGroup, id_, "/elsewhere", H5P_DEFAULT, H5P_DEFAULT), 0);
  ASSERT_GE(H5Lcreate_soft("/elsewhere/VoxelData", id_, kVoxels, H5P_DEFAULT, H5P_DEFAULT), 0);
  expect_refused();
}

TEST_F(Hdf5Links, StorageInAnotherFileIsRefused) {
  remove_voxels();
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE);
  ASSERT_GE(H5Pset_external(properties, (folder_ / "raw.bin").c_str(), 0, 140), 0);
  create_voxels(properties);
  H5Pclose(properties);
  expect_refused();
}

TEST_F(Hdf5Links, DataMadeOfAnotherFilesIsRefused) {
  remove_voxels();
  const hsize_t size[] = {4, 5, 7};
  const hid_t properties = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(3, size, nullptr);
  ASSERT_GE(H5Pset_virtual(properties, space, "secret.h5", kVoxels, space), 0);
  create_voxels(properties);
  H5Sclose(space);
  H5Pclose(properties);
  expect_refused();
}

}  // namespace
}  // namespace voxlume::test
