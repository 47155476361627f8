#include <gtest/gtest.h>

#include <random>

#include "dicom_builder.h"
#include "nifti_builder.h"
#include "test_files.h"

namespace voxlume::test {
namespace {

/// True when "0x" and eight or more hexadecimal digits stand in the text.
bool has_address(const std::string& text) {
  for (std::size_t at = text.find("0x"); at != std::string::npos; at = text.find("0x", at + 2)) {
    const std::size_t end = text.find_first_not_of("0123456789abcdef", at + 2);
    if ((end == std::string::npos ? text.size() : end) - (at + 2) >= 8) return true;
  }
  return false;
}

/// Reads damaged files and counts: each must give an Error of one line. Where damage may go unnoticed (a
/// flipped bit in a voxel), reading without an error is allowed, but then the volume must be whole.
class Damage : public testing::Test {
 protected:
  void must_fail(const std::string& name, const std::string& bytes, const std::string& what) {
    ++tried_;
    SCOPED_TRACE(name + ": " + what);
    write_bytes(folder_ / name, bytes);
    expect_one_line_error(folder_ / name);
  }

  void may_fail(const std::string& name, const std::string& bytes, const std::string& what) {
    ++tried_;
    SCOPED_TRACE(name + ": " + what);
    write_bytes(folder_ / name, bytes);
    ReadOptions options;
    options.memory_limit_bytes = 1 << 24;
    try {
      const Volume volume = read_volume(folder_ / name, options);
      ASSERT_TRUE(volume.voxels);
      double sum = 0;
      for (std::size_t i = 0; i < volume.voxel_count(); ++i) sum += value_at(volume, i) != 0;
      EXPECT_GE(sum, 0);
    } catch (const Error& error) {
      check_line(error);
    }
  }

  void expect_one_line_error(const fs::path& path) {
    try {
      read_volume(path);
      ADD_FAILURE() << "expected an error";
    } catch (const Error& error) {
      check_line(error);
    }
  }

  static void check_line(const Error& error) {
    const std::string what = error.what();
    EXPECT_GT(error.message().size(), 10u);
    for (const char c : what) ASSERT_GE(static_cast<unsigned char>(c), ' ') << what;
    EXPECT_FALSE(has_address(what)) << what;
    EXPECT_EQ(what.find(".cxx"), std::string::npos) << what;
    EXPECT_NE(error.code(), ErrorCode::kInternal) << what;
  }

  /// The bytes of a good file; the one it was written to is removed.
  std::string good(const std::string& name) {
    Volume volume = make_test_volume(VoxelType::kI16, {9, 8, 7});
    write_volume(volume, folder_ / name);
    std::string bytes = read_bytes(folder_ / name);
    return bytes;
  }

  /// Cuts at many lengths, none of them in the last `slack` bytes, which a format may not need.
  void cut_short(const std::string& name, const std::string& bytes, std::size_t slack = 0) {
    const std::size_t whole = bytes.size() - slack;
    for (const double share : {0.0, 0.002, 0.01, 0.05, 0.1, 0.2, 0.35, 0.5, 0.65, 0.8, 0.9, 0.97, 0.999}) {
      const auto length = static_cast<std::size_t>(static_cast<double>(whole) * share);
      must_fail(name, bytes.substr(0, length), "cut to " + std::to_string(length));
    }
    must_fail(name, bytes.substr(0, whole - 1), "cut by one byte");
  }

  void flip_bytes(const std::string& name, const std::string& bytes, std::size_t within, int count) {
    std::mt19937 random(20240607);
    for (int i = 0; i < count; ++i) {
      std::string damaged = bytes;
      for (int flips = 0; flips < 1 + i % 4; ++flips) {
        damaged[random() % std::min(within, damaged.size())] = static_cast<char>(random());
      }
      may_fail(name, damaged, "flip " + std::to_string(i));
    }
  }

  void replace_and_fail(const std::string& name, const std::string& bytes, const std::string& from,
                        const std::string& to) {
    std::string damaged = bytes;
    const std::size_t at = damaged.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    damaged.replace(at, from.size(), to);
    must_fail(name, damaged, from + " -> " + to);
  }

  TemporaryFolder folder_;
  int tried_ = 0;
};

TEST_F(Damage, Nrrd) {
  const std::string bytes = good("a.nrrd");
  cut_short("a.nrrd", bytes);
  flip_bytes("a.nrrd", bytes, bytes.size(), 40);
  for (const char* sizes :
       {"9 8 n", "9 8", "9 8 0", "9 8 -7", "9 8 700", "99999999 99999999 99999999", "1e9 2 3", ""}) {
    replace_and_fail("a.nrrd", bytes, "sizes: 9 8 7", std::string("sizes: ") + sizes);
  }
  replace_and_fail("a.nrrd", bytes, "type: short", "type: shirt");
  replace_and_fail("a.nrrd", bytes, "dimension: 3", "dimension: 300");
  replace_and_fail("a.nrrd", bytes, "encoding: gzip", "encoding: zip");
  replace_and_fail("a.nrrd", bytes, "(1,0,0)", "(nan,0,0)");
  replace_and_fail("a.nrrd", bytes, "(1,0,0)", "(1,0");
  EXPECT_GE(tried_, 60);
}

TEST_F(Damage, DetachedNrrd) {
  const std::string header = good("a.nhdr");
  const std::string data = read_bytes(folder_ / "a.raw");
  for (const std::size_t length : {data.size() - 1, data.size() / 2, std::size_t{0}}) {
    write_bytes(folder_ / "a.raw", data.substr(0, length));
    must_fail("a.nhdr", header, "data of " + std::to_string(length));
  }
  write_bytes(folder_ / "a.raw", data);
  replace_and_fail("a.nhdr", header, "a.raw", "none.raw");
  replace_and_fail("a.nhdr", header, "a.raw", ".");
  cut_short("a.nhdr", header, 8);
  flip_bytes("a.nhdr", header, header.size(), 20);
  EXPECT_GE(tried_, 35);
}

TEST_F(Damage, MetaImage) {
  const std::string bytes = good("a.mha");
  cut_short("a.mha", bytes);
  flip_bytes("a.mha", bytes, 400, 40);
  for (const char* sizes : {"9 8 n", "9 8", "9 8 0", "9 8 -7", "9 8 700", "99999999 99999999 99999999"}) {
    replace_and_fail("a.mha", bytes, "DimSize = 9 8 7", std::string("DimSize = ") + sizes);
  }
  replace_and_fail("a.mha", bytes, "MET_SHORT", "MET_SHIRT");
  replace_and_fail("a.mha", bytes, "NDims = 3", "NDims = 99");
  replace_and_fail("a.mha", bytes, "ElementSpacing = 1 1 1", "ElementSpacing = 1 0 1");
  replace_and_fail("a.mha", bytes, "ElementSpacing = 1 1 1", "ElementSpacing = 1 -1 1");
  replace_and_fail("a.mha", bytes, "TransformMatrix = 1 0 0 0 1 0 0 0 1",
                   "TransformMatrix = 0 0 0 0 1 0 0 0 1");
  replace_and_fail("a.mha", bytes, "CompressedData = False", "CompressedData = True");
  EXPECT_GE(tried_, 60);
}

TEST_F(Damage, DetachedMetaImage) {
  const std::string header = good("a.mhd");
  const std::string data = read_bytes(folder_ / "a.raw");
  for (const std::size_t length : {data.size() - 1, data.size() / 2, std::size_t{0}}) {
    write_bytes(folder_ / "a.raw", data.substr(0, length));
    must_fail("a.mhd", header, "data of " + std::to_string(length));
  }
  write_bytes(folder_ / "a.raw", data);
  replace_and_fail("a.mhd", header, "a.raw", "none.raw");
  replace_and_fail("a.mhd", header, "a.raw", ".");
  EXPECT_GE(tried_, 5);
}

TEST_F(Damage, Nifti) {
  const std::string bytes = good("a.nii");
  cut_short("a.nii", bytes);
  flip_bytes("a.nii", bytes, 352, 60);
  const auto with = [&](std::size_t at, const std::string& value, const char* what) {
    std::string damaged = bytes;
    damaged.replace(at, value.size(), value);
    must_fail("a.nii", damaged, what);
  };
  with(40, bytes_of<std::int16_t>({0}), "no dimensions");
  with(40, bytes_of<std::int16_t>({9}), "nine dimensions");
  with(42, bytes_of<std::int16_t>({-9}), "negative size");
  with(42, bytes_of<std::int16_t>({0}), "zero size");
  with(42, bytes_of<std::int16_t>({32767, 32767, 32767}), "absurd sizes");
  with(70, bytes_of<std::int16_t>({7}), "unknown type");
  with(108, bytes_of<float>({-1}), "negative offset");
  with(108, bytes_of<float>({NAN}), "offset not a number");
  with(108, bytes_of<float>({1e6f}), "offset beyond the end");
  with(344, "n+9", "other magic");
  with(256, bytes_of(std::vector<float>(18, NAN)), "qform and sform not numbers");
  EXPECT_GE(tried_, 80);
}

TEST_F(Damage, NiftiGzip) {
  const std::string bytes = good("a.nii.gz");
  cut_short("a.nii.gz", bytes);
  flip_bytes("a.nii.gz", bytes, bytes.size(), 40);
  must_fail("a.nii.gz", bytes.substr(0, bytes.size() - 8) + std::string(8, 'x'), "other checksum");
  NiftiBuilder bomb;
  bomb.dim = {3, 32767, 32767, 32767, 1, 1, 1, 1};
  must_fail("a.nii.gz", bomb.header(), "absurd sizes, not even compressed");
  EXPECT_GE(tried_, 55);
}

TEST_F(Damage, Vtk) {
  const std::string bytes = good("a.vtk");
  cut_short("a.vtk", bytes, 1);
  flip_bytes("a.vtk", bytes, 250, 40);
  for (const char* sizes : {"9 8 n", "9 8", "9 8 0", "9 8 -7", "9 8 700", "99999999 99999999 99999999"}) {
    replace_and_fail("a.vtk", bytes, "DIMENSIONS 9 8 7", std::string("DIMENSIONS ") + sizes);
  }
  replace_and_fail("a.vtk", bytes, "short", "shirt");
  replace_and_fail("a.vtk", bytes, "SPACING 1", "SPACING 0");
  EXPECT_GE(tried_, 60);
}

TEST_F(Damage, Hdf5) {
  const std::string bytes = good("a.h5");
  cut_short("a.h5", bytes);
  flip_bytes("a.h5", bytes, bytes.size(), 60);
  EXPECT_GE(tried_, 70);
}

TEST_F(Damage, Tiff) {
  const std::string bytes = good("a.tif");
  cut_short("a.tif", bytes, 24);  // the last page's resolution, and the offset of a next page
  flip_bytes("a.tif", bytes, bytes.size(), 60);
  EXPECT_GE(tried_, 70);
}

TEST_F(Damage, Dicom) {
  const std::string bytes = DicomBuilder().slice(1, {0, 0, 0}, 1024);
  cut_short("a.dcm", bytes);
  flip_bytes("a.dcm", bytes, bytes.size(), 60);
  EXPECT_GE(tried_, 70);
}

TEST_F(Damage, OpenVdb) {
  try {
    write_volume(make_test_volume(VoxelType::kF32), folder_ / "a.vdb");
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  const std::string bytes = good("a.vdb");
  cut_short("a.vdb", bytes);
  flip_bytes("a.vdb", bytes, bytes.size(), 40);
  EXPECT_GE(tried_, 50);
}

TEST_F(Damage, FoldersAndNames) {
  for (const char* name : {"d.nrrd", "d.nii.gz", "d.mha", "d.h5", "d.vtk", "d.vdb", "d.tif", "d"}) {
    ++tried_;
    SCOPED_TRACE(name);
    fs::create_directory(folder_ / name);
    expect_one_line_error(folder_ / name);
  }
  for (const char* name : {"e.nrrd", "e.nhdr", "e.mha", "e.mhd", "e.nii", "e.nii.gz", "e.tif", "e.vtk",
                           "e.h5", "e.vdb", "e.dcm", "e"}) {
    must_fail(name, "", "empty");
    must_fail(name, "x", "one byte");
    must_fail(name, std::string(5000, '\0'), "zeros");
    must_fail(name, std::string(5000, '\xff'), "ones");
  }
  EXPECT_GE(tried_, 56);
}

}  // namespace
}  // namespace voxlume::test
