#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <sstream>

#include "nifti_builder.h"
#include "test_files.h"
#include "volume_io/child_limits.h"
#include "volume_io/isolated_read.h"

namespace voxlume::test {
namespace {

/// The file that the first voxel is mapped from, as /proc/self/maps has it; empty for memory without one.
std::string mapped_file(const Volume& volume) {
  const auto voxels = reinterpret_cast<std::uintptr_t>(volume.voxels.get());
  std::ifstream maps("/proc/self/maps");
  std::string line;
  while (std::getline(maps, line)) {
    std::istringstream fields(line);
    std::uintptr_t first = 0, last = 0;
    char dash = 0;
    fields >> std::hex >> first >> dash >> last;
    const std::size_t name = line.find('/');
    if (voxels >= first && voxels < last) return name == std::string::npos ? "" : line.substr(name);
  }
  return "";
}

constexpr const char* kNrrdTypes[] = {"uint8",  "int8",  "uint16", "int16",
                                      "uint32", "int32", "float",  "double"};
constexpr const char* kMetaTypes[] = {"MET_UCHAR", "MET_CHAR", "MET_USHORT", "MET_SHORT",
                                      "MET_UINT",  "MET_INT",  "MET_FLOAT",  "MET_DOUBLE"};
constexpr std::int16_t kNiftiTypes[] = {2, 256, 512, 4, 768, 8, 16, 64};

std::string nrrd_header(const Volume& volume, const std::string& more = "", const char* endian = "little") {
  std::ostringstream text;
  text << "NRRD0004\ntype: " << kNrrdTypes[static_cast<int>(volume.type)]
       << "\ndimension: 3\nsizes: " << volume.size[0] << " " << volume.size[1] << " " << volume.size[2]
       << "\nendian: " << endian << "\nencoding: raw\n"
       << more;
  return text.str();
}

/// Ends an attached header so that the voxels start `beyond` bytes after a multiple of 8.
std::string ended(std::string header, std::size_t beyond = 0) {
  header += "#";
  while ((header.size() + 2) % 8 != beyond) header += "-";
  return header + "\n\n";
}

std::string meta_header(const Volume& volume, const std::string& data, const char* more = "") {
  std::ostringstream text;
  text << "ObjectType = Image\nNDims = 3\nDimSize = " << volume.size[0] << " " << volume.size[1] << " "
       << volume.size[2] << "\n"
       << more << "ElementType = " << kMetaTypes[static_cast<int>(volume.type)]
       << "\nElementDataFile = " << data << "\n";
  return text.str();
}

std::string voxel_bytes_of(const Volume& volume) {
  return {static_cast<const char*>(volume.voxels.get()), volume.byte_count()};
}

std::string swapped(std::string bytes, std::size_t width) {
  for (std::size_t i = 0; i + width <= bytes.size(); i += width)
    std::reverse(bytes.begin() + static_cast<std::ptrdiff_t>(i),
                 bytes.begin() + static_cast<std::ptrdiff_t>(i + width));
  return bytes;
}

class Mapped : public testing::TestWithParam<VoxelType> {
 protected:
  void SetUp() override { write_bytes(folder_ / "v.raw", "sixteen bytes on" + data_); }

  void expect(bool is_mapped, const std::string& name, const std::string& bytes) {
    SCOPED_TRACE(name + "\n" + bytes.substr(0, bytes.size() - std::min(bytes.size(), data_.size())));
    write_bytes(folder_ / name, bytes);
    const Volume volume = read_volume(folder_ / name);
    expect_same_voxels(original_, volume);
    EXPECT_EQ(mapped_file(volume).starts_with(folder_.path().string()), is_mapped) << mapped_file(volume);
    EXPECT_EQ(reinterpret_cast<std::uintptr_t>(volume.voxels.get()) % voxel_bytes(volume.type), 0u);
    expect_same_voxels(original_, read_in_process(folder_ / name, {}));
  }

  const TemporaryFolder folder_;
  const Volume original_ = make_test_volume(GetParam());
  const std::string data_ = voxel_bytes_of(original_);
  const std::string swapped_ = swapped(data_, voxel_bytes(GetParam()));
  const bool has_byte_order_ = voxel_bytes(GetParam()) > 1;
};

TEST_P(Mapped, NrrdWhereItsVoxelsAreAligned) {
  const std::string header = nrrd_header(original_);
  expect(true, "a.nrrd", ended(header) + data_);
  for (const std::size_t beyond : {1u, 2u, 3u, 4u, 5u, 6u, 7u})
    expect(beyond % voxel_bytes(GetParam()) == 0, "a.nrrd", ended(header, beyond) + data_);
  expect(true, "a.nrrd", ended(header) + data_ + "something behind");
  const std::string big = nrrd_header(original_, "", "big");
  expect(!has_byte_order_, "a.nrrd", ended(big) + swapped_);
  expect(!has_byte_order_, "a.nrrd", ended(big, 1) + swapped_);
}

TEST_P(Mapped, DetachedNrrd) {
  const std::string header = nrrd_header(original_, "data file: v.raw\n");
  expect(true, "a.nhdr", header + "byte skip: 16\n");
  expect(true, "a.nhdr", header + "byte skip: 16\nline skip: 0\n\n");
  expect(true, "a.nhdr", header + "byte skip: -1\n");
  expect(true, "a.nhdr",
         nrrd_header(original_, "byte skip: 16\ndata file: " + (folder_ / "v.raw").string() + "\n"));
  write_bytes(folder_ / "v.raw", "a line\nand one\n" + data_);
  expect(false, "a.nhdr", header + "line skip: 2\n");
  expect(!has_byte_order_, "a.nhdr", header + "byte skip: 15\n");
  write_bytes(folder_ / "v.raw", swapped_);
  expect(!has_byte_order_, "a.nhdr", nrrd_header(original_, "datafile: v.raw\n", "big"));
}

TEST_P(Mapped, MetaImage) {
  std::string header = meta_header(original_, "LOCAL");
  header.insert(0, "Comment = " + std::string(7 - (header.size() + 10) % 8, '-') + "\n");
  ASSERT_EQ(header.size() % 8, 0u);
  expect(true, "a.mha", header + data_);
  header.insert(10, "-");
  expect(!has_byte_order_, "a.mha", header + data_);
  expect(true, "a.mhd", meta_header(original_, "v.raw", "HeaderSize = 16\n"));
  expect(true, "a.mhd", meta_header(original_, "v.raw", "HeaderSize = -1\n"));
  write_bytes(folder_ / "v.raw", swapped_);
  expect(!has_byte_order_, "a.mhd", meta_header(original_, "v.raw", "BinaryDataByteOrderMSB = True\n"));
}

TEST_P(Mapped, Nifti) {
  NiftiBuilder nifti;
  nifti.dim = {3, 7, 5, 4, 1, 1, 1, 1};
  nifti.datatype = kNiftiTypes[static_cast<int>(GetParam())];
  const std::string header = nifti.header();
  ASSERT_EQ(header.size(), 352u);
  expect(true, "a.nii", header + data_);
}

INSTANTIATE_TEST_SUITE_P(Types, Mapped,
                         testing::Values(VoxelType::kU8, VoxelType::kI8, VoxelType::kU16, VoxelType::kI16,
                                         VoxelType::kU32, VoxelType::kI32, VoxelType::kF32, VoxelType::kF64),
                         [](const auto& test) { return std::string(voxel_type_name(test.param)); });

TEST(MappedFile, WhatIsTooShortIsRefused) {
  const TemporaryFolder folder;
  const Volume volume = make_test_volume(VoxelType::kI16);
  const std::string data = voxel_bytes_of(volume);
  const std::string nrrd = ended(nrrd_header(volume));
  for (const std::size_t missing : {std::size_t{1}, data.size() / 2, data.size()}) {
    const std::string cut = data.substr(missing);
    const std::string message = "expected 280 bytes of voxels, file has " + std::to_string(cut.size());
    const auto refuse = [&](const char* name, const std::string& bytes) {
      SCOPED_TRACE(name);
      write_bytes(folder / name, bytes);
      expect_error(ErrorCode::kBadFormat, message, [&] { read_volume(folder / name); });
    };
    refuse("a.nrrd", nrrd + cut);
    refuse("a.mha", meta_header(volume, "LOCAL") + cut);
    write_bytes(folder / "v.raw", cut);
    refuse("a.nhdr", nrrd_header(volume, "data file: v.raw\n"));
    refuse("a.mhd", meta_header(volume, "v.raw"));
    write_bytes(folder / "v.raw", "16 bytes of head" + cut);
    refuse("a.nhdr", nrrd_header(volume, "data file: v.raw\nbyte skip: 16\n"));
  }
  write_bytes(folder / "a.nhdr", nrrd_header(volume, "data file: v.raw\nbyte skip: 18446744073709551615\n"));
  EXPECT_THROW(read_volume(folder / "a.nhdr"), Error);
  write_bytes(folder / "a.nhdr", nrrd_header(volume, "data file: v.raw\nbyte skip: -1\n"));
  write_bytes(folder / "v.raw", data.substr(1));
  EXPECT_THROW(read_volume(folder / "a.nhdr"), Error);
}

TEST(MappedFile, MayBeRemovedOrWrittenAnew) {
  const TemporaryFolder folder;
  const Volume original = make_test_volume(VoxelType::kI16);
  write_volume(original, folder / "a.nhdr");
  const Volume volume = read_volume(folder / "a.nhdr");
  EXPECT_TRUE(mapped_file(volume).ends_with("/a.raw")) << mapped_file(volume);
  write_volume(make_test_volume(VoxelType::kF32), folder / "a.nhdr");
  expect_same_voxels(original, volume);
  write_volume(volume, folder / "a.nhdr");
  expect_same_voxels(original, read_volume(folder / "a.nhdr"));
  fs::remove(folder / "a.raw");
  expect_same_voxels(original, volume);
}

TEST(MappedFile, NameNeedNotBeText) {
  const TemporaryFolder folder;
  const Volume volume = make_test_volume(VoxelType::kI16);
  const fs::path path = folder / "\xff\xfe \"\n.nrrd";
  write_bytes(path, ended(nrrd_header(volume)) + voxel_bytes_of(volume));
  const Volume back = read_volume(path);
  expect_same_voxels(volume, back);
}

TEST(MappedFile, OnlyTheLimitGivenCounts) {
  const TemporaryFolder folder;
  Volume volume;  // half a TiB
  volume.type = VoxelType::kU16;
  volume.size = {65536, 65536, 64};
  const std::string header = ended(nrrd_header(volume));
  write_bytes(folder / "a.nrrd", header + "\x11\x22");
  fs::resize_file(folder / "a.nrrd", header.size() + volume.byte_count());
  EXPECT_EQ(value_at(read_volume(folder / "a.nrrd"), 0), 0x2211);
  ReadOptions options;
  options.memory_limit_bytes = volume.byte_count() - 1;
  expect_error(ErrorCode::kOutOfMemory, "is the limit given",
               [&] { read_volume(folder / "a.nrrd", options); });
}

TEST(MappedFile, AnAxisMayBeTooLong) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.nrrd", "");
  Volume volume;
  volume.size = {(1 << 24) + 1, 1, 1};
  const std::string header = nrrd_header(volume) + "\n";
  write_bytes(folder / "a.nrrd", header);
  fs::resize_file(folder / "a.nrrd", header.size() + volume.byte_count());
  expect_error(ErrorCode::kUnsupported, "at most 16777216 along each axis",
               [&] { read_volume(folder / "a.nrrd"); });
  ReadOptions options;
  options.raw = parse_raw_spec("16777217x1x1,u8,1,1,1");
  expect_error(ErrorCode::kBadParameter, "at most 16777216 along each axis",
               [&] { read_volume(folder / "a.nrrd", options); });
}

TEST(MappedFile, WhatIsCutOffEndsTheProcess) {
  if (has_sanitizer()) GTEST_SKIP() << "the sanitizer takes the signal";
  const TemporaryFolder folder;
  Volume volume = make_test_volume(VoxelType::kU8, {256, 256, 1});
  write_bytes(folder / "v.raw", voxel_bytes_of(volume));
  write_bytes(folder / "a.nhdr", nrrd_header(volume, "data file: v.raw\n"));
  ReadOptions raw;
  raw.raw = parse_raw_spec("256x256x1,u8,1,1,1");
  const auto touch = [](const Volume& mapped) {
    const rlimit no_core{0, 0};
    setrlimit(RLIMIT_CORE, &no_core);
    volatile double value = value_at(mapped, 60000);
    static_cast<void>(value);
  };
  const Volume from_raw = read_volume(folder / "v.raw", raw);
  const Volume from_nrrd = read_volume(folder / "a.nhdr");
  fs::resize_file(folder / "v.raw", 0);
  EXPECT_EXIT(touch(from_raw), testing::KilledBySignal(SIGBUS), "");
  EXPECT_EXIT(touch(from_nrrd), testing::KilledBySignal(SIGBUS), "");
}

/// A file of 4.4 GB that takes no room on the disk, with known voxels on either side of 2^31 and 2^32 bytes.
TEST(MappedFile, VoxelsBeyondFourGigabytes) {
  const TemporaryFolder folder;
  Volume volume;
  volume.type = VoxelType::kU16;
  volume.size = {1024, 1024, 2100};
  const std::uint64_t count = volume.voxel_count();
  const std::uint64_t places[] = {0,          (1u << 30) - 1,       1u << 30, (1ull << 31) - 1,
                                  1ull << 31, (1ull << 31) + 12345, count - 1};
  const std::string header = ended(nrrd_header(volume));
  write_bytes(folder / "v.raw", "");
  write_bytes(folder / "a.nrrd", header);
  write_bytes(folder / "a.nhdr", nrrd_header(volume, "data file: v.raw\n"));
  write_bytes(folder / "a.mhd", meta_header(volume, "v.raw"));
  for (const auto& [name, offset] :
       {std::pair{"v.raw", std::size_t{0}}, std::pair{"a.nrrd", header.size()}}) {
    fs::resize_file(folder / name, offset + volume.byte_count());
    std::fstream file(folder / name, std::ios::in | std::ios::out | std::ios::binary);
    for (std::size_t n = 0; n < std::size(places); ++n) {
      file.seekp(static_cast<std::streamoff>(offset + 2 * places[n]));
      file.put(static_cast<char>(n + 1)).put('\1');
    }
  }
  for (const char* name : {"v.raw", "a.nrrd", "a.nhdr", "a.mhd"}) {
    ReadOptions options;
    if (std::string_view(name) == "v.raw") options.raw = parse_raw_spec("1024x1024x2100,u16,1,1,1");
    const Volume read = read_volume(folder / name, options);
    ASSERT_EQ(read.size, volume.size);
    for (std::size_t n = 0; n < std::size(places); ++n) {
      EXPECT_EQ(value_at(read, places[n]), static_cast<double>(n + 257)) << name << " " << places[n];
    }
    EXPECT_EQ(value_at(read, (1ull << 31) + 1), 0) << name;
  }
  fs::resize_file(folder / "v.raw", volume.byte_count() - 1);
  expect_error(ErrorCode::kBadFormat, "expected 4404019200 bytes of voxels, file has 4404019199",
               [&] { read_volume(folder / "a.nhdr"); });
}

}  // namespace
}  // namespace voxlume::test
