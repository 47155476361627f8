#include <fmt/format.h>
#include <gtest/gtest.h>

#include "test_files.h"

namespace voxlume::test {
namespace {

struct Format {
  const char* name;  ///< of the file
  bool has_origin;
  bool has_direction;
};

constexpr Format kFormats[] = {
    {"a.nrrd", true, true}, {"a.nhdr", true, true}, {"a.mha", true, true},
    {"a.mhd", true, true},  {"a.nii", true, true},  {"a.nii.gz", true, true},
    {"a.vtk", true, false}, {"a.h5", true, true},   {"a.tif", false, false},
};

constexpr VoxelType kTypes[] = {VoxelType::kU8,  VoxelType::kI8,  VoxelType::kU16, VoxelType::kI16,
                                VoxelType::kU32, VoxelType::kI32, VoxelType::kF32, VoxelType::kF64};

class RoundTrip : public testing::TestWithParam<std::tuple<Format, VoxelType>> {};

TEST_P(RoundTrip, KeepsVoxelsAndGeometry) {
  const auto [format, type] = GetParam();
  Volume volume = make_test_volume(type);
  volume.spacing_mm = {0.957, 1.25, 2.5};
  if (format.has_origin) volume.origin_mm = {-123.456, 78.9, -1031.25};
  if (format.has_direction) volume.direction = rotation({0.6, 0.0, 0.8}, 0.7);
  const TemporaryFolder folder;
  write_volume(volume, folder / format.name);
  const Volume back = read_volume(folder / format.name);
  expect_same_voxels(volume, back);
  expect_same_geometry(volume, back);
  EXPECT_FALSE(back.format.empty());
  const bool tiff = std::string_view(format.name).ends_with(".tif");
  EXPECT_EQ(back.warnings.size(), tiff ? 1u : 0u)
      << "TIFF alone has something to say: it carries no orientation";
}

INSTANTIATE_TEST_SUITE_P(Formats, RoundTrip,
                         testing::Combine(testing::ValuesIn(kFormats), testing::ValuesIn(kTypes)),
                         [](const auto& test) {
                           std::string name = std::get<0>(test.param).name;
                           for (char& c : name) c = c == '.' ? '_' : c;
                           return name + "_" + std::string(voxel_type_name(std::get<1>(test.param)));
                         });

TEST(RoundTrip, ExtensionMayBeUpperCase) {
  const TemporaryFolder folder;
  const Volume volume = make_test_volume(VoxelType::kI16);
  write_volume(volume, folder / "A.NRRD");
  expect_same_voxels(volume, read_volume(folder / "A.NRRD"));
}

TEST(RoundTrip, ContentDecidesWhenTheNameSaysNothing) {
  const TemporaryFolder folder;
  const Volume volume = make_test_volume(VoxelType::kI16);
  for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.tif", "a.vtk", "a.h5"}) {
    write_volume(volume, folder / name);
    fs::rename(folder / name, folder / "scan.dat");
    expect_same_voxels(volume, read_volume(folder / "scan.dat"));
  }
}

TEST(RoundTrip, LeftHandedAxesSurvive) {
  Volume volume = make_test_volume(VoxelType::kI16);
  volume.direction = {1, 0, 0, 0, -1, 0, 0, 0, 1};
  volume.origin_mm = {-10, 20, -30};
  const TemporaryFolder folder;
  for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.nii.gz", "a.h5"}) {
    write_volume(volume, folder / name);
    const Volume back = read_volume(folder / name);
    expect_same_voxels(volume, back);
    expect_same_geometry(volume, back);
  }
}

TEST(RoundTrip, ModalityIsKeptWhereTheFormatHasAPlace) {
  Volume volume = make_test_volume(VoxelType::kI16);
  volume.modality = "CT";
  const TemporaryFolder folder;
  for (const char* name : {"a.nrrd", "a.nhdr"}) {
    write_volume(volume, folder / name);
    EXPECT_EQ(read_volume(folder / name).modality, "CT") << name;
  }
  write_bytes(
      folder / "b.mha",
      "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nModality = MET_MOD_MR\nElementType = MET_UCHAR\n"
      "ElementDataFile = LOCAL\nab");
  EXPECT_EQ(read_volume(folder / "b.mha").modality, "MR");
}

TEST(RoundTrip, WritingReplacesAndLeavesNothingBeside) {
  const TemporaryFolder folder;
  const Volume first = make_test_volume(VoxelType::kI16);
  const Volume second = make_test_volume(VoxelType::kF32, {3, 4, 5});
  for (const char* name : {"a.nrrd", "b.nhdr", "c.mhd", "d.nii"}) {
    write_volume(first, folder / name);
    write_volume(second, folder / name);
    expect_same_voxels(second, read_volume(folder / name));
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  EXPECT_EQ(names, (std::vector<std::string>{"a.nrrd", "b.nhdr", "b.raw", "c.mhd", "c.raw", "d.nii"}));
}

TEST(RoundTrip, DetachedHeadersDoNotShareData) {
  const TemporaryFolder folder;
  const Volume volume = make_test_volume(VoxelType::kI16);
  write_volume(volume, folder / "a.nhdr");
  expect_error(ErrorCode::kBadParameter, "a.nhdr", [&] { write_volume(volume, folder / "a.mhd"); });
}

TEST(RoundTrip, OneSliceAndOneVoxel) {
  const TemporaryFolder folder;
  for (const std::array<std::int64_t, 3> size :
       {std::array<std::int64_t, 3>{9, 8, 1}, {1, 1, 1}, {1, 6, 3}}) {
    const Volume volume = make_test_volume(VoxelType::kU16, size);
    for (const char* name : {"a.nrrd", "a.mha", "a.nii", "a.tif", "a.vtk", "a.h5"}) {
      write_volume(volume, folder / name);
      expect_same_voxels(volume, read_volume(folder / name));
    }
  }
}

TEST(WriteVolume, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  Volume volume = make_test_volume(VoxelType::kI16);
  expect_error(ErrorCode::kUnsupported, ".nii.gz", [&] { write_volume(volume, folder / "a.xyz"); });
  expect_error(ErrorCode::kUnsupported, ".nrrd", [&] { write_volume(volume, folder / "noextension"); });
  expect_error(ErrorCode::kInternal, "cannot write",
               [&] { write_volume(volume, folder / "no/such/a.nrrd"); });
  volume.direction = {0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1};
  expect_error(ErrorCode::kUnsupported, "orientation", [&] { write_volume(volume, folder / "a.vtk"); });
  expect_error(ErrorCode::kUnsupported, "orientation", [&] { write_volume(volume, folder / "a.tif"); });
  volume.voxels.reset();
  expect_error(ErrorCode::kBadParameter, "without voxels", [&] { write_volume(volume, folder / "a.nrrd"); });
}

}  // namespace
}  // namespace voxlume::test
