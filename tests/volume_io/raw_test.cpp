#include <gtest/gtest.h>

#include "test_files.h"

namespace voxlume::test {
namespace {

TEST(RawSpec, ParsesEveryForm) {
  const RawSpec full = parse_raw_spec("256x255x108,i16,0.957,0.9,1.5,big,16");
  EXPECT_EQ(full.size, (std::array<std::int64_t, 3>{256, 255, 108}));
  EXPECT_EQ(full.type, VoxelType::kI16);
  EXPECT_EQ(full.spacing_mm, (std::array<double, 3>{0.957, 0.9, 1.5}));
  EXPECT_TRUE(full.big_endian);
  EXPECT_EQ(full.offset_bytes, 16u);
  EXPECT_FALSE(parse_raw_spec("1x1x1,f64,1,1,1").big_endian);
  EXPECT_FALSE(parse_raw_spec("1x1x1,f64,1,1,1,little").big_endian);
  EXPECT_EQ(parse_raw_spec("1x1x1,f64,1,1,1,352").offset_bytes, 352u);
}

TEST(RawSpec, NamesTheFieldThatIsWrong) {
  const std::pair<const char*, const char*> cases[] = {
      {"", "specification"},
      {"4x4x4,u8", "specification"},
      {"4x4x4,u8,1,1,1,big,0,7", "specification"},
      {"4x4,u8,1,1,1", "size"},
      {"4x4x0,u8,1,1,1", "size"},
      {"4x-4x4,u8,1,1,1", "size"},
      {"4x4x4.5,u8,1,1,1", "size"},
      {"4x4xn,u8,1,1,1", "size"},
      {"99999999999999999999x1x1,u8,1,1,1", "size"},
      {"9999999x9999999x9999999,u8,1,1,1", "size"},
      {"4x4x4,u9,1,1,1", "type"},
      {"4x4x4,u8,0,1,1", "spacing"},
      {"4x4x4,u8,1,-1,1", "spacing"},
      {"4x4x4,u8,1,1,nan", "spacing"},
      {"4x4x4,u8,1,1,x", "spacing"},
      {"4x4x4,u8,1,1,1,middle", "byte order"},
      {"4x4x4,u8,1,1,1,-3", "byte order"},
      {"4x4x4,u8,1,1,1,big,little", "offset"},
      {"4x4x4,u8,1,1,1,3,big", "offset"},
      {"4x4x4,u8,1,1,1,big,1x", "offset"},
  };
  for (const auto& [text, field] : cases) {
    SCOPED_TRACE(text);
    expect_error(ErrorCode::kBadParameter, field, [&, spec = text] { parse_raw_spec(spec); });
    expect_error(ErrorCode::kBadParameter, "WxHxD,type,sx,sy,sz", [&, spec = text] { parse_raw_spec(spec); });
  }
}

Volume read_raw_file(const fs::path& path, const char* spec) {
  ReadOptions options;
  options.raw = parse_raw_spec(spec);
  return read_volume(path, options);
}

TEST(Raw, ReadsLittleAndBigEndianWithOffset) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.raw", bytes_of<std::int16_t>({-1, 0x1234, 258, 7}));
  const Volume little = read_raw_file(folder / "a.raw", "3x1x1,i16,1,2,3,little,2");
  EXPECT_EQ(value_at(little, 0), 0x1234);
  EXPECT_EQ(value_at(little, 2), 7);
  EXPECT_EQ(little.spacing_mm, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(little.format, "raw");
  EXPECT_TRUE(little.warnings.empty());
  const Volume big = read_raw_file(folder / "a.raw", "4x1x1,i16,1,2,3,big");
  EXPECT_EQ(value_at(big, 1), 0x3412);
  EXPECT_EQ(value_at(big, 2), 0x0201);
}

TEST(Raw, UnalignedOffsetIsCopied) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.raw", "x" + bytes_of<double>({1.5, -2.5}));
  const Volume volume = read_raw_file(folder / "a.raw", "2x1x1,f64,1,1,1,1");
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(volume.voxels.get()) % 8, 0u);
  EXPECT_EQ(value_at(volume, 1), -2.5);
}

TEST(Raw, VoxelsAreMappedNotCopied) {
  const TemporaryFolder folder;
  const std::uint64_t bytes = 1ull << 36;  // a sparse file larger than memory
  write_bytes(folder / "a.raw", "abcd");
  fs::resize_file(folder / "a.raw", bytes);
  const Volume volume = read_raw_file(folder / "a.raw", "65536x1024x1024,u8,1,1,1");
  EXPECT_EQ(static_cast<const char*>(volume.voxels.get())[2], 'c');
  EXPECT_EQ(volume.byte_count(), bytes);
}

TEST(Raw, SizesThatDisagreeAreNamed) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.raw", std::string(100, 'x'));
  expect_error(ErrorCode::kBadFormat, "expected 250 bytes (5x5x5 i16 voxels after offset 0), file has 100",
               [&] { read_raw_file(folder / "a.raw", "5x5x5,i16,1,1,1"); });
  expect_error(ErrorCode::kBadFormat, "expected 104 bytes",
               [&] { read_raw_file(folder / "a.raw", "10x10x1,u8,1,1,1,4"); });
  EXPECT_TRUE(warns(read_raw_file(folder / "a.raw", "3x3x3,u8,1,1,1"), "73 bytes more"));
  expect_error(ErrorCode::kFileNotFound, "no such",
               [&] { read_raw_file(folder / "b.raw", "3x3x3,u8,1,1,1"); });
  expect_error(ErrorCode::kBadFormat, "not a file", [&] { read_raw_file(folder.path(), "3x3x3,u8,1,1,1"); });
  ReadOptions options;
  options.raw = RawSpec{};
  expect_error(ErrorCode::kBadParameter, "raw size 0x0x0", [&] { read_volume(folder / "a.raw", options); });
}

TEST(Raw, MemoryLimitCounts) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.raw", std::string(1000, 'x'));
  ReadOptions options;
  options.raw = parse_raw_spec("10x10x10,u8,1,1,1");
  options.memory_limit_bytes = 999;
  expect_error(ErrorCode::kOutOfMemory, "999 bytes is the limit given",
               [&] { read_volume(folder / "a.raw", options); });
  options.memory_limit_bytes = 1000;
  EXPECT_EQ(read_volume(folder / "a.raw", options).byte_count(), 1000u);
}

TEST(VoxelTypes, NamesAndBack) {
  for (const VoxelType type : {VoxelType::kU8, VoxelType::kI8, VoxelType::kU16, VoxelType::kI16,
                               VoxelType::kU32, VoxelType::kI32, VoxelType::kF32, VoxelType::kF64}) {
    EXPECT_EQ(parse_voxel_type(voxel_type_name(type)), type);
  }
  EXPECT_EQ(voxel_type_name(VoxelType::kI16), "i16");
  expect_error(ErrorCode::kBadParameter, "\"short\"; expected u8", [] { parse_voxel_type("short"); });
}

}  // namespace
}  // namespace voxlume::test
