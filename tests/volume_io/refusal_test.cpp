#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

#include "nifti_builder.h"
#include "test_files.h"

namespace voxlume::test {
namespace {

std::string nrrd(const std::string& type, const std::string& sizes, int dimension,
                 const std::string& more = "") {
  return "NRRD0004\ntype: " + type + "\ndimension: " + std::to_string(dimension) + "\nsizes: " + sizes +
         "\nendian: little\nencoding: raw\n" + more + "\n";
}

class Refusal : public testing::Test {
 protected:
  Volume read(const std::string& name, const std::string& bytes) {
    write_bytes(folder_ / name, bytes);
    return read_volume(folder_ / name);
  }
  void refuse(const std::string& name, const std::string& bytes, const char* text) {
    SCOPED_TRACE(name);
    expect_error(ErrorCode::kUnsupported, text, [&] { read(name, bytes); });
  }
  TemporaryFolder folder_;
};

TEST_F(Refusal, FourDimensions) {
  const std::string bytes(4 * 3 * 2 * 5, 'x');
  refuse(
      "a.nrrd", nrrd("uchar", "4 3 2 5", 4) + bytes,
      "4-D image 4x3x2x5; expected 3-D; extract one time step first, with 3D Slicer or ImageJ for instance");
  refuse(
      "a.mha",
      "ObjectType = Image\nNDims = 4\nDimSize = 4 3 2 5\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
          bytes,
      "4-D image 4x3x2x5");
  NiftiBuilder nifti;
  nifti.dim = {4, 64, 64, 30, 120, 1, 1, 1};
  refuse("a.nii", nifti.header(),
         "4-D image 64x64x30x120; expected 3-D; extract one time step first, with 3D Slicer or ImageJ for "
         "instance");
}

TEST_F(Refusal, SaysTheReasonAlone) {
  const auto message = [&](const std::string& bytes) {
    try {
      read("a.nrrd", bytes);
    } catch (const Error& error) {
      return error.message();
    }
    return std::string();
  };
  EXPECT_EQ(message("no such thing\n"),
            "the header cannot be read: couldn't parse \"no such thing\" as magic or beginning of any "
            "recognized format");
  EXPECT_EQ(message(nrrd("uchar", "0 3 2", 3)), "the header cannot be read: axis 0 size is zero!");
}

TEST_F(Refusal, AFourthDimensionOfOneIsFine) {
  const std::string bytes(4 * 3 * 2, 'x');
  const std::array<std::int64_t, 3> size = {4, 3, 2};
  EXPECT_EQ(read("a.nrrd", nrrd("uchar", "4 3 2 1", 4) + bytes).size, size);
  EXPECT_EQ(read("a.mha",
                 "ObjectType = Image\nNDims = 4\nDimSize = 4 3 2 1\nElementType = MET_UCHAR\nElementDataFile "
                 "= LOCAL\n" +
                     bytes)
                .size,
            size);
  NiftiBuilder nifti;
  nifti.dim = {4, 4, 3, 2, 1, 1, 1, 1};
  nifti.datatype = 2;
  EXPECT_EQ(read("a.nii", nifti.header() + bytes).size, size);
}

TEST_F(Refusal, TwoDimensionsAreOneSlice) {
  const std::string bytes(12, 'x');
  const std::array<std::int64_t, 3> size = {4, 3, 1};
  EXPECT_EQ(read("a.nrrd", nrrd("uchar", "4 3", 2) + bytes).size, size);
  EXPECT_EQ(
      read(
          "a.mha",
          "ObjectType = Image\nNDims = 2\nDimSize = 4 3\nElementType = MET_UCHAR\nElementDataFile = LOCAL\n" +
              bytes)
          .size,
      size);
  NiftiBuilder nifti;
  nifti.dim = {2, 4, 3, 1, 1, 1, 1, 1};
  nifti.pixdim = {1, 1, 1, 0, 0, 0, 0, 0};
  nifti.datatype = 2;
  EXPECT_EQ(read("a.nii", nifti.header() + bytes).size, size);
}

TEST_F(Refusal, SeveralNumbersPerVoxel) {
  const std::string bytes(600, 'x');
  refuse("a.nrrd", nrrd("uchar", "3 4 3 2", 4, "kinds: RGB-color domain domain domain\n") + bytes,
         "3 numbers per voxel (rgb)");
  refuse("a.nrrd", nrrd("float", "3 4 3 2", 4, "kinds: vector domain domain domain\n") + bytes,
         "3 numbers per voxel");
  refuse("a.nrrd", nrrd("float", "2 4 3 2", 4, "kinds: complex domain domain domain\n") + bytes, "complex");
  refuse("a.mha",
         "ObjectType = Image\nNDims = 3\nDimSize = 4 3 2\nElementNumberOfChannels = 3\nElementType = "
         "MET_UCHAR\nElementDataFile = "
         "LOCAL\n" +
             bytes,
         "3 numbers per voxel");
  refuse("a.vtk",
         "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET STRUCTURED_POINTS\nDIMENSIONS 4 3 2\nSPACING 1 1 "
         "1\nORIGIN 0 0 0\nPOINT_DATA "
         "24\nSCALARS a unsigned_char 3\nLOOKUP_TABLE default\n" +
             bytes,
         "3 numbers per voxel");
  NiftiBuilder nifti;
  nifti.datatype = 128;
  refuse("a.nii", nifti.header() + bytes, "RGB colours (NIfTI datatype 128)");
  nifti.datatype = 32;
  refuse("a.nii", nifti.header() + bytes, "complex numbers");
}

TEST_F(Refusal, OtherKindsOfFile) {
  refuse("a.vtk", "# vtk DataFile Version 3.0\nt\nASCII\nDATASET RECTILINEAR_GRID\nDIMENSIONS 2 2 2\n",
         "STRUCTURED_POINTS");
  NiftiBuilder nifti;
  nifti.magic = std::string("ni1\0", 4);
  refuse("a.nii", nifti.header(), "separate .img file");
  refuse("a.jpg", "\xff\xd8\xff\xe0 and so on", "expected one of .nrrd");
  refuse("a.mhd",
         "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_UCHAR\nElementDataFile = "
         "LIST\na.raw\nb.raw\n",
         "several files");
}

TEST_F(Refusal, WideIntegersMustFit32Bits) {
  const std::vector<std::int64_t> small = {-5, 0, std::numeric_limits<std::int32_t>::max(),
                                           std::numeric_limits<std::int32_t>::min()};
  const auto expect_narrowed = [&](const Volume& volume) {
    EXPECT_EQ(volume.type, VoxelType::kI32);
    EXPECT_TRUE(warns(volume, "narrowed"));
    for (std::size_t i = 0; i < small.size(); ++i)
      EXPECT_EQ(value_at(volume, i), static_cast<double>(small[i]));
  };
  expect_narrowed(read("a.nrrd", nrrd("int64", "4 1 1", 3) + bytes_of(small)));
  expect_narrowed(read("a.mha",
                       "ObjectType = Image\nNDims = 3\nDimSize = 4 1 1\nElementType = "
                       "MET_LONG_LONG\nElementDataFile = LOCAL\n" +
                           bytes_of(small)));
  NiftiBuilder nifti;
  nifti.dim = {3, 4, 1, 1, 1, 1, 1, 1};
  nifti.datatype = 1024;
  expect_narrowed(read("a.nii", nifti.header() + bytes_of(small)));
  const std::vector<std::int64_t> large = {0, 1, 1ll << 40, 2};
  refuse("a.nrrd", nrrd("int64", "4 1 1", 3) + bytes_of(large), "voxel 2 is 1099511627776");
  refuse("a.nrrd", nrrd("uint64", "4 1 1", 3) + bytes_of(small), "beyond the 32-bit range");
}

TEST_F(Refusal, ScaledNiftiBecomesFloat) {
  NiftiBuilder nifti;
  nifti.dim = {3, 4, 1, 1, 1, 1, 1, 1};
  nifti.slope = 0.5f;
  nifti.intercept = -3;
  const Volume volume = read("a.nii", nifti.header() + bytes_of<std::int16_t>({-7, 0, 100, 32767}));
  EXPECT_EQ(volume.type, VoxelType::kF32);
  EXPECT_EQ(value_at(volume, 0), -6.5);
  EXPECT_EQ(value_at(volume, 1), -3);
  EXPECT_EQ(value_at(volume, 3), 16380.5);
  nifti.slope = 1;
  nifti.intercept = 0;
  EXPECT_EQ(read("a.nii", nifti.header() + bytes_of<std::int16_t>({1, 2, 3, 4})).type, VoxelType::kI16);
}

TEST_F(Refusal, BigEndianAndTextVoxelsAreRead) {
  const std::string vtk =
      "# vtk DataFile Version 3.0\nt\nASCII\nDATASET STRUCTURED_POINTS\nDIMENSIONS 2 2 1\nSPACING 1 2 "
      "3\nORIGIN 4 5 6\nPOINT_DATA "
      "4\nSCALARS a short 1\nLOOKUP_TABLE default\n-1 2\n3 40\n";
  EXPECT_EQ(value_at(read("a.vtk", vtk), 3), 40);
  const std::string mha =
      "ObjectType = Image\nNDims = 3\nDimSize = 2 1 1\nElementByteOrderMSB = True\nElementType = "
      "MET_SHORT\nElementDataFile = LOCAL\n";
  EXPECT_EQ(value_at(read("a.mha", mha + std::string("\x01\x02\x03\x04", 4)), 0), 0x0102);
  EXPECT_EQ(
      value_at(
          read("a.nrrd", "NRRD0004\ntype: short\ndimension: 3\nsizes: 2 1 1\nendian: big\nencoding: raw\n\n" +
                             std::string("\x01\x02\x03\x04", 4)),
          1),
      0x0304);
  expect_error(ErrorCode::kBadFormat, "expected 4 numbers",
               [&] { read("a.vtk", vtk.substr(0, vtk.size() - 4) + "       "); });
  expect_error(ErrorCode::kBadFormat, "\"4z0\"",
               [&] { read("a.vtk", vtk.substr(0, vtk.size() - 3) + "4z0\n"); });
}

TEST_F(Refusal, NameAndContentMustAgree) {
  write_volume(make_test_volume(VoxelType::kU8), folder_ / "a.mha");
  fs::rename(folder_ / "a.mha", folder_ / "a.nrrd");
  expect_error(ErrorCode::kBadFormat, "the name says NRRD, the content is MetaImage",
               [&] { read_volume(folder_ / "a.nrrd"); });
}

TEST_F(Refusal, PathsThatAreNoVolume) {
  expect_error(ErrorCode::kFileNotFound, "no such file", [&] { read_volume(folder_ / "none.nrrd"); });
  expect_error(ErrorCode::kFileNotFound, "no such file", [&] { read_volume(folder_ / "new\nline.nrrd"); });
  expect_error(ErrorCode::kBadFormat, "no DICOM or TIFF", [&] { read_volume(folder_.path()); });
  expect_error(ErrorCode::kBadFormat, "neither a file nor a folder", [] { read_volume("/dev/null"); });
  write_bytes(folder_ / "empty.nii", "");
  expect_error(ErrorCode::kBadFormat, "empty", [&] { read_volume(folder_ / "empty.nii"); });
}

TEST_F(Refusal, MissingDataFileIsNamed) {
  write_volume(make_test_volume(VoxelType::kU8), folder_ / "a.mhd");
  write_volume(make_test_volume(VoxelType::kU8), folder_ / "b.nhdr");
  fs::remove(folder_ / "a.raw");
  fs::remove(folder_ / "b.raw");
  expect_error(ErrorCode::kFileNotFound, "\"a.raw\" is not there", [&] { read_volume(folder_ / "a.mhd"); });
  expect_error(ErrorCode::kBadFormat, "b.nhdr", [&] { read_volume(folder_ / "b.nhdr"); });
}

}  // namespace
}  // namespace voxlume::test
