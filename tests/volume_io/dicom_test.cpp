#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "dicom_builder.h"
#include "test_files.h"

namespace voxlume::test {
namespace {

using Vec = std::array<double, 3>;

/// The value of the first pixel of each slice.
std::vector<double> slice_values(const Volume& volume) {
  std::vector<double> values;
  const auto pixels = static_cast<std::size_t>(volume.size[0] * volume.size[1]);
  for (std::int64_t k = 0; k < volume.size[2]; ++k)
    values.push_back(value_at(volume, static_cast<std::size_t>(k) * pixels));
  return values;
}

TEST(Dicom, WrittenSeriesReadsBack) {
  const TemporaryFolder folder;
  for (const VoxelType type : {VoxelType::kU8, VoxelType::kU16, VoxelType::kI16}) {
    Volume volume = make_test_volume(type);
    volume.spacing_mm = {0.957, 1.25, 2.5};
    volume.origin_mm = {-123.456, 78.9, -1031.25};
    volume.direction = rotation({0.6, 0.0, 0.8}, 0.7);
    volume.modality = "CT";
    const std::string name(voxel_type_name(type));
    write_volume(volume, (folder / name).string() + "/");
    const Volume back = read_volume(folder / name);
    expect_same_voxels(volume, back);
    expect_same_geometry(volume, back);
    EXPECT_EQ(back.modality, "CT");
    EXPECT_EQ(back.format, "DICOM series");
    EXPECT_TRUE(back.warnings.empty());
  }
}

TEST(Dicom, WriterRefusesWhatDicomLacks) {
  const TemporaryFolder folder;
  expect_error(ErrorCode::kUnsupported, "f32",
               [&] { write_volume(make_test_volume(VoxelType::kF32), (folder / "a").string() + "/"); });
  write_bytes(folder / "other.txt", "x");
  expect_error(ErrorCode::kBadParameter, "not empty",
               [&] { write_volume(make_test_volume(VoxelType::kI16), folder.path()); });
}

TEST(Dicom, LeftHandedVolumeKeepsItsPlaces) {
  const TemporaryFolder folder;
  Volume volume = make_test_volume(VoxelType::kI16);
  volume.direction = {1, 0, 0, 0, -1, 0, 0, 0, 1};
  write_volume(volume, (folder / "a").string() + "/");
  const Volume back = read_volume(folder / "a");
  for (const Vec p : {Vec{1, -2, 0}, Vec{3, -4, 3}, Vec{6, 0, 2}}) {
    EXPECT_EQ(interpolate(volume, p_index_of(volume, p)), interpolate(back, p_index_of(back, p)));
  }
}

TEST(Dicom, OrderedByPositionNotByNameOrNumber) {
  const TemporaryFolder folder;
  const DicomBuilder dicom;
  const double depths[] = {9, 0, 3, 12, 6};  // in the order of the names
  for (int i = 0; i < 5; ++i) {
    write_bytes(folder / fmt::format("im{}", i),
                dicom.slice(100 - i, {-10, -20, depths[i] - 50}, 1024 + static_cast<int>(depths[i])));
  }
  const Volume volume = read_volume(folder.path());
  EXPECT_EQ(slice_values(volume), (std::vector<double>{0, 3, 6, 9, 12}));
  EXPECT_EQ(volume.origin_mm, (Vec{-10, -20, -50}));
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(volume.spacing_mm[a], (Vec{0.5, 0.7, 3})[a], 1e-9);
  EXPECT_EQ(volume.size, (std::array<std::int64_t, 3>{6, 4, 5}));
  EXPECT_EQ(volume.type, VoxelType::kI16);
  EXPECT_EQ(volume.modality, "CT");
  EXPECT_TRUE(volume.warnings.empty());
}

TEST(Dicom, RescaleIsAppliedAndChoosesTheType) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  const auto read_with = [&](const char* slope, const char* intercept, int value) {
    dicom.slope = slope;
    dicom.intercept = intercept;
    for (int i = 0; i < 3; ++i)
      write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, 3.0 * i}, value));
    return read_volume(folder.path());
  };
  const Volume halves = read_with("0.5", "-10", 101);
  EXPECT_EQ(halves.type, VoxelType::kF32);
  EXPECT_EQ(value_at(halves, 0), 40.5);
  const Volume as_stored = read_with("1", "0", 4095);
  EXPECT_EQ(as_stored.type, VoxelType::kU16);
  EXPECT_EQ(value_at(as_stored, 0), 4095);
  const Volume wide = read_with("100", "-1024", 4095);
  EXPECT_EQ(wide.type, VoxelType::kI32);
  EXPECT_EQ(value_at(wide, 0), 408476);
}

TEST(Dicom, MissingSlicesAreFilledWithAWarning) {
  const TemporaryFolder folder;
  const DicomBuilder dicom;
  for (const int i : {0, 1, 2, 5, 6, 7}) {
    write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, 2.0 * i}, 1024 + 10 * i));
  }
  const Volume volume = read_volume(folder.path());
  EXPECT_TRUE(warns(volume, "missing slices: 2 in 1 gap(s), the first of 6 mm after slice 3"));
  EXPECT_EQ(slice_values(volume), (std::vector<double>{0, 10, 20, 30, 40, 50, 60, 70}));
  EXPECT_NEAR(volume.spacing_mm[2], 2, 1e-9);
}

TEST(Dicom, UnevenSpacingWarns) {
  const TemporaryFolder folder;
  const DicomBuilder dicom;
  const double depths[] = {0, 2, 4, 6, 9.1, 11.1};
  for (int i = 0; i < 6; ++i)
    write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, depths[i]}, 1024 + i));
  const Volume volume = read_volume(folder.path());
  EXPECT_TRUE(warns(volume, "uneven slice spacing: steps of 2 to 3.1 mm"));
  EXPECT_NEAR(volume.spacing_mm[2], 11.1 / 5, 1e-9);
}

TEST(Dicom, RepeatedPositionsWarn) {
  const TemporaryFolder folder;
  const DicomBuilder dicom;
  for (int i = 0; i < 8; ++i) {
    write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, 2.0 * (i % 4)}, 1024 + i));
  }
  const Volume volume = read_volume(folder.path());
  EXPECT_TRUE(warns(volume, "repeated positions: 4 of 8"));
  EXPECT_EQ(slice_values(volume), (std::vector<double>{0, 1, 2, 3}));
}

TEST(Dicom, GantryTiltWarns) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  const double angle = 15 * 3.14159265358979 / 180;
  dicom.orientation = {1, 0, 0, 0, std::cos(angle), -std::sin(angle)};
  for (int i = 0; i < 5; ++i)
    write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, 4.0 * i}, 1024 + i));
  const Volume volume = read_volume(folder.path());
  EXPECT_TRUE(warns(volume, "gantry tilt: the slices are sheared by 15.0 degrees"));
  EXPECT_NEAR(volume.spacing_mm[2], 4 * std::cos(angle), 1e-4);
}

TEST(Dicom, TiltTagWithoutShearWarns) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  dicom.tilt = "-12.5";
  for (int i = 0; i < 3; ++i)
    write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, 4.0 * i}, 1024 + i));
  EXPECT_TRUE(warns(read_volume(folder.path()), "gantry tilt of -12.5 degrees"));
}

TEST(Dicom, LargestOfTwoSeriesIsReadAndTheOtherNamed) {
  const TemporaryFolder folder;
  DicomBuilder small;
  small.series = "1.2.3.5";
  small.series_number = 7;
  small.modality = "MR";
  const DicomBuilder large;
  for (int i = 0; i < 6; ++i)
    write_bytes(folder / fmt::format("b{}", i), large.slice(i, {0, 0, 4.0 * i}, 1024 + i));
  for (int i = 0; i < 3; ++i)
    write_bytes(folder / fmt::format("a{}", i), small.slice(i, {0, 0, 4.0 * i}, 2000));
  write_bytes(folder / "notes.txt", "not an image");
  const Volume volume = read_volume(folder.path());
  EXPECT_EQ(volume.size[2], 6);
  EXPECT_EQ(volume.modality, "CT");
  EXPECT_TRUE(warns(volume, "2 series here; series 2 (CT, 6 slices of 6x4) is read"));
  EXPECT_TRUE(warns(volume, "left out: series 7 (MR, 3 slices of 6x4)"));
}

TEST(Dicom, ObliqueSeriesIsPlacedByItsTags) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  const auto r = rotation({0, 0.6, 0.8}, 0.9);
  dicom.orientation = {r[0], r[3], r[6], r[1], r[4], r[7]};
  for (int i = 0; i < 4; ++i) {
    const double t = 2.5 * (3 - i);
    write_bytes(folder / fmt::format("{}.dcm", i),
                dicom.slice(i, {5 + r[2] * t, 6 + r[5] * t, 7 + r[8] * t}, 1024 + i));
  }
  const Volume volume = read_volume(folder.path());
  EXPECT_EQ(slice_values(volume), (std::vector<double>{3, 2, 1, 0}));
  for (int i = 0; i < 9; ++i) EXPECT_NEAR(volume.direction[i], r[i], 1e-6);
  EXPECT_NEAR(volume.spacing_mm[2], 2.5, 1e-4);
  EXPECT_NEAR(volume.origin_mm[0], 5, 1e-4);
  EXPECT_TRUE(volume.warnings.empty());
}

TEST(Dicom, NothingOfThePatientLeavesTheReader) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  dicom.tilt = "3";
  dicom.modality = "SecretModality";
  for (const int i : {0, 1, 3, 4})
    write_bytes(folder / fmt::format("{}.dcm", i), dicom.slice(i, {0, 0, 2.0 * i}, 1024));
  dicom.series = "1.2.9";
  write_bytes(folder / "x.dcm", dicom.slice(9, {0, 0, 0}, 1024));
  const Volume volume = read_volume(folder.path());
  EXPECT_EQ(volume.modality, "");
  std::string said = volume.modality + volume.format;
  for (const std::string& warning : volume.warnings) said += warning;
  for (const char* secret : {"Secret", "1999", "1.2.3", "1.2.9"})
    EXPECT_EQ(said.find(secret), std::string::npos) << said;
  write_volume(volume, folder / "out.nrrd");
  write_volume(volume, (folder / "out").string() + "/");
  std::string written = read_bytes(folder / "out.nrrd");
  for (const auto& entry : fs::directory_iterator(folder / "out")) written += read_bytes(entry.path());
  EXPECT_EQ(written.find("Secret"), std::string::npos);
}

TEST(Dicom, EnhancedMultiFrameIsOrderedByFramePositions) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  dicom.frames = 3;
  dicom.with_position = false;
  const double depths[] = {4, 0, 2};
  std::string items;
  for (const double depth : depths) {
    const std::string position =
        DicomBuilder::element(0x0020, 0x0032, "DS", DicomBuilder::position_text({1, 2, depth}));
    items += DicomBuilder::item(DicomBuilder::element(0x0020, 0x9113, "SQ", DicomBuilder::item(position)));
  }
  const std::string plane = DicomBuilder::element(0x0020, 0x0037, "DS", "1\\0\\0\\0\\1\\0");
  dicom.groups =
      DicomBuilder::element(
          0x5200, 0x9229, "SQ",
          DicomBuilder::item(DicomBuilder::element(0x0020, 0x9116, "SQ", DicomBuilder::item(plane)))) +
      DicomBuilder::element(0x5200, 0x9230, "SQ", items);
  std::vector<std::uint16_t> pixels;
  for (const double depth : depths) pixels.insert(pixels.end(), 24, static_cast<std::uint16_t>(1024 + depth));
  write_bytes(folder / "a.dcm", dicom.file(1, {}, bytes_of(pixels)));
  const Volume volume = read_volume(folder / "a.dcm");
  EXPECT_EQ(slice_values(volume), (std::vector<double>{0, 2, 4}));
  EXPECT_EQ(volume.origin_mm, (Vec{1, 2, 0}));
  EXPECT_NEAR(volume.spacing_mm[2], 2, 1e-9);
}

TEST(Dicom, MultiFrameWithoutPositionsIsRefused) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  dicom.frames = 3;
  write_bytes(folder / "a.dcm", dicom.file(1, {}, std::string(144, '\1')));
  expect_error(ErrorCode::kUnsupported, "multi-frame DICOM of 3 frames",
               [&] { read_volume(folder / "a.dcm"); });
}

TEST(Dicom, ColourIsRefused) {
  const TemporaryFolder folder;
  DicomBuilder dicom;
  dicom.samples = 3;
  dicom.bits = dicom.bits_stored = 8;
  write_bytes(folder / "a.dcm", dicom.file(1, {0, 0, 0}, std::string(72, '\1')));
  expect_error(ErrorCode::kUnsupported, "colour", [&] { read_volume(folder / "a.dcm"); });
}

TEST(Dicom, OneSliceOfASeriesSaysSo) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.dcm", DicomBuilder().slice(1, {0, 0, 0}, 1500));
  const Volume volume = read_volume(folder / "a.dcm");
  EXPECT_EQ(volume.size[2], 1);
  EXPECT_EQ(value_at(volume, 0), 476);
  EXPECT_TRUE(warns(volume, "single slice"));
}

TEST(Dicom, CutShortPixelsAreRefused) {
  const TemporaryFolder folder;
  const DicomBuilder dicom;
  for (int i = 0; i < 4; ++i) {
    const std::string bytes = dicom.slice(i, {0, 0, 2.0 * i}, 1024);
    write_bytes(folder / fmt::format("{}.dcm", i), i == 2 ? bytes.substr(0, bytes.size() - 10) : bytes);
  }
  expect_error(ErrorCode::kBadFormat, "2.dcm", [&] { read_volume(folder.path()); });
}

}  // namespace
}  // namespace voxlume::test
