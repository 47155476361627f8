#include <fmt/format.h>
#include <gtest/gtest.h>

#include "test_files.h"
#include "volume_io/natural_order.h"

namespace voxlume::test {
namespace {

/// A little-endian TIFF of one uncompressed page, written tag by tag.
std::string tiff_page(int width, int height, const std::string& pixels, int bits, int samples = 1,
                      const std::string& description = "") {
  std::vector<std::array<std::uint32_t, 4>> tags;  // tag, type, count, value
  const auto add = [&](std::uint32_t tag, std::uint32_t type, std::uint32_t count, std::size_t value) {
    tags.push_back({tag, type, count, static_cast<std::uint32_t>(value)});
  };
  const std::size_t pixels_at = 8;
  const std::size_t description_at = pixels_at + pixels.size();
  add(256, 3, 1, static_cast<std::size_t>(width));
  add(257, 3, 1, static_cast<std::size_t>(height));
  add(258, 3, 1, static_cast<std::size_t>(bits));
  add(259, 3, 1, 1);
  add(262, 3, 1, samples == 3 ? 2 : 1);
  if (!description.empty()) add(270, 2, static_cast<std::uint32_t>(description.size()), description_at);
  add(273, 4, 1, pixels_at);
  add(277, 3, 1, static_cast<std::size_t>(samples));
  add(278, 3, 1, static_cast<std::size_t>(height));
  add(279, 4, 1, static_cast<std::size_t>(width * height * samples * bits / 8));
  std::string bytes =
      std::string("II*\0", 4) +
      bytes_of<std::uint32_t>({static_cast<std::uint32_t>(description_at + description.size())}) + pixels +
      description + bytes_of<std::uint16_t>({static_cast<std::uint16_t>(tags.size())});
  for (const auto& t : tags) {
    bytes += bytes_of<std::uint16_t>({static_cast<std::uint16_t>(t[0]), static_cast<std::uint16_t>(t[1])}) +
             bytes_of<std::uint32_t>({t[2], t[3]});
  }
  return bytes + std::string(4, '\0');
}

TEST(Tiff, FolderOfSlicesIsStackedInNaturalOrder) {
  const TemporaryFolder folder;
  for (const int i : {1, 2, 9, 10, 11, 100}) {
    write_bytes(folder / fmt::format("slice{}.tif", i),
                tiff_page(2, 1, std::string(2, static_cast<char>(i)), 8));
  }
  const Volume volume = read_volume(folder.path());
  EXPECT_EQ(volume.size, (std::array<std::int64_t, 3>{2, 1, 6}));
  EXPECT_EQ(volume.format, "TIFF slices");
  const double expected[] = {1, 2, 9, 10, 11, 100};
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(value_at(volume, 2 * i), expected[i]);
  EXPECT_TRUE(warns(volume, "1 mm is assumed"));
}

TEST(Tiff, SlicesMustAgree) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.tif", tiff_page(2, 1, "ab", 8));
  write_bytes(folder / "b.tif", tiff_page(1, 2, "ab", 8));
  expect_error(ErrorCode::kBadFormat, "slice 1 is 1x2 u8; expected 2x1 u8",
               [&] { read_volume(folder.path()); });
}

TEST(Tiff, ColourAndOddDepthsAreRefused) {
  const TemporaryFolder folder;
  write_bytes(folder / "a.tif", tiff_page(2, 1, "abcdef", 8, 3));
  expect_error(ErrorCode::kUnsupported, "3 channels per pixel (RGB)", [&] { read_volume(folder / "a.tif"); });
  write_bytes(folder / "b.tif", tiff_page(8, 1, "a", 1));
  expect_error(ErrorCode::kUnsupported, "1-bit integer pixels", [&] { read_volume(folder / "b.tif"); });
}

TEST(Tiff, ImageJStacksAndOmeSizesAreUnderstood) {
  const TemporaryFolder folder;
  const std::string pixels = bytes_of<std::uint16_t>({1, 2, 3, 4, 5, 6});
  write_bytes(folder / "a.tif",
              tiff_page(2, 1, pixels, 16, 1, std::string("ImageJ=1.53t\nimages=3\nslices=3\n") + '\0'));
  const Volume stack = read_volume(folder / "a.tif");
  EXPECT_EQ(stack.size, (std::array<std::int64_t, 3>{2, 1, 3}));
  EXPECT_EQ(value_at(stack, 5), 6);
  write_bytes(
      folder / "b.tif",
      tiff_page(2, 1, pixels, 16, 1, std::string("ImageJ=1.53t\nimages=6\nchannels=2\nframes=3\n") + '\0'));
  expect_error(ErrorCode::kUnsupported, "2 channels and 3 time steps",
               [&] { read_volume(folder / "b.tif"); });
  write_bytes(folder / "c.tif",
              tiff_page(2, 1, pixels, 16, 1, std::string("ImageJ=1.53t\nimages=900\nslices=900\n") + '\0'));
  expect_error(ErrorCode::kBadFormat, "promises 900 slices", [&] { read_volume(folder / "c.tif"); });
  const std::string ome =
      "<OME><Pixels SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"0.5\" PhysicalSizeY=\"0.25\" "
      "PhysicalSizeZ=\"2\"/></OME>";
  write_bytes(folder / "d.tif", tiff_page(2, 1, pixels, 16, 1, ome + '\0'));
  const Volume placed = read_volume(folder / "d.tif");
  EXPECT_NEAR(placed.spacing_mm[0], 0.0005, 1e-12);
  EXPECT_NEAR(placed.spacing_mm[1], 0.00025, 1e-12);
  EXPECT_NEAR(placed.spacing_mm[2], 0.002, 1e-12);
}

TEST(Tiff, NaturalOrder) {
  EXPECT_TRUE(natural_less("a9", "a10"));
  EXPECT_FALSE(natural_less("a10", "a9"));
  EXPECT_TRUE(natural_less("a009", "a10"));
  EXPECT_TRUE(natural_less("a", "a1"));
  EXPECT_TRUE(natural_less("a1b2", "a1b10"));
  EXPECT_FALSE(natural_less("a1", "a1"));
  EXPECT_NE(natural_less("a01", "a1"), natural_less("a1", "a01"));
  EXPECT_TRUE(natural_less("x99999999999999999998", "x99999999999999999999"));
}

/// OpenVDB is optional: what it reads is tested where the library has it.
bool has_vdb(const TemporaryFolder& folder) {
  try {
    write_volume(make_test_volume(VoxelType::kF32), folder / "probe.vdb");
    return true;
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kUnsupported);
    return false;
  }
}

TEST(Vdb, RoundTripKeepsVoxelsAndGeometry) {
  const TemporaryFolder folder;
  if (!has_vdb(folder)) GTEST_SKIP() << "built without OpenVDB";
  for (const VoxelType type : {VoxelType::kF32, VoxelType::kI16, VoxelType::kU8}) {
    Volume volume = make_test_volume(type, {19, 9, 10});
    volume.spacing_mm = {0.957, 1.25, 2.5};
    volume.origin_mm = {-123.456, 78.9, -1031.25};
    volume.direction = rotation({0.6, 0.0, 0.8}, 0.7);
    write_volume(volume, folder / "a.vdb");
    const Volume back = read_volume(folder / "a.vdb");
    EXPECT_EQ(back.type, VoxelType::kF32);
    ASSERT_EQ(back.size, volume.size);
    expect_same_geometry(volume, back);
    for (std::size_t i = 0; i < volume.voxel_count(); ++i) {
      ASSERT_EQ(value_at(back, i), static_cast<float>(value_at(volume, i))) << i;
    }
  }
}

}  // namespace
}  // namespace voxlume::test
